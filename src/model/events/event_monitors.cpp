// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/events/event_monitors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "scenario/coupled.hpp"

namespace bbsim::model {

const char* Monitor::name() const {
  constexpr const char* of_kind[] = {"edge", "slip",        "lift_off",
                                     "tilt", "singularity", "dead_point"};
  static_assert(std::size(of_kind) == static_cast<std::size_t>(Kind::dead_point) + 1);
  return of_kind[static_cast<int>(kind)];
}

double EventMonitors::edge_margin(const Sample& sample) const {
  double left = std::numeric_limits<double>::infinity();
  if (plate.size) {
    left = std::min((*plate.size)[0] / 2 - std::abs(sample.ball.x),
                    (*plate.size)[1] / 2 - std::abs(sample.ball.y));
  }
  if (plate.diameter) {
    left = std::min(left, *plate.diameter / 2 - std::hypot(sample.ball.x, sample.ball.y));
  }
  return left;
}

void EventMonitors::margins(const Sample& sample, double* values) const {
  using Kind = Monitor::Kind;
  const bool asks_for_force =
      std::any_of(monitors.begin(), monitors.end(), [](const Monitor& monitor) {
        return monitor.kind == Kind::slip || monitor.kind == Kind::lift_off;
      });
  const Dynamics now{asks_for_force ? contact_force(sample, constants) : Eigen::Vector3d::Zero()};
  for (const Monitor& monitor : monitors) {
    double& value = *values++;
    switch (monitor.kind) {
      case Kind::edge:
        value = edge_margin(sample);
        break;
      case Kind::slip:
        value = monitor.limit * now.normal_force() - now.friction_force();
        break;
      case Kind::lift_off:
        // A force of exactly zero does not hold the ball.
        value = now.normal_force() != 0 ? now.normal_force() : -std::numeric_limits<double>::min();
        break;
      case Kind::tilt:
        value = monitor.limit - tilt(sample, constants);
        break;
      case Kind::singularity:
        value = singularity_distance(sample, constants) - monitor.limit;
        break;
      case Kind::dead_point:
        value = sample.to_dead_point;
        break;
    }
  }
}

EventMonitors event_monitors(const Scenario& scene) {
  EventMonitors list{{}, scene.plate, constants_of(scene)};
  const Events& events = scene.events;
  using Kind = Monitor::Kind;
  const double weight = list.constants.mass * (scene.gravity > 0 ? scene.gravity : 1.0);
  // Of the edge, the scale is the margin at the plate's center.
  if (events.edge) list.monitors.push_back({Kind::edge, *events.edge, list.edge_margin({})});
  if (events.slip && !events.slip->sliding) {
    list.monitors.push_back({Kind::slip, events.slip->action, weight, events.slip->friction});
  }
  // Friction proportional to a negative normal force would drive the ball.
  const bool in_proportion =
      scenario::has_dry_losses(scene) || (events.slip && events.slip->sliding);
  if (events.lift_off || in_proportion) {
    list.monitors.push_back({Kind::lift_off, events.lift_off.value_or(OnEvent::stop), weight});
  }
  // Feedback linearization leaves the tilt unstable. Without this event, the plane would turn over
  // faster and faster.
  const bool inverts = scene.controller && scene.controller->law == Law::feedback_linearisation;
  if (events.tilt || inverts) {
    const TiltEvent limit = events.tilt.value_or(TiltEvent{std::numbers::pi / 2, OnEvent::stop});
    list.monitors.push_back({Kind::tilt, limit.action, limit.limit, limit.limit});
  }
  if (events.singularity || inverts) {
    const SingularityEvent guard = events.singularity.value_or(SingularityEvent{});
    list.monitors.push_back({Kind::singularity, guard.action, guard.distance, guard.distance});
  }
  // The model has no motion beyond a dead point.
  if (scenario::is_linked(scene)) {
    list.monitors.push_back({Kind::dead_point, OnEvent::stop, 1});  // 1 rad
  }
  return list;
}

}  // namespace bbsim::model
