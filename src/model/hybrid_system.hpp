// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run of a scene with switches: the model in its present mode, the next event, and its effect.
// The integrator needs no other knowledge of a rig.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/instant.hpp"
#include "model/control/external_controller.hpp"
#include "model/control/integral_limit.hpp"
#include "model/control/sample_exchange.hpp"
#include "model/control/sampled_controller.hpp"
#include "model/dry_switches.hpp"
#include "model/events/occurrence.hpp"
#include "model/model.hpp"
#include "model/servo/servo_axis.hpp"

namespace bbsim::model {

class HybridSystem {
 public:
  // `resolution`: the smallest velocity that the integrator distinguishes from rest, m/s.
  HybridSystem(const Model& model, double resolution);
  HybridSystem(const HybridSystem&) = delete;  // mode_ points into this object's model
  HybridSystem& operator=(const HybridSystem&) = delete;

  // The model in the present mode. Only handle_time_event(), act() and handle_state_event() change
  // its right-hand side.
  [[nodiscard]] const Model& model() const { return model_; }

  // The next time (s) of an event that does not depend on the state; infinite if there is none.
  [[nodiscard]] double next_time_event() const {
    return sampled_ ? std::min(stop_, sampled_->exchange.next()) : stop_;
  }

  // Whether t equals next_time_event() up to rounding.
  [[nodiscard]] bool is_due(double t) const { return next_time_event() <= instant_end(t); }

  // Times within this distance of t (s) differ from t only by rounding.
  [[nodiscard]] double rounding(double t) const {
    return sampled_ ? sampled_->exchange.rounding(t) : rounding_of(t);
  }

  // Handles all events due at t, the start or next_time_event(). May change the states z. Throws
  // ControllerFault if an external controller fails.
  void handle_time_event(double t, double* z);

  // The steps of handle_time_event(), for integrators that compute the laws of several runs
  // together. For sampled loops: call see(); while samples_at(), call begin_sample() and
  // end_sample(); call act().
  void see(double t, const double* z);
  [[nodiscard]] bool samples_at(double t) const {
    return sampled_ && sampled_->exchange.samples_by(instant_end(t));
  }
  // The measurement of the ball for a sample, m; nothing if the sensor missed it.
  [[nodiscard]] std::optional<Pair> begin_sample(double t);
  [[nodiscard]] const std::array<Jet<double>, 2>& reference_at(double t);
  // Ends a sample with the law's command. `measured` is the last measurement of the ball.
  void end_sample(const Pair& command, const Pair& measured) {
    sampled_->exchange.end_sample(command[0], command[1]);
    sampled_->measured = measured;
  }
  void act(double t, double* z);
  // The controller that computes the law in handle_time_event(), with its state after the last
  // sample there.
  [[nodiscard]] const SampledController& computer() const { return sampled_->controller; }

  // Whether the last act() or handle_time_event() may have changed the motion.
  [[nodiscard]] bool touched() const { return touched_; }
  // Whether the servos, their stops and the limits of commands have no consistent mode. The run
  // cannot continue then.
  [[nodiscard]] bool unsettled() const { return unsettled_; }
  // Whether the last act() changed only the commands that the servos follow. Call it right
  // afterwards.
  [[nodiscard]] bool only_commanded() const { return !settled_; }

  // The next of these times at which the motion may change; other events only observe it.
  [[nodiscard]] double next_change() const {
    return sampled_ ? std::min(stop_, sampled_->exchange.next_command()) : stop_;
  }
  // Whether next_change() is at t.
  [[nodiscard]] bool changes_at(double t) const { return next_change() <= instant_end(t); }

  // The guards. Each is positive until its event occurs.
  [[nodiscard]] std::size_t guards() const { return guard_scales_.size(); }
  [[nodiscard]] const std::vector<double>& guard_scales() const { return guard_scales_; }
  void evaluate_guards(double t, const double* z, double* values) const;

  // The guards before `first_monitor()` belong to servos and dry friction.
  [[nodiscard]] std::size_t first_monitor() const { return guards() - happening_.size(); }
  // For each monitor guard, whether its event holds at present. The guard then has the opposite
  // sign.
  [[nodiscard]] const std::vector<char>& happening() const { return happening_; }

  // A guard that falls through zero.
  struct Fall {
    double time = unlimited;  // s; infinite if no guard falls
    std::size_t guard = 0;
  };
  // The motions of phi's and theta's servos from the states z, in the present mode, while their
  // commands are held. For rigs without linkages.
  [[nodiscard]] std::array<HeldMotion, 2> held_motions(const double* z) const;
  // The first guard of a servo that falls within (t, end], for servos with these motions from t.
  [[nodiscard]] Fall next_fall(double t, const std::array<HeldMotion, 2>& motions, double end);

  // The bounds within which the servo of phi or theta stays in its present mode.
  [[nodiscard]] ServoAxis::Clearance clearance(std::size_t axis) const {
    return servos_[axis].clearance();
  }

  // The reference at a time.
  struct KnownReference {
    double t = -1;  // s
    std::array<Jet<double>, 2> value{};
  };
  // A cache of references for runs that advance together.
  class SharedReference {
   public:
    // The cache entry for t, which may hold another time.
    [[nodiscard]] KnownReference& at(double t) {
      return known_[std::bit_cast<std::uint64_t>(t) * 0x9e3779b97f4a7c15u >> (64 - bits)];
    }

