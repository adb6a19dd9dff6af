// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What is known of a scene before its run: its description; its linear system, with A, B, C, D,
// poles, zeros and margins; sentences about its loop; and the test of a user's controller, with a
// ball away from its reference.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "api/watch.hpp"
#include "base/error.hpp"
#include "model/control/linearize.hpp"
#include "model/model.hpp"
#include "model/spectrum.hpp"
#include "record/linear_text.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::api {

using model::Linearization;
using model::LinearKind;

// Subject and text of a line; a line without a label continues the one before.
struct Line {
  std::string label, text;
};
struct Report : std::vector<Line> {
  using vector::vector;
  void add(const std::string& label, const std::string& text) { push_back({label, text}); }
  void add(const Report& lines) { insert(end(), lines.begin(), lines.end()); }
};

constexpr std::size_t label_width = 12;

// One line each, with the labels in a column.
[[nodiscard]] inline std::string to_text(const Report& report) {
  std::string text;
  for (const Line& line : report) {
    std::string label = line.label;
    label.resize(std::max(label_width, label.size()), ' ');
    text += label + ' ' + line.text + '\n';
  }
  return text;
}

// Describes the model and its reasons, gains, poles, margins and the solver. Throws InputError.
[[nodiscard]] Report describe(const Scenario& scenario);

// The same, with the cases of the scenario's sweep block, all checked, and the answers of the
// user's controller to test samples (probe()). `reasons`: also says why the solver
// was chosen, and whether the scene is stiff. Throws model::ControllerFault.
[[nodiscard]] Report check(const Scenario& scenario, Watch& watch, bool reasons = false);

// Kind named plant, loop or sampled; empty for an empty name. Throws InputError for other names.
[[nodiscard]] std::optional<LinearKind> kind_named(const std::string& name);

struct LinearizeRequest {
  Scenario scenario;
  std::optional<LinearKind> kind{};  // empty: the usual one for the scene
  std::string at = "home";           // or equilibrium, or a time of the run, such as "2 s"
  // The loop of your own controller, about home, may be estimated as `bbsim check` does; it has no
  // inputs and outputs.
  bool estimates = false;
};

struct Linearized : record::LinearReport {
  ExitCode code = ExitCode::done;
  std::string reason;  // why there is no linear system; empty if there is one
  std::string note;    // what the system leaves out, and what its names mean
};

// Throws InputError if the scene has no such linear system.
[[nodiscard]] Linearized linearize(const LinearizeRequest& request, Watch& watch);

// Margins of each command's loop, and the bandwidths; empty without margins. `how` they were found.
[[nodiscard]] Report margins_of(const Linearization& linearization, const std::string& how = "");

// Remarks on gain margins under 6 dB and phase margins under 30 degrees of a stable loop.
[[nodiscard]] Report margin_remarks(const Linearization& linearization);

// Operating points, names and units, poles, zeros and margins.
[[nodiscard]] Report report_of(const Linearized& linearized);

// Text of a file of that name; its ending selects the format: .m, .py, .csv, else JSON.
[[nodiscard]] std::string file_text(const Linearized& linearized, const std::string& file);

// "-15.5, -2.27 +- 8.45i, -0.001"; of a sampled loop, the largest six that are not near zero.
[[nodiscard]] std::string poles_line(const model::Eigenvalues& poles, bool sampled = false);

// Warns if the closed loop of `model`, the scenario's, is unstable about home, and says if other
// signs of the gains, or a smaller ball, would make it stable. Else empty.
[[nodiscard]] std::string instability_warning(const Scenario& scenario, const model::Model& model);

// Why a sampled loop's poles (if `by_sample`, its equations by samples) leave out its camera's
// frames; empty if they do not.
[[nodiscard]] std::string without_frames(const Scenario& scenario, bool by_sample);

// Puts the ball beside the reference, on each axis and either side, and asks the model's controller
// for commands. The model tells where they drive the ball. Small pulses about the reference give
// the law, as far as it is linear, and the loop's margins. Runs the controller about twenty times
// for a hundred samples, or for as long as a ball needs to roll off if it does not answer before.
// Throws model::ControllerFault.
struct Probed {
  Report report;
  std::optional<model::Linearization> loop;  // estimated, as model::loop_with() gives it
  std::string why;                           // why there is no estimate
};
[[nodiscard]] Probed probe(const Scenario& scenario, const model::Model& model);

}  // namespace bbsim::api
