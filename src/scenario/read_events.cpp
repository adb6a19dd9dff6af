#include "scenario/sections.hpp"
#include "yaml/rules.hpp"

namespace bbsim::scenario {
namespace {

yaml::NameOf<OnEvent> action() {
  return {{{OnEvent::stop, "stop"}, {OnEvent::note, "note"}}};
}

void read_slip(yaml::Keys& keys, SlipEvent& slip) {
  keys.required("friction", yaml::Number{yaml::Dimension::number, {.above = 0}, "0.3"},
                slip.friction);
  keys.optional("action", action(), slip.action);
}

void read_tilt(yaml::Keys& keys, TiltEvent& tilt) {
  keys.required("limit", yaml::AngleLimit{{.above = 0}}, tilt.limit);
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
}

}  // namespace bbsim::scenario
