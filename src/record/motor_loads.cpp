// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/motor_loads.hpp"

#include <algorithm>
#include <vector>

namespace bbsim::record {
namespace {

std::vector<Extremes::Query> most_and_least_loads() {
  std::vector<Extremes::Query> queries;
  for (const char* name : {"motor_torque_phi", "motor_torque_theta", "motor_power"}) {
    const scenario::Column* const load = scenario::find_column(name);
    queries.push_back({load});
    queries.push_back({load, true});
  }
  return queries;
}

}  // namespace

bool has_plate_inertia(const model::BallConstants& constants) {
  return std::any_of(constants.plate_inertia.begin(), constants.plate_inertia.end(),
                     [](double moment) { return moment > 0; });
}

MotorLoads::MotorLoads() : extremes_(most_and_least_loads()) {}

void MotorLoads::begin(const model::Model& model, const model::BallConstants& constants) {
  with_plate_ = has_plate_inertia(constants);
  extremes_.begin(model, constants);
}

MotorPeaks MotorLoads::peaks() const {
  const auto peak = [this](std::size_t load) {
    const Extremes::Extreme most = extremes_[2 * load], least = extremes_[2 * load + 1];
    return -least.value > most.value ? Peak{least.t, -least.value} : Peak{most.t, most.value};
  };
  return {peak(0), peak(1), peak(2), with_plate_};
}

}  // namespace bbsim::record
