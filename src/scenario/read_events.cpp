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
  keys.required(
      "friction", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.3"}, slip.friction,
      {"coefficient of static friction: the friction force exceeds it times the normal force"});
  OnSlip action = slip.action == OnEvent::stop ? OnSlip::stop : OnSlip::note;
  keys.optional("action",
                yaml::NameOf<OnSlip>{
                    {{OnSlip::stop, "stop"}, {OnSlip::note, "note"}, {OnSlip::slide, "slide"}}},
                action, {"`slide`: the ball slides: [losses and sliding](#losses-and-sliding)"});
  slip.action = action == OnSlip::stop ? OnEvent::stop : OnEvent::note;
  const yaml::Number sliding{yaml::Dimension::number, {.at_least = 0}, "0.25"};
  std::optional<double> given;
  keys.optional("sliding_friction", sliding, given,
                {.meaning = "coefficient of sliding friction",
                 .standard = "required with `slide`",
                 .range = "0 to `friction`"});
  if (action != OnSlip::slide) return;
  slip.sliding = given.value_or(0);
  if (*slip.sliding > slip.friction && slip.friction > 0) {
    keys.find("sliding_friction")
        ->report(
            "found more than friction, at which the ball starts to slide; allowed: at most "
            "friction");
  }
}

void read_tilt(yaml::Keys& keys, TiltEvent& tilt) {
  keys.required("limit", yaml::angle_limit({.above = 0}), tilt.limit,
                {"the angle between the plate's normal and the vertical exceeds it"});
  keys.optional("action", action(), tilt.action);
}

void read_singularity(yaml::Keys& keys, SingularityEvent& singularity) {
  keys.optional("distance",
                yaml::Number{yaml::Dimension::number, {.above = 0, .at_most = 1}, "0.1"},
                singularity.distance, {"the column `singularity_distance` falls below it"});
  keys.optional("action", action(), singularity.action);
}

}  // namespace

void read_events(yaml::Keys& keys, Events& events) {
  keys.optional("edge", action(), events.edge, {"the contact point leaves the plate"});
  keys.optional("slip", yaml::MappingOf(read_slip), events.slip);
  keys.optional("lift_off", action(), events.lift_off, {"the normal force is no longer positive"});
  keys.optional("tilt", yaml::MappingOf(read_tilt), events.tilt);
  keys.optional("singularity", yaml::MappingOf(read_singularity), events.singularity);
  keys.optional("rest", action(), events.rest,
                {"rolling resistance brings the ball to rest, or holds it at the start"});
  keys.optional(
      "stick", action(), events.stick,
      {"dry friction of its motor holds an axis; recorded as `stick_phi` or `stick_theta`"});
  keys.optional("steps_lost", action(), events.steps_lost,
                {"a stepper with `torque` loses steps; noted, unless this is `stop`"});
}

}  // namespace bbsim::scenario