   private:
    static constexpr int bits = 5;
    std::array<KnownReference, std::size_t{1} << bits> known_;
  };
  // Uses the cache `shared`, which must outlive the run.
  void share_reference(SharedReference& shared) { shared_reference_ = &shared; }

  // Whether guard i stops the run when it falls.
  [[nodiscard]] bool stops(std::size_t i) const;

  enum class Effect { none, restart, stop };

  // Handles the fall of guard i at t. May change z. `restart`: the integrator must restart.
  Effect handle_state_event(std::size_t i, double t, double* z);

  // Checks for events that a jump has passed. Call it after every jump and at the start.
  Effect check_events(double t, const double* z);

  // Writes Model::extras() numbers for an output row: its part that depends on the mode.
  void write_extras(double t, const double* z, double* out) const;

  // Sets the rotation of the ball in the occurrences that handle_state_event() and check_events()
  // added since the last call. `integral` is that of u = r gamma' until now, m.
  void note_turned(double integral);

  [[nodiscard]] const std::vector<Occurrence>& occurrences() const { return occurrences_; }

  // The external controller; null for a built-in law.
  [[nodiscard]] ExternalController* controller() const;

  // The state of the run (base/archive.hpp), except the occurrences and the state of controller().
  template <class Archive>
  void archive(Archive& archive);

 private:
  static constexpr int axis_guards = ServoAxis::guards + 2;  // two more for the command's limits

  static constexpr int piece_guards = 4;  // for an axis with a measured curve

  // The demands of law and servos.
  struct Wanted {
    Pair raw, command;                              // of the law, before and after its limit
    double told[most_servos], demand[most_servos];  // to the servos, rad; of the servos, rad/s^2
  };

  // The rates of the law's commands, in their unit per second.
  struct CommandRates {
    Pair raw, shown;  // before the limit with waiting integrals; and at the motors
  };

  // Calls `use` with the model's RigLoop.
  template <class Use>
  auto with_loop(Use use) const;
  void pass_stops(double now);
  void put_stop();
  [[nodiscard]] Wanted axes(double t, const double* z) const;
  [[nodiscard]] RigExtras plane(const double* z) const;
  [[nodiscard]] Sample sample(double t, const double* z, Detail detail) const;
  [[nodiscard]] AxisState axis_state(int i, const Wanted& wanted, const double* z) const;
  [[nodiscard]] LinkCurve& curve(std::size_t axis);
  void put_pieces();
  void settle_pieces(double t, const double* z);
  void evaluate_pieces(const Wanted& wanted, const double* z, double* values) const;
  void settle(double t, double* z);
  [[nodiscard]] bool stays_as_it_is(const double* z) const;
  void settle_rig(double t, double* z);
  Effect note_dry(double t, const double* z);
  Effect occur(std::string name, bool stops, double t, const double* z);
  bool settle_servos(double t, double* z);
  [[nodiscard]] double instant_end(double t) const {
    return sampled_ ? sampled_->exchange.instant_end(t) : t + rounding_of(t);
  }
  void leave_limits(double t, double* z);
  void settle_commands(double t, const double* z);
  void settle_at_limits(double t, const double* z);
  void limit_command(int i, double side, AtLimit place, double push);
  void note_limit(std::size_t fallen);
  void evaluate_limit(int i, double raw, double t, const double* z, double* values) const;
  [[nodiscard]] bool integrates(int i) const;
  [[nodiscard]] CommandRates command_rates(double t, const double* z) const;
  [[nodiscard]] double command_push(int i, double t, const double* z) const;
  [[nodiscard]] OutwardRate outward_rate(int i, double side, const CommandRates& rates, double t,
                                         const double* z) const;
  [[nodiscard]] MotorCommands motor_commands(double t, const double* z, bool moving) const;
  void take_sample(double t, const double* z);
  void apply_command();
  Effect occur(std::size_t monitor, double t, const double* z);

  Model model_;
  // The data of every instant are adjacent in memory.
  RigMode* mode_ = nullptr;  // of the model's system, if it has a rig
  bool switches_ = false;    // the rig has switches
  double stop_ = unlimited;  // the next stop, s
  std::size_t next_stop_ = 0;
  bool touched_ = true, settled_ = true, unsettled_ = false;
  // An instant changes the motion only through commands; servos follow commands without a linkage;
  // only servos can change their mode.
  bool only_commands_change_ = false, is_direct_ = false, only_servos_settle_ = false;
  std::vector<ServoAxis> servos_;
  KnownAnswers answers_;        // for the servos
  int rate_ = RigLayout::rate;  // index of the first servo's rate in the states
  std::size_t pieces_[2]{0, 0}, command_pieces_[2]{0, 0};  // of measured curves
  double reached_[2]{0, 0};            // side of the limit that a command is exactly at, or 0
  mutable std::vector<double> rates_;  // of the states
  std::vector<double> guard_scales_;
  std::vector<char> happening_;  // of each monitor
  std::optional<DrySwitches> dry_;
  DrySwitches::State dry_state_;  // known to the occurrences

  struct Sampled {
    Pair measured{0, 0};
    SampleExchange exchange;
    SampledController controller;
    std::vector<double> own{};  // the last numbers from an external controller
  };
  std::optional<Sampled> sampled_;
  KnownReference known_reference_;  // used without a shared cache
  SharedReference* shared_reference_ = nullptr;
  std::vector<Occurrence> occurrences_;
  std::size_t with_gamma_ = 0;  // number of occurrences with gamma set
};

}  // namespace bbsim::model
