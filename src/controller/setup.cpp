#include "controller/setup.hpp"

#include <limits>

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
  setup.limit = controller.limit.value_or(std::numeric_limits<double>::infinity());
  setup.end = scenario.time.end;
  setup.parameters = controller.own->parameters;
  setup.columns = scenario::own_columns(scenario);
  return setup;
}

}  // namespace bbsim::controller
