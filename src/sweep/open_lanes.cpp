// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/open_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "model/model.hpp"
#include "model/signals/add_profile.hpp"
#include "model/signals/given_motion.hpp"
#include "record/rows.hpp"
#include "record/track/gimbal_extremes.hpp"
#include "record/track/track_measures.hpp"
#include "solve/choose.hpp"
#include "sweep/case_scenario.hpp"
#include "sweep/group_runner.hpp"
#include "sweep/sample_cases.hpp"

namespace bbsim::sweep {
namespace {

using solve::open::GivenMotion, solve::open::OpenCase, solve::open::OpenLanes, solve::open::Reached;
using Kind = scenario::Measure::Kind;

// In a smaller sweep, measuring the pace would cost more than the cases. In a longer motion, it
// would delay the first case too long.
constexpr std::size_t worth_it = 32;
constexpr double longest = 3000;  // rad

model::Model model_of(const Scenario& scenario) {
  return model::assemble(scenario, false, model::Form::full);
}

// Converts the case to the numbers of a lane. `shared` has the terms that do not vary.
void set(OpenCase& one, const Scenario& scenario, const model::SharedTerms& shared) {
  const Ball& ball = scenario.ball;
  one.radius = ball.radius;
  one.gravity = scenario.gravity;
  const double initial[] = {ball.position[0], ball.position[1], ball.velocity[0], ball.velocity[1],
                            ball.radius * ball.spin};
  std::copy(std::begin(initial), std::end(initial), one.initial);
  const Gimbal& gimbal = scenario.gimbal;
  GivenMotion& motion = one.motion;
  for (int i = 0; i < 2; ++i) motion.start[i] = motion.rate[i] = 0;
  motion.wave_count = 0;
  motion.shared = shared;
  const auto is_shared = [](const auto&) {};
  model::add_profile(gimbal.motion->phi, 0, motion, is_shared);
  model::add_profile(gimbal.motion->theta, 1, motion, is_shared);
  motion.add_constant(0, gimbal.mounting.phi_offset);
  motion.add_constant(1, gimbal.mounting.theta_offset);
}

std::size_t sinusoids(const Profile& profile) {
  return static_cast<std::size_t>(std::count_if(
      profile.begin(), profile.end(),
      [](const ProfileTerm& term) { return std::holds_alternative<Sinusoid>(term); }));
}

class OpenCarrier : public GroupCarrier {
 public:
  OpenCarrier(const SweepTask& task, const Scenario& first, const solve::open::Pace& pace)
      : task_(task),
        end_time_(first.time.end),
        motion_(model::given_motion(first)),
        scenario_(task),
        lanes_({first.solver.rtol, first.solver.atol}, end_time_, model_of(first).stops, pace),
        end_(scenario::end_columns(task.measures)),
        same_signals_(task.plan.shares_signals()) {
    for (const scenario::Measure& measure : task.measures) take_.push_back(way_to(measure));
    needs_model_ = std::count(take_.begin(), take_.end(), Take::column) > 0;
    wants_turning_ = std::count(take_.begin(), take_.end(), Take::tilt) > 0 ||
                     std::count(take_.begin(), take_.end(), Take::tilt_rate) > 0;
  }

  void carry(std::span<GroupCase> cases, const std::atomic<bool>&) override {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      set(cases_[i], scenario_.at(cases[i].number, cases[i].values), motion_.view().shared);
    }
    const auto carried = lanes_.integrate(cases_.data(), static_cast<int>(cases.size()));
    for (std::size_t i = 0; i < cases.size(); ++i) {
      cases[i].carried = carried[i] && take(i, cases[i]);
    }
  }

 private:
  enum class Take { x, y, column, distance, tilt, tilt_rate };

  static Take way_to(const scenario::Measure& measure) {
    const std::string_view name = measure.column->name;
    if (measure.kind == Kind::end)
      return name == "x" ? Take::x : name == "y" ? Take::y : Take::column;
    return name == "distance" ? Take::distance : name == "tilt" ? Take::tilt : Take::tilt_rate;
  }

