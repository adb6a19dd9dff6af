#include "scenario/rules.hpp"
#include "scenario/sections.hpp"

namespace bbsim::input {
namespace {

void read_pd(Keys& keys, Controller& controller) {
  keys.required("kv", GainMatrix{}, controller.kv);
  keys.required("kp", GainMatrix{}, controller.kp);
}

void read_circle(Keys& keys, CircleReference& circle) {
  keys.required("radius", Number{Dimension::length, {.at_least = 0}}, circle.radius);
  keys.required("rate", Number{Dimension::angular_rate}, circle.rate);
  keys.optional("phase", Number{Dimension::angle}, circle.phase);
}

void read_reference(Keys& keys, Reference& reference) {
  keys.exactly_one({"circle", "point"});
  std::optional<CircleReference> circle;
  std::optional<Pair> point;
  keys.optional("circle", MappingOf(read_circle), circle);
  keys.optional("point", PairOf{Dimension::length}, point);
  if (circle) reference = *circle;
  if (point) reference = PointReference{*point};
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
