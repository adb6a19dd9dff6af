// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// In place of the sources that cmake/wasm.cmake leaves out. A page cannot have the user's programs
// and libraries, or CVODE. It asks for no derivatives by keys, which need the engines of sweeps.
#include <fcntl.h>

#include <string>

#include "api/run_sensitivity.hpp"
#include "base/error.hpp"
#include "controller/host.hpp"
#include "controller/program.hpp"
#include "solve/cvode/cvode.hpp"

// Emscripten declares this function and lacks it. A page has no disk.
extern "C" int sync_file_range(int, off_t, off_t, unsigned) {
  return 0;
}

namespace bbsim {
namespace controller {

Host::Host(Report report, const std::atomic<bool>* stop)
    : report_(std::move(report)), stop_(stop) {}
Host::~Host() = default;

void Host::attach(const Scenario& scenario, model::Model& model) {
  if (!scenario.controller || !scenario.controller->own) return;
  const OwnController& own = *scenario.controller->own;
  if (const auto* const factory = std::get_if<ControllerFactory>(&own.by)) {
    model.rig->sampled->external = factory->make(scenario);
    return;
  }
  const bool library = std::holds_alternative<ControllerLibrary>(own.by);
  throw KeyError(library ? "controller.library" : "controller.program",
                 "a page cannot start it; allowed here: controllers of bbsim, such as "
                 "controller.pd; `bbsim run` runs yours");
}

std::optional<std::string> Host::unit_of(std::string_view /*own_column*/) const {
  return {};
}
std::vector<std::string> Host::describe() const {
  return {};
}
void Host::require_printed() const {}
std::string Host::unheard() const {
  return "";
}
std::string Host::line_remark() const {
  return "";
}
void Host::finish() {}

std::vector<std::string> files_of(const Scenario& /*scenario*/) {
  return {};
}

}  // namespace controller

namespace api {

Sensitivity::Sensitivity(const RunRequest& request,
                         const std::vector<const scenario::Column*>& /*columns*/,
                         std::vector<scenario::Measure> /*measures*/)
    : grid_(request.scenario.time) {}

void Sensitivity::add_headers(std::vector<file::ColumnHeader>& /*headers*/) const {}

std::vector<std::vector<double>> Sensitivity::find(RunResult& /*run*/, Watch& /*watch*/) const {
  return {};
}

}  // namespace api

namespace solve {

std::unique_ptr<Stepper> make_cvode_stepper(const model::Model& /*model*/, Method /*method*/,
                                            Tolerances /*tolerances*/) {
  throw KeyError("solver.method",
                 "found bdf or adams, which a page does not have; allowed here: auto or radau");
}

}  // namespace solve
}  // namespace bbsim
