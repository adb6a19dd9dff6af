// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene as a linear system about a point of its motion: the plant, the loop, or the plant as a
// sampled controller sees it. Exact: by differentiating the right-hand side and the law.
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
// loop     from the reference to the position; of a sampled controller, from sample to sample
// sampled  the plant under a command that is held, from sample to sample, with all delays
enum class LinearKind { plant, loop, sampled };

// What one command's loop bears, the other one closed.
struct LoopMargins {
  std::string command;  // phi_command
  Margins margins;
};

struct Bandwidth {
  std::string output;  // x, of the response to x_reference
  double value;        // rad/s, where the response is 1 / sqrt(2) of that at 0; or infinite
  double of_feedback;  // of a controller that is not told the reference's accelerations
};

struct Linearization {
  LinearSystem system;
  Eigenvalues poles, zeros;          // of a loop, from where the reference is to where the ball is
  std::vector<LoopMargins> margins;  // of a loop
  // Of a loop without its spin; of an unstable one, margins say where poles cross the border and
  // not what it bears.
  bool stable = false;
  std::vector<Bandwidth> bandwidths;  // of a loop
};

// What of a closed loop is worked out beside its matrices and poles: each part takes longer than
// these do. What is left out is not in the result.
struct LoopParts {
  bool zeros = true;
  std::array<MarginParts, 2> margins{};        // of phi's and theta's command
  std::array<bool, 2> bandwidths{true, true};  // of x and y
};

// Without limits, dead band, backlash, rounding and noise; without the frames of a sensor of which
// each sample sees one of another age (common_cycle.hpp), as if it looked for each. The spin is a
// state where it acts on others, and an integral where the law has it. The scene is one of `model`,
// which says what symmetry leaves out. Throws InputError where the scene has nothing of that kind.
[[nodiscard]] Linearization linearize(const Scenario& scene, const Model& model, LinearKind kind,
                                      const LinearPoint& at, const LoopParts& parts = {});

// The loop of a sampled plant (LinearKind::sampled) and a law that is known by its equations from
// sample to sample, from the positions that it sees to both commands: poles, stability, and the
// margins of these axes' commands.
[[nodiscard]] Linearization loop_with(const Linearization& plant, const LinearSystem& law,
                                      const std::vector<int>& axes);

// What `bbsim linearize` shows of a scene unless it is told.
[[nodiscard]] LinearKind usual_kind(const Scenario& scene);

}  // namespace bbsim::model
