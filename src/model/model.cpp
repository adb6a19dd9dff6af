// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/model.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <new>

#include "base/instant.hpp"
#include "base/real.hpp"

namespace bbsim::model {

bool Model::jumps_at(double t) const {
  if (jumps.empty() || !std::isfinite(t)) return false;
  const double rounding = rounding_of(t);
  const auto jump = std::lower_bound(jumps.begin(), jumps.end(), t - rounding);
  return jump != jumps.end() && *jump <= t + rounding;
}

double Model::just_before(double t) const {
  if (!jumps_at(t)) {
    // The double before a positive one has the number before in its bits. std::nextafter is slow.
    return t > 0 ? std::bit_cast<double>(std::bit_cast<std::int64_t>(t) - 1)
                 : std::nextafter(t, -std::numeric_limits<double>::infinity());
  }
  // A jump starts one rounding error before its time, which may lie one before t. The third is for
  // sums of times.
  return t - 3 * rounding_of(t);
}

std::size_t Model::extras() const {
  if (!hybrid()) return 0;
  const bool coupled =
      std::visit([](const auto& any) { return is_coupled<std::decay_t<decltype(any)>>; }, system);
  if (coupled) return CoupledExtras::size + own_columns().size();
  return rig ? RigExtras::size + own_columns().size() : 0;
}

Sample Model::sample(double t, const double* row, Detail detail) const {
  Sample sample;
  samples(&t, row, 1, detail, &sample);
  return sample;
}

void Model::samples(const double* times, const double* rows, std::size_t count, Detail detail,
                    Sample* into) const {
  const bool extra = hybrid();
  const std::size_t row_size = this->row_size(), beside = size() + (gamma ? 1 : 0);
  const std::size_t own = own_columns().size();
  const double no_gamma = gamma_not_integrated();
  std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        for (std::size_t i = 0; i < count; ++i) {
          const double t = times[i], *const row = rows + i * row_size;
          // Without a copy, which would take as long as the rest.
          Sample* const sample = new (into + i) Sample([&] {
            if constexpr (is_rig<Any>) {
              return extra ? any.sample(t, row, RigExtras::unpack(row + beside), detail)
                           : any.sample(t, row, detail);
            } else if constexpr (is_coupled<Any>) {
              return extra ? any.sample(t, row, CoupledExtras::unpack(row + beside))
                           : any.sample(t, row);
            } else {
              return any.sample(t, row, detail);
            }
          }());
          sample->gamma = gamma ? row[size()] / radius : no_gamma;
          if (own > 0) sample->own = row + row_size - own;
        }
      },
      system);
}

const std::vector<std::string>& Model::own_columns() const {
  static const std::vector<std::string> none;
  return rig && rig->sampled ? rig->sampled->own_columns : none;
}

int Model::spin_state() const {
  return std::visit([](const auto& any) { return spin_index<std::decay_t<decltype(any)>>; },
                    system);
}

double Model::gamma_not_integrated() const {
  return spin_state() >= 0 ? no_number : 0;
}

std::vector<std::string> Model::state_names() const {
  return std::visit(
      [this](const auto& any) -> std::vector<std::string> {
        using Any = std::decay_t<decltype(any)>;
        std::vector<std::string> names(Any::Layout::names.begin(), Any::Layout::names.end());
        const auto add = [&](std::initializer_list<const char*> more) {
          names.insert(names.end(), more.begin(), more.end());
        };
        constexpr bool coupled = is_coupled<Any>, loop = is_coupled_loop<Any>;
        if constexpr (loop || (!coupled && Any::size > Any::Layout::size)) {
          // Servo angles, or the plane's.
          const char* const whose = loop && rig && !rig->mechanism.none() ? "servo_" : "";
          for (const char* suffix : {"", "_rate"}) {
            const auto angle = [&](const char* axis) {
              names.push_back(std::string(whose) + axis + suffix);
            };
            if (phi_moves(Any::moves)) angle("phi");
            if (theta_moves(Any::moves)) angle("theta");
            if constexpr (requires { requires Any::servos == 3; }) angle("third");
          }
        }
        if (loop || Any::size == RigLoop<true>::size) {
          add({"phi_command_integral", "theta_command_integral"});
        }
        if (loop) add({"phi_integral", "theta_integral"});
        if (coupled) add({"slip_x", "slip_y", "energy_lost", "motor_work"});
        return names;
      },
      system);
}

bool Model::closed_loop() const {
  return std::visit(
      [](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (is_coupled_loop<Any>) {
          return any.by != GimbalBy::given_torques;
        } else {
          return !Any::open_loop && !is_coupled<Any>;
        }
      },
      system);
}

}  // namespace bbsim::model
