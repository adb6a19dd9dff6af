// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/hybrid/switched_model.hpp"

#include "simd/gradient.hpp"

namespace bbsim::model {

SwitchedModel::SwitchedModel(const Model& model) : model_(model) {
  std::visit(
      [this](auto& any) {
        if (auto* const loop = rig_loop_of(any)) mode_ = &loop->mode;
      },
      model_.system);
  if (model_.rig) rate_ = angle + static_cast<std::size_t>(model_.rig->servos);
}

Demands SwitchedModel::demands(double t, const double* z) const {
  return with_loop([&](const auto& loop) {
    const auto all = loop.axes(loop.inputs(t), z);
    Demands demands{{all.command.raw[0], all.command.raw[1]},
                    {all.command.value[0], all.command.value[1]},
                    {},
                    {}};
    for (int i = 0; i < std::decay_t<decltype(loop)>::servos; ++i) {
      demands.servo_command[i] = loop.servo_command(all, i);
      demands.demand[i] = all.demand[i];
    }
    return demands;
  });
}

Balance<double> SwitchedModel::balance(double t, const double* z) const {
  return std::visit(
      [&](const auto& any) -> Balance<double> {
        if constexpr (is_coupled<std::decay_t<decltype(any)>>) {
          return any.balance(any.inputs(t), z);
        } else {
          throw std::logic_error("the forces of a scene that is not coupled");
        }
      },
      model_.system);
}

CommandRates SwitchedModel::command_rates(double t, const double* z) const {
  rates_.resize(model_.size());
  std::visit([&](const auto& any) { derivative(any, t, z, rates_.data()); }, model_.system);
  return with_loop([&](const auto& loop) {
    using Loop = std::decay_t<decltype(loop)>;
    using Moving = simd::WithGradient<1>;
    const auto moving = [](double value, double rate) {
      return Moving(value, Moving::Gradient(rate));
    };
    Moving states[Loop::size];
    for (int k = 0; k < Loop::size; ++k)
      states[k] = moving(z[k], rates_[static_cast<std::size_t>(k)]);
    const auto axes = loop.axes(loop.inputs(moving(t, 1)), states);
    CommandRates rates;
    for (int i = 0; i < 2; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      rates.raw[axis] = axes.command.raw[i].gradient[0];
      rates.shown[axis] = loop.shown(axes, i).gradient[0];
      if (loop.law().integrates(axis) && Loop::size > Loop::Layout::integral) {
        rates.raw[axis] -= rates_[static_cast<std::size_t>(Loop::Layout::integral) + axis];
      }
    }
    return rates;
  });
}

}  // namespace bbsim::model
