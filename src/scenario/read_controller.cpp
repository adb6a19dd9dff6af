#include "scenario/rules.hpp"
#include "scenario/sections.hpp"

namespace bbsim::input {
namespace {

void read_pd(Keys& keys, Controller& controller) {
  keys.required("kv", GainMatrix{}, controller.kv);
  keys.required("kp", GainMatrix{}, controller.kp);
}

}  // namespace

void read_controller(Keys& keys, Controller& controller) {
  keys.section("pd", read_pd, controller);
  keys.optional("drives",
                NameOf<Drives>{{{Drives::acceleration, "acceleration"}, {Drives::angle, "angle"}}},
                controller.drives);
  keys.section("reference", read_reference, controller.reference);
}

}  // namespace bbsim::input
