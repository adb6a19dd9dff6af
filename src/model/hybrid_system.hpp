// A run of a scene in which things switch: the model in its present mode, what comes next, and what
// happens then. Whoever integrates knows no more of a rig than this class says.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/control/external_controller.hpp"
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
  HybridSystem(const HybridSystem&) = delete;  // servos look at this one's rig
  HybridSystem& operator=(const HybridSystem&) = delete;

  // The model in the present mode. Its system's right-hand side changes with handle_time_event()
  // and handle_state_event() alone.
  [[nodiscard]] const Model& model() const { return model_; }

  // The next time (s) at which something happens that does not depend on the state; infinite if
  // nothing does any more.
  [[nodiscard]] double next_time_event() const;

  // Whether t is as good as next_time_event().
  [[nodiscard]] bool is_due(double t) const;

  // Times nearer to t than this (s) are one with it but for their rounding.
  [[nodiscard]] double rounding(double t) const;

  // Does what is due at t, the time of the start or next_time_event(). May change the states z.
  // Throws ControllerFault where a controller that is not built in does not do its part.
  void handle_time_event(double t, double* z);

  // What is looked out for between: each guard is positive until something happens.
  [[nodiscard]] std::size_t guards() const { return guard_scales_.size(); }
  [[nodiscard]] const std::vector<double>& guard_scales() const { return guard_scales_; }
  void evaluate_guards(double t, const double* z, double* values) const;

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

  // Calls `use` with the RigLoop, of a model that has one.
  template <class Use>
  auto with_loop(Use use) const;
  [[nodiscard]] RigMode& mode();
  [[nodiscard]] RigAxes<double> axes(double t, const double* z) const;
  [[nodiscard]] Sample sample(double t, const double* z, Detail detail) const;
  [[nodiscard]] AxisState axis_state(int i, const RigAxes<double>& wanted, const double* z) const;
  void settle(double t, double* z);
  void settle_rig(double t, double* z);
  Effect note_dry(double t, const double* z);
  Effect occur(std::string name, bool stops, double t, const double* z);
  bool settle_servos(double t, double* z);
  [[nodiscard]] double instant_end(double t) const;
  void settle_commands(double t, const double* z);
  void expose(const double* z);
  void take_sample(double t, const double* z);
  void apply_command();
  Effect occur(std::size_t monitor, double t, const double* z);

  // An instant that recurs: number * period + shift.
  struct Clock {
    double period, shift;
    double number = 0;
    [[nodiscard]] double next() const { return number * period + shift; }
  };

  Model model_;
  std::size_t next_stop_ = 0;
  std::vector<ServoAxis> servos_;
  std::vector<double> guard_scales_;
  std::vector<char> happening_;  // for each monitor
  std::optional<DrySwitches> dry_;
  DrySwitches::State dry_state_;  // that occurrences know of

  struct Sampled {
    BallSensor sensor;
    SampledController controller;
    Clock expose, sample, apply;
    std::vector<std::optional<Pair>> seen;  // exposed, not yet sampled: a queue
    std::vector<Pair> commands;             // computed, not yet applied: a queue
    Pair measured{0, 0};
    std::vector<double> own{};  // the last numbers of one's own controller
  };
  std::optional<Sampled> sampled_;
  std::vector<Occurrence> occurrences_;
  std::size_t with_gamma_ = 0;  // so many of them
};

}  // namespace bbsim::model
