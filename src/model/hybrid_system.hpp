// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run of a scene in which things switch: the model in its present mode, what comes next, and what
// happens then. Whoever integrates knows no more of a rig than this class says.
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
  // `resolution`: what the integrator tells of a velocity from rest, m/s.
  HybridSystem(const Model& model, double resolution);
  HybridSystem(const HybridSystem&) = delete;  // mode_ is of this one's model
  HybridSystem& operator=(const HybridSystem&) = delete;

  // The model in the present mode. Its system's right-hand side changes with handle_time_event()
  // and handle_state_event() alone.
  [[nodiscard]] const Model& model() const { return model_; }

  // The next time (s) at which something happens that does not depend on the state; infinite if
  // nothing does any more.
  [[nodiscard]] double next_time_event() const {
    return sampled_ ? std::min(stop_, sampled_->exchange.next()) : stop_;
  }

  // Whether t is as good as next_time_event().
  [[nodiscard]] bool is_due(double t) const { return next_time_event() <= instant_end(t); }

  // Times nearer to t than this (s) are one with it but for their rounding.
  [[nodiscard]] double rounding(double t) const {
    return sampled_ ? sampled_->exchange.rounding(t) : rounding_of(t);
  }

  // Does what is due at t, the time of the start or next_time_event(). May change the states z.
  // Throws ControllerFault where a controller that is not built in does not do its part.
  void handle_time_event(double t, double* z);

  // handle_time_event() step by step, for who computes the laws of several runs at once: see();
  // while samples_at(), a sample, whose command is end_sample()'s; act(). Of a sampled loop.
  void see(double t, const double* z);
  [[nodiscard]] bool samples_at(double t) const {
    return sampled_ && sampled_->exchange.samples_by(instant_end(t));
  }
  // What is seen of the ball, m; nothing if it is missed.
  [[nodiscard]] std::optional<Pair> begin_sample(double t);
  [[nodiscard]] const std::array<Jet<double>, 2>& reference_at(double t);
  // `measured`: where the ball was seen last.
  void end_sample(const Pair& command, const Pair& measured) {
    sampled_->exchange.end_sample(command[0], command[1]);
    sampled_->measured = measured;
  }
  void act(double t, double* z);
  // Who computes the law in handle_time_event(); what it remembers is of the last sample there.
  [[nodiscard]] const SampledController& computer() const { return sampled_->controller; }

  // Whether the last act(), or handle_time_event(), may have changed how the model moves.
  [[nodiscard]] bool touched() const { return touched_; }
  // Whether the servos, their stops and the commands' limits have no state together in which the
  // run could go on.
  [[nodiscard]] bool unsettled() const { return unsettled_; }
  // Whether it did so by no more than what the servos follow; to be asked right after it.
  [[nodiscard]] bool only_commanded() const { return !settled_; }

  // The first of those times at which the motion may change: others only see it.
  [[nodiscard]] double next_change() const {
    return sampled_ ? std::min(stop_, sampled_->exchange.next_command()) : stop_;
  }
  // Whether that one is at t.
  [[nodiscard]] bool changes_at(double t) const { return next_change() <= instant_end(t); }

  // What is looked out for between: each guard is positive until something happens.
  [[nodiscard]] std::size_t guards() const { return guard_scales_.size(); }
  [[nodiscard]] const std::vector<double>& guard_scales() const { return guard_scales_; }
  void evaluate_guards(double t, const double* z, double* values) const;

  // The first `first_monitor()` guards are those of servos and of what is dry.
  [[nodiscard]] std::size_t first_monitor() const { return guards() - happening_.size(); }
  // Of each monitor after them, whether it is on the other side of zero at present.
  [[nodiscard]] const std::vector<char>& happening() const { return happening_; }

  // A guard that falls.
  struct Fall {
    double time = unlimited;  // s; infinite if none does
    std::size_t guard = 0;
  };
  // How the servos of phi and theta move from the states z on, in the present mode, as long as
  // their commands are held: of a rig without linkages.
  [[nodiscard]] std::array<HeldMotion, 2> held_motions(const double* z) const;
  // The first guard of a servo that falls after t, within (t, end], of servos that move so from t
  // on.
  [[nodiscard]] Fall next_fall(double t, const std::array<HeldMotion, 2>& motions, double end);

  // What keeps the servo of phi or theta, in its present mode, from switching.
  [[nodiscard]] ServoAxis::Clearance clearance(std::size_t axis) const {
    return servos_[axis].clearance();
  }

  // A reference at a time.
  struct KnownReference {
    double t = -1;  // s
    std::array<Jet<double>, 2> value{};
  };
  // The same at the times at which runs that go together last asked for it.
  class SharedReference {
   public:
    // Where it is, if it is known, at t.
    [[nodiscard]] KnownReference& at(double t) {
      return known_[std::bit_cast<std::uint64_t>(t) * 0x9e3779b97f4a7c15u >> (64 - bits)];
    }

   private:
    static constexpr int bits = 5;
    std::array<KnownReference, std::size_t{1} << bits> known_;
  };
  // Asks no more for what `shared`, which outlives the run, says of the scene's reference.
  void share_reference(SharedReference& shared) { shared_reference_ = &shared; }

  // Whether guard i stops the run once it has fallen to zero.
  [[nodiscard]] bool stops(std::size_t i) const;

  enum class Effect { none, restart, stop };

  // Guard i has fallen to zero at t. May change z; restart says that the integrator has to.
  Effect handle_state_event(std::size_t i, double t, double* z);

  // To be called after a jump, at the start too: what is watched for may have been jumped into.
  Effect check_events(double t, const double* z);

  // What a row of output has beside the states, at the present mode: Model::extras() numbers.
  void write_extras(double t, const double* z, double* out) const;

  // The integral of u = r gamma' where something has just occurred, m: of what handle_state_event()
  // and check_events() added to the occurrences since the last call.
  void note_turned(double integral);

  [[nodiscard]] const std::vector<Occurrence>& occurrences() const { return occurrences_; }

  // Who is asked at samples; null where the law is built in.
  [[nodiscard]] ExternalController* controller() const;

  // All that changes over a run (base/archive.hpp), but what has occurred and what controller()
  // remembers.
  template <class Archive>
  void archive(Archive& archive);

 private:
  static constexpr int axis_guards = ServoAxis::guards + 2;  // and two of the command's limit

  static constexpr int piece_guards = 4;  // of an axis with a measured curve

  // What law and servos ask for, of a rig with any servos.
  struct Wanted {
    Pair raw, command;                              // of the law, before its limit and behind
    double told[most_servos], demand[most_servos];  // of the servos, rad and rad/s^2
  };

  // How fast the law's commands move, in their unit per second.
  struct CommandRates {
    Pair raw, shown;  // before the limit, integral parts waiting; and as motors have them
  };

  // Calls `use` with the RigLoop, of a model that has one.
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
  // What every instant looks at is together.
  RigMode* mode_ = nullptr;  // of the model's system, if that is a rig
  bool switches_ = false;    // the rig does
  double stop_ = unlimited;  // the next one, s
  std::size_t next_stop_ = 0;
  bool touched_ = true, settled_ = true, unsettled_ = false;
  // An instant changes the motion only by what it makes a servo follow; what it makes them follow
  // is the command itself; whether something else than servos may have to be settled.
  bool only_commands_change_ = false, is_direct_ = false, only_servos_settle_ = false;
  std::vector<ServoAxis> servos_;
  KnownAnswers answers_;                                   // of the servos
  int rate_ = RigLayout::rate;                             // among the states, of the first servo
  std::size_t pieces_[2]{0, 0}, command_pieces_[2]{0, 0};  // of measured curves
  double reached_[2]{0, 0};            // the side of the limit that a command is exactly at; else 0
  mutable std::vector<double> rates_;  // of the states
  std::vector<double> guard_scales_;
  std::vector<char> happening_;  // for each monitor
  std::optional<DrySwitches> dry_;
  DrySwitches::State dry_state_;  // that occurrences know of

  struct Sampled {
    Pair measured{0, 0};
    SampleExchange exchange;
    SampledController controller;
    std::vector<double> own{};  // the last numbers of one's own controller
  };
  std::optional<Sampled> sampled_;
  KnownReference known_reference_;  // when it was asked for last, if nobody shares it
  SharedReference* shared_reference_ = nullptr;
  std::vector<Occurrence> occurrences_;
  std::size_t with_gamma_ = 0;  // so many of them
};

}  // namespace bbsim::model
