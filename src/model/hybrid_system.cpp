#include "model/hybrid_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/archive.hpp"
#include "base/instant.hpp"

namespace bbsim::model {
namespace {

// Instants of different clocks that are nearer than this, relative to the period, are one.
constexpr double one_instant = 1e-9;

constexpr int angle = RigLayout::angle, rate = RigLayout::rate;  // of phi, among the states

}  // namespace

template <class Use>
auto HybridSystem::with_loop(Use use) const {
  if (const auto* plain = std::get_if<RigLoop<false>>(&model_.system)) return use(*plain);
  if (const auto* coupled = std::get_if<CoupledLoop<>>(&model_.system)) return use(coupled->loop);
  return use(std::get<RigLoop<true>>(model_.system));
}

RigMode& HybridSystem::mode() {
  if (auto* plain = std::get_if<RigLoop<false>>(&model_.system)) return plain->mode;
  if (auto* coupled = std::get_if<CoupledLoop<>>(&model_.system)) return coupled->loop.mode;
  return std::get<RigLoop<true>>(model_.system).mode;
}

RigAxes<double> HybridSystem::axes(double t, const double* z) const {
  return with_loop([&](const auto& loop) { return loop.axes(loop.inputs(t), z); });
}

HybridSystem::HybridSystem(const Model& model, double resolution) : model_(model) {
  if (model_.rig) {
    const Rig& rig = *model_.rig;
    // With backlash the plane rests in mid-gap, whatever the servo's rate.
    if (rig.backlash > 0) {
      for (AxisMode& axis : mode().axis) axis.ratio = 0;
    }
    const ServoResponse servo = with_loop([](const auto& loop) { return loop.servo(); });
    for (const double offset : rig.offset) servos_.emplace_back(rig, servo, offset);
    if (rig.switches()) {
      for (int i = 0; i < 2; ++i) {
        double scales[axis_guards];
        servos_[static_cast<std::size_t>(i)].scales(scales);
        scales[axis_guards - 2] = scales[axis_guards - 1] =
            rig.command_limit < unlimited ? rig.command_limit : 1.0;
        guard_scales_.insert(guard_scales_.end(), scales, scales + axis_guards);
      }
    }
    if (rig.sampled) {
      const Sampling& of = rig.sampled->sampling;
      const Sensor& sensor = rig.sampled->sensor;
      sampled_.emplace(Sampled{BallSensor(sensor),
                               SampledController(*rig.sampled),
                               {of.period, -sensor.delay},
                               {of.period, 0},
                               {of.period, of.delay},
                               {},
                               {}});
      if (rig.sampled->law.kind == LawKind::held && !rig.sampled->external) {
        throw std::logic_error("a run of a scene whose controller nobody has attached");
      }
      sampled_->own.assign(model_.own_columns().size(), std::numeric_limits<double>::quiet_NaN());
    }
  }
  if (model_.dry) {
    dry_.emplace(*model_.dry, resolution);
    dry_->append_scales(guard_scales_);
  }
  const std::size_t monitors = model_.events ? model_.events->monitors.size() : 0;
  guard_scales_.insert(guard_scales_.end(), monitors, 1.0);
  happening_.assign(monitors, 0);
}

double HybridSystem::next_time_event() const {
  double next = next_stop_ < model_.stops.size() ? model_.stops[next_stop_] : unlimited;
  if (sampled_) {
    next =
        std::min({next, sampled_->expose.next(), sampled_->sample.next(), sampled_->apply.next()});
  }
  return next;
}

double HybridSystem::rounding(double t) const {
  // What the sensor sees at t is of the sample at t + delay.
  return rounding_of(sampled_ ? t - sampled_->expose.shift : t);
}

// Until when instants are one with t: a run of no length between them is none.
double HybridSystem::instant_end(double t) const {
  return t +
         (sampled_ ? std::max(rounding(t), one_instant * sampled_->sample.period) : rounding(t));
}

bool HybridSystem::is_due(double t) const {
  return next_time_event() <= instant_end(t);
}

void HybridSystem::handle_time_event(double t, double* z) {
  const double now = instant_end(t);
  while (next_stop_ < model_.stops.size() && model_.stops[next_stop_] <= now) ++next_stop_;
  if (sampled_) {
    while (sampled_->expose.next() <= now) expose(z);
    while (sampled_->sample.next() <= now) take_sample(t, z);
    while (sampled_->apply.next() <= now) apply_command();
  }
  settle(t, z);
}

void HybridSystem::expose(const double* z) {
  ++sampled_->expose.number;
  sampled_->seen.push_back(sampled_->sensor.read({z[0], z[1]}));
}

ExternalController* HybridSystem::controller() const {
  return model_.rig && model_.rig->sampled ? model_.rig->sampled->external.get() : nullptr;
}

void HybridSystem::take_sample(double t, const double* z) {
  const double number = sampled_->sample.number++;
  const std::optional<Pair> seen = sampled_->seen.front();
  sampled_->seen.erase(sampled_->seen.begin());
  const double servo[4] = {z[angle], z[angle + 1], z[rate], z[rate + 1]};
  const auto reference = with_loop([t](const auto& loop) { return loop.reference().at(t); });
  SampledController& controller = sampled_->controller;
  if (ExternalController* const external = this->controller()) {
    if (number == 0) external->begin();
    const ControllerSample sample{static_cast<std::size_t>(number), t, seen, servo, reference};
    sampled_->commands.push_back(
        controller.within_limits(external->command(sample, sampled_->own.data())));
    if (seen) sampled_->measured = *seen;
    return;
  }
  sampled_->commands.push_back(controller.command(seen, servo, reference));
  sampled_->measured = controller.last_seen();
}

void HybridSystem::apply_command() {
  ++sampled_->apply.number;
  const Pair command = sampled_->commands.front();
  sampled_->commands.erase(sampled_->commands.begin());
  for (std::size_t i = 0; i < 2; ++i) {
    mode().command[i] = servos_[i].follow(command[i]);
  }
}

// Whether a continuous law's command is at its limit.
void HybridSystem::settle_commands(double t, const double* z) {
  const double limit = model_.rig->command_limit;
  RigMode& present = mode();
  for (int i = 0; i < 2; ++i) {
    const double raw = axes(t, z).command.raw[i];
    AxisMode& axis = present.axis[i];
    const bool within = std::abs(raw) <= limit;
    axis.command_factor = within ? 1 : 0;
    axis.set_command = within ? 0 : std::copysign(limit, raw);
  }
  // The integral of the error in each coordinate waits while a command that it acts on is at its
  // limit.
  const ControlLaw law = with_loop([](const auto& loop) { return loop.law(); });
  for (int j = 0; j < 2; ++j) {
    bool waits = false;
    for (int i = 0; i < 2; ++i) {
      waits = waits || (law.integral[i][j] != 0 && present.axis[i].command_factor == 0);
    }
    present.axis[j].integrate = waits ? 0 : 1;
  }
}

AxisState HybridSystem::axis_state(int i, const RigAxes<double>& wanted, const double* z) const {
  return {z[angle + i], z[rate + i], wanted.demand[i], wanted.command.value[i]};
}

void HybridSystem::settle(double t, double* z) {
  if (model_.rig) settle_rig(t, z);
  if (dry_) dry_->settle(model_, t, z);
}

void HybridSystem::settle_rig(double t, double* z) {
  // A stop's kick may take the command to its limit, and that the servo from where it was: a few
  // rounds, of which the second mostly finds nothing to do.
  for (int round = 0; round < 4; ++round) {
    if (model_.rig->command_limit < unlimited) settle_commands(t, z);
    if (!settle_servos(t, z)) return;
  }
}

// Whether a servo was taken from where it was, or a rate of the plane jumped.
bool HybridSystem::settle_servos(double t, double* z) {
  const RigAxes<double> wanted = axes(t, z);
  double rate_before[2], jump[2];
  bool jumps = false, moved = false;
  for (int i = 0; i < 2; ++i) rate_before[i] = mode().axis[i].ratio * z[rate + i];
  for (int i = 0; i < 2; ++i) {
    AxisState state = axis_state(i, wanted, z);
    AxisMode& axis = mode().axis[i];
    servos_[static_cast<std::size_t>(i)].settle(state, axis);
    moved = moved || state.angle != z[angle + i] || state.rate != z[rate + i];
    z[angle + i] = state.angle;
    z[rate + i] = state.rate;
    jump[i] = axis.ratio * z[rate + i] - rate_before[i];
    jumps = jumps || jump[i] != 0;
  }
  if (!jumps) return moved;
  const auto kick = with_loop([&](const auto& loop) { return loop.impulse(z, jump[0], jump[1]); });
  for (int i = 0; i < 3; ++i) z[2 + i] += kick[static_cast<std::size_t>(i)];
  return true;
}

Sample HybridSystem::sample(double t, const double* z, Detail detail) const {
  return std::visit([&](const auto& system) { return system.sample(t, z, detail); }, model_.system);
}

void HybridSystem::evaluate_guards(double t, const double* z, double* values) const {
  if (model_.rig && model_.rig->switches()) {
    const RigAxes<double> wanted = axes(t, z);
    const RigMode present = with_loop([](const auto& loop) { return loop.mode; });
    const double limit = model_.rig->command_limit;
    for (int i = 0; i < 2; ++i, values += axis_guards) {
      servos_[static_cast<std::size_t>(i)].evaluate(axis_state(i, wanted, z), values);
      double* const command = values + ServoAxis::guards;
      const AxisMode& axis = present.axis[i];
      const double raw = wanted.command.raw[i];
      const bool free = axis.command_factor != 0;
      command[0] = limit == unlimited ? unlimited : free ? limit - raw : unlimited;
      command[1] = limit == unlimited ? unlimited : free ? limit + raw : unlimited;
      // A command at a limit is watched at that one alone: it can pass to the other in no time.
      if (!free && axis.set_command > 0) command[0] = raw - limit;
      if (!free && axis.set_command < 0) command[1] = -raw - limit;
    }
  }
  if (dry_) {
    dry_->evaluate(model_, t, z, values);
    values += DrySwitches::guards;
  }
  if (happening_.empty()) return;
  model_.events->margins(sample(t, z, Detail::motion), values);
  for (std::size_t m = 0; m < happening_.size(); ++m) {
    if (happening_[m] != 0) values[m] = -values[m];
  }
}

HybridSystem::Effect HybridSystem::occur(std::size_t monitor, double t, const double* z) {
  happening_[monitor] = 1;
  const Monitor& what = model_.events->monitors[monitor];
  return occur(what.name(), what.action == OnEvent::stop, t, z);
}

HybridSystem::Effect HybridSystem::occur(std::string name, bool stops, double t, const double* z) {
  Sample now = sample(t, z, Detail::all);
  now.gamma = model_.gamma_not_integrated();
  if (sampled_) now.measured = sampled_->measured;
  occurrences_.push_back(
      {t, std::move(name), stops, now, sampled_ ? sampled_->own : std::vector<double>{}});
  return stops ? Effect::stop : Effect::none;
}

void HybridSystem::note_turned(double integral) {
  for (; with_gamma_ < occurrences_.size(); ++with_gamma_) {
    if (model_.gamma) occurrences_[with_gamma_].sample.gamma = integral / model_.radius;
  }
}

HybridSystem::Effect HybridSystem::handle_state_event(std::size_t i, double t, double* z) {
  const std::size_t first_monitor = guards() - happening_.size();
  if (i < first_monitor) {
    settle(t, z);
    return note_dry(t, z) == Effect::stop ? Effect::stop : Effect::restart;
  }
  const std::size_t monitor = i - first_monitor;
  if (happening_[monitor] == 0) return occur(monitor, t, z);
  happening_[monitor] = 0;
  return Effect::none;
}

// What has begun or ended since this was last asked: sliding, always told of, and rests that are
// events of the scene.
HybridSystem::Effect HybridSystem::note_dry(double t, const double* z) {
  if (!dry_) return Effect::none;
  const DrySwitches::State now = dry_->state(model_), before = std::exchange(dry_state_, now);
  Effect effect = Effect::none;
  const auto note = [&](const char* name, const std::optional<OnEvent>& event) {
    if (event && occur(name, *event == OnEvent::stop, t, z) == Effect::stop) effect = Effect::stop;
  };
  if (now.slides != before.slides) note(now.slides ? "slip" : "roll", OnEvent::note);
  if (now.rests && !before.rests) note("rest", model_.dry->rest);
  if (now.sticks[0] && !before.sticks[0]) note("stick_phi", model_.dry->stick);
  if (now.sticks[1] && !before.sticks[1]) note("stick_theta", model_.dry->stick);
  return effect;
}

bool HybridSystem::stops(std::size_t i) const {
  const std::size_t first_monitor = guards() - happening_.size();
  return i >= first_monitor && happening_[i - first_monitor] == 0 &&
         model_.events->monitors[i - first_monitor].action == OnEvent::stop;
}

HybridSystem::Effect HybridSystem::check_events(double t, const double* z) {
  if (note_dry(t, z) == Effect::stop) return Effect::stop;
  if (happening_.empty()) return Effect::none;
  const Sample now = sample(t, z, Detail::motion);
  for (std::size_t m = 0; m < happening_.size(); ++m) {
    const bool beyond = model_.events->margin(model_.events->monitors[m], now) < 0;
    if (beyond && happening_[m] == 0 && occur(m, t, z) == Effect::stop) return Effect::stop;
    if (!beyond) happening_[m] = 0;
  }
  return Effect::none;
}

template <class Archive>
void HybridSystem::archive(Archive& archive) {
  if (model_.rig) archive(mode());
  archive(next_stop_, happening_);
  for (ServoAxis& servo : servos_) archive(servo);
  if (!sampled_) return;
  Sampled& of = *sampled_;
  archive(of.sensor, of.controller, of.expose.number, of.sample.number, of.apply.number, of.seen,
          of.commands, of.measured, of.own);
}

template void HybridSystem::archive(StateWriter&);
template void HybridSystem::archive(StateReader&);

void HybridSystem::write_extras(double t, const double* z, double* out) const {
  const Pair measured = sampled_ ? sampled_->measured : Pair{z[0], z[1]};
  std::visit(
      [&](const auto& system) {
        using Any = std::decay_t<decltype(system)>;
        if constexpr (is_rig<Any>) {
          RigExtras extras = system.extras(t, z);
          std::copy(measured.begin(), measured.end(), extras.measured);
          extras.pack(out);
        } else if constexpr (is_coupled<Any>) {
          CoupledExtras extras = system.extras(t, z);
          if constexpr (is_coupled_loop<Any>) {
            std::copy(measured.begin(), measured.end(), extras.rig.measured);
          }
          extras.pack(out);
        }
      },
      model_.system);
  if (sampled_) {
    std::copy(sampled_->own.begin(), sampled_->own.end(),
              out + model_.extras() - sampled_->own.size());
  }
}

}  // namespace bbsim::model
