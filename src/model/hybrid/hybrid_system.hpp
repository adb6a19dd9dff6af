// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run of a scene with switches: the model in its present mode, the next event, and its effect.
// The integrator needs to know nothing else about a rig.
//
// Each kind of switch is a Part (part.hpp), most in a file of this folder. HybridSystem holds the
// parts that the scene needs, concatenates their guards, and resets all of them together.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>
#include <vector>

#include "base/instant.hpp"
#include "model/hybrid/dry_friction.hpp"
#include "model/hybrid/limits.hpp"
#include "model/hybrid/monitors.hpp"
#include "model/hybrid/part.hpp"
#include "model/hybrid/sampling.hpp"
#include "model/hybrid/servos.hpp"

namespace bbsim::model {

// The stops of the input: times at which the input or one of its derivatives jumps.
class Stops : public Part {
 public:
  explicit Stops(const std::vector<double>& times) : times_(times) { put(); }

  [[nodiscard]] double next_time() const { return time_; }
  [[nodiscard]] double next_change() const { return time_; }
  void observe(double t, const double* /*z*/) {
    while (time_ <= t) {
      ++next_;
      put();
    }
  }

 private:
  void put() { time_ = next_ < times_.size() ? times_[next_] : unlimited; }

  const std::vector<double>& times_;
  std::size_t next_ = 0;
  double time_ = unlimited;  // the next stop, s
};

// Part of a given type in a tuple of optional parts; null if absent.
template <class Part, class Parts>
[[nodiscard]] auto* part_of(Parts& parts) {
  auto& part = std::get<std::optional<Part>>(parts);
  return part ? &*part : nullptr;
}

// Calls `use` with each part that is present.
template <class Parts, class Use>
void for_each(Parts& parts, Use use) {
  std::apply([&](auto&... part) { ((part ? use(*part) : void()), ...); }, parts);
}

class HybridSystem {
 public:
  // `resolution`: the smallest velocity that the integrator distinguishes from rest, m/s.
  HybridSystem(const Model& model, double resolution);

  // The model in the present mode. Only handle_time_event(), act() and handle_state_event()
  // change its right-hand side.
  [[nodiscard]] const Model& model() const { return model_.get(); }

  // Time (s) of the next event that does not depend on the state; infinite if there is none.
  [[nodiscard]] double next_time_event() const {
    return first_of([](const auto& part) { return part.next_time(); });
  }
  // Time (s) of the next such event that may change the motion; others only observe it.
  [[nodiscard]] double next_change() const {
    return first_of([](const auto& part) { return part.next_change(); });
  }
  // Whether t has reached next_time_event() or next_change(), up to rounding.
  [[nodiscard]] bool is_due(double t) const { return next_time_event() <= instant_end(t); }
  [[nodiscard]] bool changes_at(double t) const { return next_change() <= instant_end(t); }

  // Times within this distance of t (s) differ from t only by rounding.
  [[nodiscard]] double rounding(double t) const {
    return sampling() != nullptr ? sampling()->rounding(t) : rounding_of(t);
  }

  // Handles all events due at t, which is the start or next_time_event(). May change the states z.
  // Returns false, and has changed nothing, if an external controller has no answer yet. Throws
  // ControllerFault if it fails.
  bool handle_time_event(double t, double* z);

  // The steps of handle_time_event(), for integrators that compute the laws of several runs
  // together: observe(); while samples_at(), begin and end a sample of sampling(); act().
  void observe(double t, const double* z);
  [[nodiscard]] bool samples_at(double t) const {
    return sampling() != nullptr && sampling()->samples_by(instant_end(t));
  }
  void act(double t, double* z);
  // Null unless the rig is sampled.
  [[nodiscard]] Sampling* sampling() { return part_of<Sampling>(parts_); }
  [[nodiscard]] const Sampling* sampling() const { return part_of<Sampling>(parts_); }
  // The end of the instant t, s.
  [[nodiscard]] double instant_end(double t) const {
    return sampling() != nullptr ? sampling()->instant_end(t) : t + rounding_of(t);
  }

