// Scenario -> Model: the smallest system that gives the scene's answer.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "model/system.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

using System = std::variant<
    OpenLoop<Shape::full>, OpenLoop<Shape::along_x>,
    OpenLoop<Shape::along_y>,  //
    ClosedLoop<Shape::full, Drives::acceleration>, ClosedLoop<Shape::along_x, Drives::acceleration>,
    ClosedLoop<Shape::along_y, Drives::acceleration>, ClosedLoop<Shape::full, Drives::angle>,
    ClosedLoop<Shape::along_x, Drives::angle>, ClosedLoop<Shape::along_y, Drives::angle>>;

// A part of the physics that the scene has, or does without, and why.
struct Note {
  std::string part, reason;
};

struct Model {
  System system;
  std::vector<double> initial;  // states at t = 0, as the system packs them
  bool gamma = false;           // integrate gamma' beside the states
  double radius = 0;            // m
  std::vector<double> stops;    // times in (0, end) at which a derivative of the input jumps, s
  std::vector<Note> notes;      // for `bbsim check` and the summary

  [[nodiscard]] std::size_t size() const { return initial.size(); }
  [[nodiscard]] std::vector<std::string> state_names() const;
  [[nodiscard]] bool closed_loop() const;
};

// Builds what the scene needs. `gamma` says whether an output column asks for that angle.
[[nodiscard]] Model assemble(const Scenario& scenario, bool gamma);

// Index of u = r gamma' among the states, or -1 where symmetry keeps it zero.
template <class AnySystem>
inline constexpr int spin_index = AnySystem::moves == Shape::full ? 4 : -1;

}  // namespace bbsim::model
