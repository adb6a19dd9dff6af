// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string_view>
#include <utility>

#include "model/systems/list.hpp"

namespace bbsim::record {
namespace {

using model::Detail;
using scenario::Needs;

Detail detail_for(Needs needs) {
  switch (needs) {
    case Needs::ball:
    case Needs::gamma:
    case Needs::orientation:
    case Needs::own:
      return Detail::ball;
    case Needs::gimbal:
    case Needs::servos:
    case Needs::third_servo:
    case Needs::believed:
    case Needs::legs_believed:
      return Detail::gimbal;
    case Needs::accelerations:
    case Needs::dynamics:
    case Needs::plate:
    case Needs::torques:
    case Needs::armature:
    case Needs::coupled:
    case Needs::work:
    case Needs::pushed:
      return Detail::motion;
    case Needs::commands:
    case Needs::samples:
      return Detail::loop;
    case Needs::controller:
      break;
  }
  return Detail::path;
}

}  // namespace

void Rows::Sources::add(Needs needs) {
  detail = std::max(detail, detail_for(needs));
  controller = controller || needs == Needs::controller;
  dynamics = dynamics || needs >= Needs::dynamics;
  own = own || needs == Needs::own;
}

Detail Rows::Sources::all_details() const {
  return detail > Detail::path && controller ? Detail::all : detail;
}

bool Rows::Sources::ball_only() const {
  return detail <= Detail::path && !dynamics && !own;
}

Rows::Rows(std::vector<const scenario::Column*> columns)
    : columns_(std::move(columns)), all_(columns_.size()) {
  std::iota(all_.begin(), all_.end(), std::size_t{0});
  for (const scenario::Column* column : columns_) of_all_.add(column->needs);
}

void Rows::begin(const model::Model& model, const model::BallConstants& constants) {
  model_ = &model;
  row_size_ = model.row_size();
  constants_ = &constants;
  fills_.clear();
  for (const scenario::Column* column : columns_) {
    fills_.push_back(fill_of(*column, model.own_columns()));
  }
  if (any_needs(columns_, Needs::orientation)) turn_.emplace(model.radius);
}

void Rows::evaluate(const double* times, const double* rows, std::size_t count) {
  evaluate_some(times, rows, count, of_all_, all_);
}

void Rows::evaluate_some(const double* times, const double* rows, std::size_t count,
                         const Sources& from, std::span<const std::size_t> which) {
  resize(count);
  for (std::size_t first = 0; first < count; first += strip) {
    take_samples(times + first, rows + first * row_size_, std::min(strip, count - first),
                 from.all_details());
    fill(first, from.dynamics, which);
  }
}

void Rows::take_samples(const double* times, const double* rows, std::size_t count, Detail detail) {
  samples_.resize(count);
  if (shared_reference_ == nullptr || detail > Detail::path) {
    model_->samples(times, rows, count, detail, samples_.data());
    return;
  }
  model::with_given_plate(model_->system, [&](const auto& loop) {
    for (std::size_t i = 0; i < count; ++i) {
      const double t = times[i];
      const auto& [x, y] =
          shared_reference_->entry(t).at(t, [&] { return loop.reference().at(t); });
      samples_[i].t = t;
      samples_[i].ball = loop.ball(rows + i * row_size_);
      samples_[i].reference = {x.value, y.value};
    }
  });
}

void Rows::evaluate(const solve::Piece& piece, const double* times, std::size_t count) {
  evaluate(piece, times, count, all_);
}

void Rows::evaluate(const solve::Piece& piece, const double* times, std::size_t count,
                    std::span<const std::size_t> which) {
  Sources from;
  for (const std::size_t c : which) from.add(columns_[c]->needs);
  rows_.resize(count * row_size_);
  if (from.ball_only()) {
    piece.evaluate_ball(times, count, rows_.data());
  } else {
    piece.evaluate(times, count, rows_.data());
  }
  evaluate_some(times, rows_.data(), count, from, which);
}

void Rows::evaluate(const model::Sample& sample) {
  resize(1);
  samples_.assign(1, sample);
  fill(0, of_all_.dynamics, all_);
}

void Rows::resize(std::size_t count) {
  count_ = count;
  numbers_.resize(columns_.size() * count);
}

void Rows::fill(std::size_t first, bool with_dynamics, std::span<const std::size_t> which) {
  const std::size_t count = samples_.size();
  if (with_dynamics) {
    dynamics_.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      dynamics_[i] = model::dynamics(samples_[i], *constants_);
    }
  }
  if (turn_) {
    orientations_.resize(count);
    for (std::size_t i = 0; i < count; ++i) orientations_[i] = turn_->go_to(samples_[i]);
  }
  const RowBlock block{count, samples_.data(), constants_,
                       with_dynamics ? dynamics_.data() : nullptr,
                       turn_ ? orientations_.data() : nullptr};
  for (const std::size_t c : which) fills_[c](block, &numbers_[c * count_ + first]);
}