  // Writes the measures of a lane's case. False if a square overflows or vanishes.
  bool take(std::size_t lane, const GroupCase& one) {
    const Reached reached = lanes_.reached(static_cast<int>(lane));
    if (!record::is_square(reached.distance_squared)) return false;
    record::GimbalExtremes::Greatest turned;
    if (wants_turning_) turned = turning(one, reached);
    if (needs_model_) {
      const Scenario& scenario = scenario_.at(one.number, one.values);
      const model::Model model = model_of(scenario);
      const model::BallConstants constants = model::constants_of(scenario);
      end_.begin(model, constants);
      end_.evaluate(&end_time_, reached.state, 1);
    }
    std::size_t column = 0;
    for (std::size_t m = 0; m < take_.size(); ++m) {
      double& result = one.measures[m];
      switch (take_[m]) {
        case Take::x:
          result = reached.state[0];
          break;
        case Take::y:
          result = reached.state[1];
          break;
        case Take::column:
          result = end_[column][0];
          break;
        case Take::distance:
          result = std::sqrt(reached.distance_squared);
          break;
        case Take::tilt:
          result = turned.tilt;
          break;
        case Take::tilt_rate:
          result = turned.rate;
          break;
      }
      if (task_.measures[m].kind == Kind::end) ++column;
    }
    return true;
  }

  // Lanes do not search shared terms, so a motion with some is searched here: once if all cases
  // have the same motion, otherwise for each case.
  record::GimbalExtremes::Greatest turning(const GroupCase& one, const Reached& reached) {
    if (!motion_.view().shared.any()) {
      return {record::tilt_of(reached.versine), std::sqrt(reached.rate_squared)};
    }
    if (!turned_ || !same_signals_) {
      turned_ = gimbal_.of(model::given_motion(scenario_.at(one.number, one.values)), end_time_);
    }
    return *turned_;
  }

  const SweepTask& task_;
  const double end_time_;           // s
  const model::SignalPair motion_;  // its shared terms are those of all cases
  CaseScenario scenario_;
  OpenLanes lanes_;
  std::vector<Take> take_;
  record::Rows end_;
  record::GimbalExtremes gimbal_;
  std::optional<record::GimbalExtremes::Greatest> turned_;
  bool needs_model_ = false, wants_turning_ = false, same_signals_;
  std::array<OpenCase, solve::open::group> cases_;
};

}  // namespace

bool can_use_open_lanes(const SweepTask& task) {
  if (!task.series.empty() || task.plan.cases() < worth_it || !task.plan.independent() ||
      !record::are_track_measures(task.measures)) {
    return false;
  }
  // Planar cases are carried like the others. Everything tested here is the same in all cases.
  const Scenario scenario = task.family.read(task.plan.settings(0));
  return scenario.gimbal.motion && !scenario.solver.error &&
         solve::choose_method(scenario.solver.method) == Method::radau &&
         sinusoids(scenario.gimbal.motion->phi) + sinusoids(scenario.gimbal.motion->theta) <=
             solve::open::most_harmonics &&
         record::has_track(model_of(scenario));
}

std::optional<solve::open::Pace> open_lane_pace(const SweepTask& task) {
  constexpr int groups = 4;
  const Scenario first = task.family.read(task.plan.settings(0));
  const std::vector<double> stops = model_of(first).stops;
  const model::SignalPair motion = model::given_motion(first);
  std::optional<OpenLanes::Measured> best;
  for (const int nodes : {8, 12, 16}) {
    OpenLanes lanes({first.solver.rtol, first.solver.atol}, first.time.end, stops, {nodes});
    std::optional<OpenLanes::Measured> slowest;
    for (int g = 0; g < groups; ++g) {
      std::array<OpenCase, solve::open::group> cases;
      for (std::size_t i = 0; i < solve::open::group; ++i) {
        const int sample = g * static_cast<int>(solve::open::group) + static_cast<int>(i);
        const Scenario scenario =
            task.family.read(task.plan.settings(sample_case(sample, task.plan.cases())));
        if (model::given_motion(scenario).highest_frequency() * scenario.time.end > longest) {
          return {};
        }
        set(cases[i], scenario, motion.view().shared);
      }
      const auto measured = lanes.measure(cases.data(), static_cast<int>(solve::open::group));
      if (!measured) continue;
      if (!slowest) slowest = measured;
      slowest->pace.angle = std::min(slowest->pace.angle, measured->pace.angle);
      slowest->cost = std::max(slowest->cost, measured->cost);
    }
    if (slowest && (!best || slowest->cost < best->cost)) best = slowest;
  }
  if (!best) return {};
  return best->pace;
}

std::size_t open_lane_group() {
  return solve::open::group;
}

std::unique_ptr<CaseRunner> open_lane_runner(const SweepTask& task, const solve::open::Pace& pace) {
  const Scenario first = task.family.read(task.plan.settings(0));
  return group_runner(task, first, solve::open::group,
                      std::make_unique<OpenCarrier>(task, first, pace));
}

}  // namespace bbsim::sweep
