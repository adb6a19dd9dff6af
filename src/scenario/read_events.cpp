// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `events`.
#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

yaml::NameOf<OnEvent> action() {
  return {{{OnEvent::stop, "stop"}, {OnEvent::note, "note"}}};
}

enum class OnSlip { stop, note, slide };

void read_slip(yaml::Keys& keys, SlipEvent& slip) {
  keys.required("friction", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.3"},
                slip.friction);
  OnSlip action = slip.action == OnEvent::stop ? OnSlip::stop : OnSlip::note;
  keys.optional("action",
                yaml::NameOf<OnSlip>{
                    {{OnSlip::stop, "stop"}, {OnSlip::note, "note"}, {OnSlip::slide, "slide"}}},
                action);
  slip.action = action == OnSlip::stop ? OnEvent::stop : OnEvent::note;
  const yaml::Number sliding{yaml::Dimension::number, {.at_least = 0}, "0.25"};
  if (action == OnSlip::slide) {
    keys.required("sliding_friction", sliding, slip.sliding.emplace());
    if (*slip.sliding > slip.friction && slip.friction > 0) {
      if (const auto found = keys.find("sliding_friction")) {
        found->report(
            "found more than friction, at which the ball starts to slide; allowed: at most "
            "friction");
      }
    }
  } else if (const auto found = keys.find("sliding_friction", sliding)) {
    double unused = 0;
    if (sliding.read(*found, unused)) {
      found->report("found, but action is not slide; allowed: only with action: slide");
    }
  }
}

void read_tilt(yaml::Keys& keys, TiltEvent& tilt) {
  keys.required("limit", yaml::angle_limit({.above = 0}), tilt.limit);
  keys.optional("action", action(), tilt.action);
}

void read_singularity(yaml::Keys& keys, SingularityEvent& singularity) {
  keys.optional("distance",
                yaml::Number{yaml::Dimension::number, {.above = 0, .at_most = 1}, "0.1"},
                singularity.distance);
  keys.optional("action", action(), singularity.action);
}

}  // namespace

void read_events(yaml::Keys& keys, Events& events) {
  keys.optional("edge", action(), events.edge);
  keys.optional("slip", yaml::MappingOf(read_slip), events.slip);
  keys.optional("lift_off", action(), events.lift_off);
  keys.optional("tilt", yaml::MappingOf(read_tilt), events.tilt);
  keys.optional("singularity", yaml::MappingOf(read_singularity), events.singularity);
  keys.optional("rest", action(), events.rest);
  keys.optional("stick", action(), events.stick);
  keys.optional("steps_lost", action(), events.steps_lost);
}

}  // namespace bbsim::scenario
