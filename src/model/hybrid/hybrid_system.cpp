// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/hybrid_system.hpp"

#include "model/systems/list.hpp"

namespace bbsim::model {

HybridSystem::HybridSystem(const Model& model, double resolution)
    : model_(model), log_(model_, std::get<std::optional<Sampling>>(parts_)) {
  const Model& own = this->model();
  if (!own.stops.empty()) std::get<std::optional<Stops>>(parts_).emplace(own.stops);
  if (own.rig) {
    const Rig& rig = *own.rig;
    if (rig.sampled) std::get<std::optional<Sampling>>(parts_).emplace(model_);
    if (rig.limits_commands()) std::get<std::optional<CommandLimits>>(parts_).emplace(model_);
    if (rig.mechanism.has_pieces()) std::get<std::optional<CurvePieces>>(parts_).emplace(model_);
    std::get<std::optional<Servos>>(parts_).emplace(model_);
    only_commands_change_ = rig.sampled && !own.dry && !rig.mechanism.has_pieces() &&
                            with_given_plate(own.system, [](const auto& /*loop*/) {});
  }
  if (own.dry) {
    if (own.dry->limits_torque()) std::get<std::optional<MotorLimits>>(parts_).emplace(model_);
    std::get<std::optional<DryFriction>>(parts_).emplace(model_, resolution, log_);
  }
  if (own.events) std::get<std::optional<Monitors>>(parts_).emplace(model_, log_);

  std::size_t next = 0;
  std::apply(
      [&](const auto&... part) {
        ((first_guard_[next + 1] = first_guard_[next] + (part ? part->guards() : 0), ++next), ...);
      },
      parts_);
  for_each(parts_, [this](const auto& part) { part.append_scales(guard_scales_); });
}

bool HybridSystem::handle_time_event(double t, double* z) {
  observe(t, z);
  while (samples_at(t)) {
    if (!sampling()->take(t, instant_end(t), z)) return false;
  }
  act(t, z);
  return true;
}

void HybridSystem::observe(double t, const double* z) {
  const double end = instant_end(t);
  for_each(parts_, [&](auto& part) { part.observe(end, z); });
}

void HybridSystem::act(double t, double* z) {
  touched_ = !only_commands_change_ || t == 0;
  const double before = model().just_before(t);
  for_each(parts_, [&](auto& part) { part.leave_mode(before, z); });
  const double end = instant_end(t);
  while (sampling() != nullptr && sampling()->commands_by(end)) {
    const auto jumps = servos()->follow(sampling()->take_command(model_.mode()));
    for (std::size_t i = 0; i < jumps.size(); ++i) {
      if (!jumps[i]) continue;
      touched_ = true;
      for_each(parts_, [i](auto& part) { part.jump_command(i); });
    }
  }
  if (touched_) reset(t, z);
}

void HybridSystem::reset(double t, double* z) {
  // The impulse at a stop may take the command to its limit, which may release the servo from the
  // stop. The second round usually finds no change.
  constexpr int most_rounds = 8;
  const auto any_jumps = [&](auto&... part) { return ((part && part->reset(t, z)) || ...); };
  int round = 0;
  for (; round < most_rounds && std::apply(any_jumps, parts_); ++round) {
    for_each(parts_, [&](auto& part) { part.after_jump(t, z); });
  }
  unsettled_ = unsettled_ || round == most_rounds;
  for_each(parts_, [&](auto& part) { part.reset_at_limits(t, z); });
  if (servos() != nullptr && servos()->takes_loss()) {
    stops_ = log_.note("steps_lost", model().rig->steps_lost, t, z) == Effect::stop || stops_;
  }
}

void HybridSystem::evaluate_guards(double t, const double* z, double* values) const {
  const GuardContext now(model_, t, z);
  for_each(parts_, [&](const auto& part) {
    part.evaluate(now, values);
    values += part.guards();
  });
}

Effect HybridSystem::handle_state_event(std::size_t i, double t, double* z) {
  if (i >= first_monitor()) return part_of<Monitors>(parts_)->change(i - first_monitor(), t, z);
  for_each(parts_, [&](auto& part) { part.leave_mode(t, z); });
  std::size_t next = 0;
  for_each(parts_, [&](auto& part) {
    if (i >= next && i < next + part.guards()) part.cross(i - next);
    next += part.guards();
  });
  reset(t, z);
  return note_dry(t, z) == Effect::stop || stops_ ? Effect::stop : Effect::restart;
}

Effect HybridSystem::note_dry(double t, const double* z) {
  DryFriction* const dry = part_of<DryFriction>(parts_);
  return dry != nullptr ? dry->note_events(t, z) : Effect::none;
}

Effect HybridSystem::check_events(double t, const double* z) {
  if (note_dry(t, z) == Effect::stop || stops_) return Effect::stop;
  Monitors* const monitors = part_of<Monitors>(parts_);
  return monitors != nullptr ? monitors->check(t, z) : Effect::none;
}

void HybridSystem::write_extras(double t, const double* z, double* out) const {
  const Pair measured = sampling() != nullptr ? sampling()->measured() : Pair{z[0], z[1]};
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
      model().system);
  if (sampling() != nullptr) {
    std::copy_backward(sampling()->own().begin(), sampling()->own().end(), out + model().extras());
  }
}

}  // namespace bbsim::model
