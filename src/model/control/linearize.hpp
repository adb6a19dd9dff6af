// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene as a linear system about a point of its motion: the plant, the loop, or the plant as a
// sampled controller sees it. Differentiates the right-hand side and the law exactly.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/control/derivatives.hpp"
#include "model/control/frequency.hpp"
#include "model/control/linear_system.hpp"
#include "model/model.hpp"
#include "model/spectrum.hpp"

namespace bbsim::model {

// plant    from the gimbal's commands to the ball's position, in continuous time
// loop     from the reference to the position; with a sampled controller, from sample to sample
// sampled  the plant under a held command, from sample to sample, with all delays
enum class LinearKind { plant, loop, sampled };

// Margins of one command's loop, with the other loop closed.
struct LoopMargins {
  std::string command;  // such as phi_command
  Margins margins;
  // L of 1 + L = 0: from the command to minus what the law answers. Without states that no command
  // moves, such as the spin.
  LinearSystem open;
};

struct Bandwidth {
  std::string output;  // such as x, of the response to x_reference
  double value;        // rad/s, at which the response is 1 / sqrt(2) of that at 0; or infinite
  double of_feedback;  // without the reference's accelerations as an input
};

struct Linearization {
  LinearSystem system;
  Eigenvalues poles, zeros;          // of a loop, from the reference to the ball's position
  std::vector<LoopMargins> margins;  // of a loop
  // Stability of a loop without its spin. Margins of an unstable loop say where poles cross the
  // border, not what the loop bears.
  bool stable = false;
  std::vector<Bandwidth> bandwidths;  // of a loop
};

// Optional results for a closed loop, each of which takes longer than matrices and poles. The
// result lacks what is left out.
struct LoopParts {
  bool zeros = true;
  std::array<MarginParts, 2> margins{};        // of phi's and theta's command
  std::array<bool, 2> bandwidths{true, true};  // of x and y
};

// Linearizes without limits, dead band, backlash, rounding and noise. If samples see a sensor's
// frames at different ages (common_cycle()), each sample gets a frame of its own instead. The
// spin is a state if it acts on others, and so are the law's integrals. `model` is that of the
// scene and says what symmetry leaves out. Throws InputError if the scene has nothing of that kind.
[[nodiscard]] Linearization linearize(const Scenario& scene, const Model& model, LinearKind kind,
                                      const LinearPoint& at, const LoopParts& parts = {});

// Closes the loop of a sampled plant (LinearKind::sampled) with a law given by its equations from
// sample to sample, from measured positions to both commands. Gives poles, stability, and the
// margins of these axes' commands.
[[nodiscard]] Linearization loop_with(const Linearization& plant, const LinearSystem& law,
                                      const std::vector<int>& axes);

// The kind that `bbsim linearize` shows by default.
[[nodiscard]] LinearKind usual_kind(const Scenario& scene);

// Rising frequencies at which to look at the loops of a linearization's margins, from a thirtieth
// of the slowest pole to thirty times the fastest, or to half the sampling rate; rad/s. Empty
// without loops.
[[nodiscard]] std::vector<double> open_loop_frequencies(const Linearization& linearization);

struct OpenLoops {
  std::vector<double> frequencies;  // some of those, as many as a picture needs
  struct Curve {
    std::vector<double> gain;
    std::vector<double> phase;  // rad, without jumps; the first is between -7/4 pi and pi/4
  };
  std::vector<Curve> curves;  // of each loop of `margins`
};

// The loops of a linearization's margins: each broken at its command, with the other one closed.
// Empty if it has none.
[[nodiscard]] OpenLoops open_loops(const Linearization& linearization);

}  // namespace bbsim::model
