// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/run_part.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/error.hpp"
#include "base/fnv1a.hpp"
#include "base/number_text.hpp"
#include "base/short_number.hpp"
#include "controller/host.hpp"
#include "file/whole_file.hpp"
#include "model/control/external_controller.hpp"
#include "scenario/coupled.hpp"
#include "simd/instruction_set.hpp"
#include "solve/choose.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::api {
namespace {

// Everything that a run depends on, except its end and its output.
std::string identity_of(const Scenario& scenario, const std::vector<file::InputTable>& inputs) {
  std::string identity = scenario.source.text;
  for (const std::string& override : scenario.source.overrides) {
    if (override.starts_with("time.end=") || override.starts_with("output.")) continue;
    identity += "\n--set " + override;
  }
  for (const file::InputTable& table : inputs) {
    identity += "\n" + table.file;
    for (std::size_t c = 0; c < table.data->names.size(); ++c) {
      identity += "\n" + table.data->names[c];
      for (const double value : table.data->columns[c]) identity += ' ' + number_text(value);
    }
  }
  // Numbers that output asks of the user's controller, and the files of that controller.
  for (const scenario::Column* column : scenario::columns_named(scenario.output.columns)) {
    if (column->needs == scenario::Needs::own) identity += "\n" + std::string(column->name);
  }
  for (const std::string& file : controller::files_of(scenario)) {
    identity += "\n" + file + ' ' + std::to_string(fnv1a(file::read_whole(file)));
  }
  return identity;
}

}  // namespace

RunPart::RunPart(const PartRequest& request, const Scenario& scenario,
                 const std::vector<file::InputTable>& inputs)
    : request_(request), whole_(scenario), identity_(identity_of(scenario, inputs)) {
  const Method method = solve::choose_method(scenario.solver.method);
  if (scenario.solver.error) {
    throw InputError(
        "--save-state, --from-state: found with solver.error, which repeats the run several times; "
        "allowed: with tolerances");
  }
  if (method != Method::radau) {
    throw InputError("--save-state, --from-state: found with solver.method " +
                     std::string(solve::method_name(method)) +
                     ", whose history is not saved; allowed: radau");
  }
  Scenario without_push = scenario;  // a push switches nothing
  without_push.ball.push.reset();
  if (scenario::is_coupled(without_push)) {
    throw InputError(
        "--save-state, --from-state: found with losses, sliding or torques, whose switches are not "
        "saved; allowed: a scene without these");
  }
  if (!request_.from.empty()) {
    from_ = record::read_state(request_.from);
  }
  part_.keeps_state = !request_.save.empty();
  choose_rows();
}

void RunPart::choose_rows() {
  const OutputTimes times = whole_.time;
  grid_.emplace(times);
  part_.end_row = grid_->size();
  if (!request_.until.empty()) {
    if (!part_.keeps_state) throw InputError("--until: needs --save-state FILE, to continue from");
    const yaml::Quantity until = yaml::read_quantity(request_.until, false, yaml::Dimension::time);
    if (!until.value || !(*until.value >= times.step) || !(*until.value < times.end)) {
      throw InputError("--until: found " + request_.until +
                       "; allowed: a time from time.step to before time.end, " +
                       short_number(times.end) + " s");
    }
    // Times closer than this count as equal, as on the grid.
    const double last = *until.value * (1 + 1e-12);
    while ((*grid_)[part_.end_row - 1] > last) --part_.end_row;
  } else if (part_.keeps_state) {
    // The end is not known: leave out a row at an end that is no multiple of the step, since longer
    // runs lack it.
    const std::size_t rows = grid_->size();
    const double multiple = static_cast<double>(rows - 1) * times.step;
    part_.end_row = std::abs(multiple - times.end) <= 1e-9 * times.step ? rows : rows - 1;
    part_.endless = true;
    grid_.emplace(OutputTimes{static_cast<double>(rows + 1) * times.step, times.step});
    // Knots of the input after the end are stops too.
    whole_.time.end += 1e9;
  }
  if (!from_) return;
  part_.first_row = from_->next_row;
  part_.from = from_->state;
}

void RunPart::check(const model::Model& model,
                    const std::vector<const scenario::Column*>& columns) const {
  if (model.rig && model.rig->sampled && model.rig->sampled->external &&
      !model.rig->sampled->external->can_save()) {
    throw InputError(
        "--save-state, --from-state: found with a controller that cannot save its state; allowed: "
        "a program that answers the hello with \"save\": true, or a library with "
        "bbsim_controller_save and bbsim_controller_restore");
  }
  if (!from_) return;
  const std::string& file = request_.from;
  const record::RunState& state = *from_;
  const std::string set = simd::name_of(simd::chosen_instruction_set());
  if (state.version != BBSIM_VERSION || state.instruction_set != set) {
    throw InputError(file + ": found a state from bbsim " + state.version + " for " +
                     state.instruction_set + "; allowed: from this one, " BBSIM_VERSION " for " +
                     set + " (BBSIM_SIMD chooses another)");
  }
  if (state.identity != identity_) {
    throw InputError(file +
                     ": found a state of another scenario; allowed: the same text, --set, tables "
                     "and files of a controller; only time.end and output.columns may differ");
  }
  if (state.gamma != model.gamma) {
    throw InputError(file + ": found a state of a run " + (state.gamma ? "with" : "without") +
                     " gamma; allowed: columns that need gamma in both runs or in neither");
  }
  if (scenario::any_needs(columns, scenario::Needs::orientation)) {
    throw InputError(
        "--from-state: found with columns ball_q..., which bbsim computes from all rows since the "
        "start; allowed: other columns");
  }
  if (!state.endless && (part_.endless || state.end != grid_->end())) {
    throw InputError(file + ": found a state of a run to t = " + short_number(state.end) +
                     " s, but time.end is " + short_number(whole_.time.end) +
                     (part_.endless ? " and no --until" : "") + "; allowed: the same time.end" +
                     (part_.endless ? ", with --until" : ""));
  }
  if (state.endless && !part_.endless && grid_->end() < state.least_end) {
    throw InputError(file + ": the part that wrote it did not know that the run ends at t = " +
                     short_number(grid_->end()) +
                     " s, where the integrator would have chosen a different last step; allowed: a "
                     "time.end of " +
                     (std::isfinite(state.least_end)
                          ? short_number(state.least_end) + " s or more, or "
                          : std::string()) +
                     "a first part with this time.end and --until");
  }
  if (part_.first_row >= part_.end_row) {
    throw InputError(file + ": found a state at t = " + short_number(state.time) +
                     " s; allowed: an end after that");
  }
}

void RunPart::open() {
  if (part_.keeps_state) file_ = std::make_unique<file::AtomicFile>(request_.save);
}

std::string RunPart::finish(const model::Model& model) {
  if (!file_) return "";
  if (part_.state.empty()) return request_.save + ": not written; the run kept no state";
  record::RunState state;
  state.version = BBSIM_VERSION;
  state.instruction_set = simd::name_of(simd::chosen_instruction_set());
  state.identity = identity_;
  state.gamma = model.gamma;
  state.endless = part_.endless;
  state.end = grid_->end();
  state.least_end = part_.least_end;
  state.next_row = part_.next_row;
  state.time = (*grid_)[part_.next_row - 1];
  state.state = part_.state;
  file_->write(record::to_bytes(state));
  file_->commit();
  return request_.save + ": the state at t = " + short_number(state.time) + " s";
}

}  // namespace bbsim::api