namespace {

using Vector = std::array<double, 3>;

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// As std::hypot, and faster where the squares neither overflow nor vanish.
double length(double x, double y) {
  const double square = x * x + y * y;
  return square > 1e-280 && square < 1e280 ? std::sqrt(square) : std::hypot(x, y);
}

Pair slip_of(const model::Sample& row) {
  return row.coupled ? Pair{row.coupled->slip[0], row.coupled->slip[1]} : Pair{0, 0};
}

struct Row {
  const model::Sample& sample;
  const model::BallConstants& constants;
  const model::Dynamics* dynamics;
  const Quaternion* orientation;
};
using R = const Row&;

struct Entry {
  template <class Value>
  constexpr Entry(std::string_view name, Value) : column(name), fill(&fill_with<Value>) {}

  template <class Value>
  static void fill_with(const RowBlock& rows, double* column) {
    for (std::size_t i = 0; i < rows.count; ++i) {
      column[i] = Value{}({rows.samples[i], *rows.constants,
                           rows.dynamics == nullptr ? nullptr : rows.dynamics + i,
                           rows.orientations == nullptr ? nullptr : rows.orientations + i});
    }
  }

  std::string_view column;
  FillColumn fill;
};

// In the order of scenario::catalogue.
constexpr std::array values = {
    Entry{"t", [](R row) { return row.sample.t; }},
    Entry{"x", [](R row) { return row.sample.ball.x; }},
    Entry{"y", [](R row) { return row.sample.ball.y; }},
    Entry{"distance", [](R row) { return length(row.sample.ball.x, row.sample.ball.y); }},
    Entry{"vx", [](R row) { return row.sample.ball.x_dot; }},
    Entry{"vy", [](R row) { return row.sample.ball.y_dot; }},
    Entry{"spin", [](R row) { return row.sample.ball.gamma_dot; }},
    Entry{"gamma", [](R row) { return row.sample.gamma; }},
    Entry{"ball_qw", [](R row) { return (*row.orientation)[0]; }},
    Entry{"ball_qx", [](R row) { return (*row.orientation)[1]; }},
    Entry{"ball_qy", [](R row) { return (*row.orientation)[2]; }},
    Entry{"ball_qz", [](R row) { return (*row.orientation)[3]; }},
    Entry{"phi", [](R row) { return row.sample.gimbal.phi; }},
    Entry{"theta", [](R row) { return row.sample.gimbal.theta; }},
    Entry{"phi_rate", [](R row) { return row.sample.gimbal.phi_dot; }},
    Entry{"theta_rate", [](R row) { return row.sample.gimbal.theta_dot; }},
    Entry{"phi_acceleration", [](R row) { return row.sample.gimbal.phi_ddot; }},
    Entry{"theta_acceleration", [](R row) { return row.sample.gimbal.theta_ddot; }},
    Entry{"servo_phi", [](R row) { return row.sample.servo[0]; }},
    Entry{"servo_theta", [](R row) { return row.sample.servo[1]; }},
    Entry{"servo_third", [](R row) { return row.sample.servo[2]; }},
    Entry{"phi_believed", [](R row) { return row.sample.counted[0]; }},
    Entry{"theta_believed", [](R row) { return row.sample.counted[1]; }},
    Entry{"servo_1_believed", [](R row) { return row.sample.counted[0]; }},
    Entry{"servo_2_believed", [](R row) { return row.sample.counted[1]; }},
    Entry{"servo_3_believed", [](R row) { return row.sample.counted[2]; }},
    Entry{"push_x", [](R row) { return row.sample.push[0]; }},
    Entry{"push_y", [](R row) { return row.sample.push[1]; }},
    Entry{"x_reference", [](R row) { return row.sample.reference[0]; }},
    Entry{"y_reference", [](R row) { return row.sample.reference[1]; }},
    Entry{"tracking_error",
          [](R row) {
            const model::Sample& now = row.sample;
            return length(now.ball.x - now.reference[0], now.ball.y - now.reference[1]);
          }},
    Entry{"phi_command", [](R row) { return row.sample.command[0]; }},
    Entry{"theta_command", [](R row) { return row.sample.command[1]; }},
    Entry{"x_measured", [](R row) { return row.sample.measured[0]; }},
    Entry{"y_measured", [](R row) { return row.sample.measured[1]; }},
    Entry{"tilt", [](R row) { return model::tilt(row.sample, row.constants); }},
    Entry{"tilt_rate", [](R row) { return model::tilt_rate(row.sample, row.constants); }},
    Entry{"singularity_distance",
          [](R row) { return model::singularity_distance(row.sample, row.constants); }},
    Entry{"normal_force", [](R row) { return row.dynamics->normal_force(); }},
    Entry{"friction_force", [](R row) { return row.dynamics->friction_force(); }},
    Entry{"friction_demand", [](R row) { return row.dynamics->friction_demand(); }},
    Entry{"torque_phi", [](R row) { return row.dynamics->torque_phi; }},
    Entry{"torque_theta", [](R row) { return row.dynamics->torque_theta; }},
    Entry{"motor_torque_phi",
          [](R row) { return row.dynamics->torque_phi + row.dynamics->plate_torque_phi; }},
    Entry{"motor_torque_theta",
          [](R row) { return row.dynamics->torque_theta + row.dynamics->plate_torque_theta; }},
    Entry{"motor_power",
          [](R row) {
            const model::GimbalState& gimbal = row.sample.gimbal;
            const model::Dynamics& d = *row.dynamics;
            return (d.torque_phi + d.plate_torque_phi) * gimbal.phi_dot +
                   (d.torque_theta + d.plate_torque_theta) * gimbal.theta_dot;
          }},
    Entry{"energy", [](R row) { return row.dynamics->energy(); }},
    Entry{"power",
          [](R row) {
            const model::GimbalState& gimbal = row.sample.gimbal;
            return row.dynamics->torque_phi * gimbal.phi_dot +
                   row.dynamics->torque_theta * gimbal.theta_dot;
          }},
    Entry{"push_power", [](R row) { return row.dynamics->push_power; }},
    Entry{"total_energy", [](R row) { return row.dynamics->energy() + row.dynamics->gimbal_energy; }},
    Entry{"slip_x", [](R row) { return row.dynamics->coupled.slip[0]; }},
    Entry{"slip_y", [](R row) { return row.dynamics->coupled.slip[1]; }},
    Entry{"loss_power", [](R row) { return row.dynamics->coupled.lost_power; }},
    Entry{"energy_lost", [](R row) { return row.dynamics->coupled.lost; }},
    Entry{"motor_work", [](R row) { return row.dynamics->coupled.work; }},
    Entry{"phi_torque_asked", [](R row) { return row.dynamics->coupled.asked[0]; }},
    Entry{"theta_torque_asked", [](R row) { return row.dynamics->coupled.asked[1]; }},
    Entry{"phi_torque", [](R row) { return row.dynamics->coupled.given[0]; }},
    Entry{"theta_torque", [](R row) { return row.dynamics->coupled.given[1]; }},
    Entry{"phi_current", [](R row) { return row.dynamics->current[0]; }},
    Entry{"theta_current", [](R row) { return row.dynamics->current[1]; }},
    Entry{"phi_voltage", [](R row) { return row.dynamics->voltage[0]; }},
    Entry{"theta_voltage", [](R row) { return row.dynamics->voltage[1]; }},
    Entry{"electrical_power",
          [](R row) {
            const model::Dynamics& d = *row.dynamics;
            return d.voltage[0] * d.current[0] + d.voltage[1] * d.current[1];
          }},
};

constexpr bool in_order() {
  if (values.size() != scenario::catalogue.size()) return false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i].column != scenario::catalogue[i].name) return false;
  }
  return true;
}
static_assert(in_order(), "each column has its value, in the catalogue's order");

