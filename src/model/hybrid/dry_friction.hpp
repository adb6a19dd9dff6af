// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Switches of dry friction and of sliding contacts: what rests, what moves, in which direction
// (docs/explanation/losses-and-torques.md).
//
// A dry force keeps a part at rest while rest needs less than its limit; otherwise it opposes the
// motion. Motion along a line has one of two signs, so only its start and end switch. Motion in the
// plane can have any direction, and at rest it has none. Below the speed that the tolerance
// resolves, the direction is held constant.
#pragma once

#include <vector>

#include "model/hybrid/monitors.hpp"
#include "model/hybrid/part.hpp"

namespace bbsim::model {

class DryFriction : public Part {
 public:
  // `resolution` (m/s): slower velocities count as near rest.
  DryFriction(SwitchedModel& model, double resolution, EventLog& log)
      : model_(model),
        parts_(*model.get().dry),
        scene_(DryScene::of(model)),
        resolution_(resolution),
        log_(log) {}

  [[nodiscard]] static std::size_t guards() { return Guard::count; }
  void append_scales(std::vector<double>& scales) const;
  void evaluate(const GuardContext& now, double* values) const;
  // Sets velocities that have reached zero to exactly zero.
  [[nodiscard]] bool reset(double t, double* z);

  // Logs the starts and ends of sliding since the last call, and rests that are events of the
  // scene.
  Effect note_events(double t, const double* z);

  // The parts of the mode that may be events.
  struct State {
    bool slides = false, rests = false;
    bool sticks[2] = {false, false};
  };
  [[nodiscard]] State state() const;

 private:
  // Ends of rests and of motions, and speeds at which a direction is held or released.
  struct Guard {
    enum : std::size_t { roll, roll_speed, slip, slip_speed, spin, phi, theta, count };
  };
  // Parts with zero velocity. reset() decides whether they start to move.
  struct AtZero {
    bool slip = false, roll = false, spin = false, axis[2] = {false, false};
  };

  // Speed below which a motion is near rest, m/s. It grows with the rounding of t.
  [[nodiscard]] double slow(double t) const;
  [[nodiscard]] AtZero stop_parts(double t, double* z);
  void choose(double t, const double* z, const AtZero& zero);
  [[nodiscard]] int faults(double t, const double* z, const AtZero& zero, bool slide, bool rest);
  void start(double t, const double* z, bool slip, bool roll);

  SwitchedModel& model_;
  const DryParts& parts_;
  DryScene scene_;
  double resolution_;
  EventLog& log_;
  State noted_;  // at the last note_events()
};

}  // namespace bbsim::model
