#include "scenario/rules.hpp"
#include "scenario/sections.hpp"

namespace bbsim::input {
namespace {

NameOf<OnEvent> action() {
  return {{{OnEvent::stop, "stop"}, {OnEvent::note, "note"}}};
}

void read_slip(Keys& keys, SlipEvent& slip) {
  keys.required("friction", Number{Dimension::number, {.above = 0}, "0.3"}, slip.friction);
  keys.optional("action", action(), slip.action);
}

void read_tilt(Keys& keys, TiltEvent& tilt) {
  keys.required("limit", AngleLimit{{.above = 0}}, tilt.limit);
  keys.optional("action", action(), tilt.action);
}

void read_singularity(Keys& keys, SingularityEvent& singularity) {
  keys.optional("distance", Number{Dimension::number, {.above = 0, .at_most = 1}, "0.1"},
                singularity.distance);
  keys.optional("action", action(), singularity.action);
}

}  // namespace

void read_events(Keys& keys, Events& events) {
  keys.optional("edge", action(), events.edge);
  keys.optional("slip", MappingOf(read_slip), events.slip);
  keys.optional("lift_off", action(), events.lift_off);
  keys.optional("tilt", MappingOf(read_tilt), events.tilt);
  keys.optional("singularity", MappingOf(read_singularity), events.singularity);
}

}  // namespace bbsim::input
