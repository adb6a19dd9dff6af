// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/setup.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <variant>

#include "scenario/columns.hpp"

namespace bbsim::controller {

Setup setup_of(const Scenario& scenario) {
  const Controller& controller = *scenario.controller;
  const Sampling& sampling = *controller.sampling;
  Setup setup;
  setup.drives = controller.drives;
  setup.period = sampling.period;
  setup.delay = sampling.delay;
  setup.resolution = sampling.resolution;
  setup.derivative_filter = sampling.derivative_filter;
  // The tighter limit, if those of the axes differ.
  setup.limit = std::numeric_limits<double>::infinity();
  for (const std::size_t axis : {0U, 1U}) {
    setup.limit = std::min(setup.limit, controller.limit_of(axis).value_or(setup.limit));
  }
  if (controller.sensor) setup.seed = controller.sensor->seed;
  for (std::size_t i = 0; scenario.gimbal.servo && i < setup.commands(); ++i) {
    const auto& stepper = scenario.gimbal.servo_of(i).stepper;
    if (stepper) setup.microstep[i] = stepper->microstep();
  }
  setup.end = scenario.time.end;
  setup.parameters = controller.own->parameters;
  setup.columns = scenario::own_columns(scenario);
  return setup;
}

const SerialProgram* serial_program(const OwnController& own) {
  const auto* const library = std::get_if<ControllerLibrary>(&own.by);
  return library != nullptr && library->serial ? &*library->serial : nullptr;
}

Setup serial_setup_of(const Scenario& scenario) {
  const SerialProgram& serial = *serial_program(*scenario.controller->own);
  Setup setup = setup_of(scenario);
  setup.serial = true;
  if (serial.period > 0) setup.period = serial.period;
  setup.delay = serial.delay;
  setup.parameters = serial.parameters;
  return setup;
}

}  // namespace bbsim::controller