// Column that the user's controller returns at index `place`.
template <std::size_t place>
void fill_own(const RowBlock& rows, double* column) {
  for (std::size_t i = 0; i < rows.count; ++i) {
    const double* const own = rows.samples[i].own;
    column[i] = own != nullptr ? own[place] : std::nan("");
  }
}

void fill_nothing(const RowBlock& rows, double* column) {
  std::fill_n(column, rows.count, std::nan(""));
}

template <std::size_t... place>
constexpr auto own_fills(std::index_sequence<place...>) {
  return std::array<FillColumn, sizeof...(place)>{&fill_own<place>...};
}

}  // namespace

const Quaternion& BallTurn::go_to(const model::Sample& row) {
  const model::BallMotion& from = last_.ball;
  const model::BallMotion& to = row.ball;
  if (std::exchange(begun_, true)) {
    const double step = row.t - last_.t;
    const Pair before = slip_of(last_), now = slip_of(row);
    const Pair slipped{step * (before[0] + now[0]) / 2, step * (before[1] + now[1]) / 2};
    const Vector turn{(slipped[1] - (to.y - from.y)) / radius_,
                      (to.x - from.x - slipped[0]) / radius_, row.gamma - last_.gamma};
    const Vector change{(now[1] - before[1] - (to.y_dot - from.y_dot)) / radius_,
                        (to.x_dot - from.x_dot - (now[0] - before[0])) / radius_,
                        to.gamma_dot - from.gamma_dot};
    const Vector bent = cross(turn, change);
    const double weight = step / 12;
    Vector whole{};
    for (std::size_t i = 0; i < 3; ++i) whole[i] = turn[i] - weight * bent[i];
    now_ = normalised(product(rotation_by(whole), now_));
  }
  last_ = row;
  return now_;
}

FillColumn fill_of(const scenario::Column& column, const std::vector<std::string>& own_columns) {
  if (column.needs == scenario::Needs::own) {
    constexpr auto of = own_fills(std::make_index_sequence<scenario::most_own_columns>{});
    const auto found = std::ranges::find(own_columns, column.name);
    if (found == own_columns.end()) return &fill_nothing;
    return of[static_cast<std::size_t>(found - own_columns.begin())];
  }
  return values[static_cast<std::size_t>(&column - scenario::catalogue.data())].fill;
}

}  // namespace bbsim::record