  // Whether the last act() or handle_time_event() may have changed the motion.
  [[nodiscard]] bool touched() const { return touched_; }
  // Whether a reset found no consistent mode of servos, their stops and command limits. The run
  // then cannot continue.
  [[nodiscard]] bool unsettled() const { return unsettled_; }
  // Whether a stepper has lost steps, which stops the run.
  [[nodiscard]] bool stops() const { return stops_; }
  // Whether the last act() changed only the commands that the servos follow. Call it right
  // afterwards.
  [[nodiscard]] bool only_commanded() const { return !touched_ || !servos()->chose(); }

  // Guards, each positive until its event occurs. Those of the monitors come last.
  [[nodiscard]] std::size_t guards() const { return first_guard_.back(); }
  [[nodiscard]] std::size_t first_monitor() const { return first_guard_[monitors_at]; }
  [[nodiscard]] const std::vector<double>& guard_scales() const { return guard_scales_; }
  void evaluate_guards(double t, const double* z, double* values) const;

  // For each monitor guard, whether its event holds at present. The guard then has the opposite
  // sign.
  [[nodiscard]] const std::vector<char>& occurring() const {
    static const std::vector<char> none;
    const auto* const monitors = part_of<Monitors>(parts_);
    return monitors != nullptr ? monitors->occurring() : none;
  }
  // Whether guard i stops the run when it crosses zero.
  [[nodiscard]] bool stops(std::size_t i) const {
    return i >= first_monitor() && part_of<Monitors>(parts_)->stops(i - first_monitor());
  }

  // The servos of a rig; otherwise null. In a sampled rig, their guards come first.
  [[nodiscard]] Servos* servos() { return part_of<Servos>(parts_); }
  [[nodiscard]] const Servos* servos() const { return part_of<Servos>(parts_); }

  // Handles the crossing of guard i at t. May change z.
  Effect handle_state_event(std::size_t i, double t, double* z);

  // Checks for events that a jump skipped. Call it after every jump and at the start.
  Effect check_events(double t, const double* z);

  // Writes the Model::extras() numbers of an output row, the part that depends on the mode.
  void write_extras(double t, const double* z, double* out) const;

  // The events since the start. note_turned() sets the rotation of the ball in the latest ones.
  [[nodiscard]] EventLog& log() { return log_; }

  // The external controller; null for a built-in law.
  [[nodiscard]] ExternalController* controller() const {
    return sampling() != nullptr ? model().rig->sampled->external.get() : nullptr;
  }

 private:
  // The order is that of the guards and of the resets.
  using Parts =
      std::tuple<std::optional<Stops>, std::optional<Sampling>, std::optional<CommandLimits>,
                 std::optional<CurvePieces>, std::optional<Servos>, std::optional<MotorLimits>,
                 std::optional<DryFriction>, std::optional<Monitors>>;
  static constexpr std::size_t monitors_at = std::tuple_size_v<Parts> - 1;

  // Earliest of the times that `time` gives for the parts, s.
  template <class Time>
  [[nodiscard]] double first_of(Time time) const {
    double first = unlimited;
    for_each(parts_, [&](const auto& part) { first = std::min(first, time(part)); });
    return first;
  }
  void reset(double t, double* z);
  Effect note_dry(double t, const double* z);

  SwitchedModel model_;
  Parts parts_;
  EventLog log_;
  // Time events change the motion only through commands.
  bool only_commands_change_ = false;
  bool touched_ = true, unsettled_ = false, stops_ = false;
  // Index of each part's first guard; last, the number of guards.
  std::array<std::size_t, std::tuple_size_v<Parts> + 1> first_guard_{};
  std::vector<double> guard_scales_;
};

}  // namespace bbsim::model
