// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/sampled.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

#include "base/instant.hpp"
#include "model/hybrid/rig_energy.hpp"
#include "simd/instruction_set.hpp"
#include "solve/collocation/radau_table.hpp"
#include "solve/collocation/step_length.hpp"
#include "solve/sampled/monitor_ranges.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr std::size_t angle = model::RigLayout::angle;

}  // namespace

const Kernels& choose_kernels() {
  return simd::kernels_by<simd::Widest::avx2>(
      [](auto isa) -> const auto& { return kernels<decltype(isa)>(); });
}

bool can_step(const model::Model& model) {
  // A measured curve switches from piece to piece, which no closed form predicts.
  if (!model.rig || !model.rig->sampled || model.dry || model.rig->mechanism.has_pieces()) {
    return false;
  }
  return with_given_plate(model.system, [](const auto& /*loop*/) {});
}

bool counts_work(const model::Model& model) {
  return model.work && !std::holds_alternative<model::RigLoop<false>>(model.system);
}

HeldStepper::HeldStepper(const model::Model& model, const Kernels& kernels, Tolerances tolerances)
    : model_(&model),
      kernels_(kernels),
      tables_(kernels),
      instants_(*model.rig->sampled),
      plate_(model),
      servos_(plate_.servos()),
      rate_(angle + servos_),
      counts_work_(counts_work(model)),
      reached_(model.size()) {
  with_given_plate(model.system, [this](const auto& loop) {
    using Link = std::decay_t<decltype(loop.link)>;
    if constexpr (std::is_same_v<Link, model::Linkages>) {
      kernel_ = kernels_.linked;
    } else if constexpr (std::is_same_v<Link, model::ThreeServos>) {
      kernel_ = kernels_.three;
    } else {
      kernel_ = loop.rolling() == model::GeneralRolling{} ? kernels_.papers : kernels_.general;
    }
    scene_.radius = loop.radius();
    scene_.gravity = loop.gravity();
    scene_.rolling = loop.rolling();
    tempo_ = loop.reference().highest_frequency();
  });
  scene_.rtol = tolerances.rtol;
  scene_.atol = tolerances.atol;
  scene_.gamma = model.gamma;
  if (model.events) {
    for (const model::Monitor& monitor : model.events->monitors) {
      using Kind = model::Monitor::Kind;
      if (monitor.kind == Kind::slip) scene_.friction = monitor.limit;
      if (monitor.kind == Kind::slip || monitor.kind == Kind::lift_off) scene_.force = true;
    }
  }
  piece_.contraction = 1e-2;
}

void HeldStepper::start(double t, const double* z) {
  if (attempted_) {
    if (model_->gamma && t != time_) {
      double row[model::CoupledLayout<model::most_servos>::states + 1];
      evaluate(&t, 1, row, false);
      turned_ = row[reached_.size()];
    }
    for (int i = 0; i < 3; ++i) piece_.guess[i] = piece_.acceleration_at[i][nodes - 1];
  }
  attempted_ = false;
  evaluated_ = false;
  time_ = t;
  std::copy_n(z, reached_.size(), reached_.begin());
  if (counts_work_) work_beyond_energy_ = reached_.back() - model::rig_energy(model_->system, z);
  plate_.set_motions(t, z, servo_);
  settle();
}

// Makes the end of the last step the present state.
void HeldStepper::settle() {
  if (attempted_) {
    for (int i = 0; i < 3; ++i) piece_.guess[i] = piece_.acceleration_at[i][nodes - 1];
    for (std::size_t i = 0; i < servos_; ++i) {
      const model::HeldMotion& was = servo_[i];
      const PieceAxis& axis = piece_.plate.axis[i];
      constexpr auto row = MotionTable::acceleration;
      const double acceleration = axis.table->by_rate[row][nodes - 1] * axis.rate +
                                  axis.table->by_acceleration[row][nodes - 1] * axis.acceleration;
      const double drift = was.drift_rate + was.drift_acceleration * piece_.length;
      servo_[i] = {was.law,
                   reached_[angle + i],
                   reached_[rate_ + i] - drift,
                   acceleration - was.drift_acceleration,
                   drift,
                   was.drift_acceleration};
    }
  }
  attempted_ = false;
  piece_.position[0] = reached_[0];
  piece_.position[1] = reached_[1];
  piece_.position[2] = turned_;
  for (std::size_t i = 0; i < 3; ++i) piece_.velocity[i] = reached_[2 + i];
}

std::optional<Failure> HeldStepper::step(double limit) {
  settle();
  began_ = time_;
  evaluated_ = false;
  const double left = limit - time_;
  // Two guards may cross zero at one instant, apart only by the rounding of the time. Nothing moves
  // then.
  if (!(left > 0)) return {};
  for (;;) {
    const auto [step, arrives] = stride(left, steps_.next);
    if (!arrives && is_lost(step, time_)) return step_is_lost;
    piece_.length = instants_.nominal(time_, step);
    plate_.prepare(servo_, piece_.length, tables_, piece_.plate);
    Attempt attempt;
    kernel_.attempt(piece_, scene_, attempt);
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.iterations);
    statistics_.rhs_evaluations += nodes * static_cast<std::size_t>(attempt.iterations + 1);
    if (attempt.converged) worst_state_ = static_cast<std::size_t>(attempt.worst_state);
    if (!attempt.converged || !(attempt.error <= 1)) {
      steps_.reject(step,
                    attempt.converged ? step_growth(attempt.error, nodes) : StepControl::unsolved);
      ++statistics_.error_test_failures;
      continue;
    }
    time_ = arrives ? limit : time_ + step;
    last_error_ = attempt.error;
    loses_motion_ = false;
    for (std::size_t i = 0; i < servos_; ++i) {
      loses_motion_ = loses_motion_ || piece_.plate.axis[i].table->lost;
    }
    ++statistics_.steps;
    const bool needs = steps_.needs_growth(step, arrives);
    steps_.accept(step, arrives, needs ? step_growth(attempt.error, nodes) : 1);
    finish();
    return {};
  }
}

// Takes the states at the end of the step.
void HeldStepper::finish() {
  attempted_ = true;
  reached_[0] = piece_.position_end[0];
  reached_[1] = piece_.position_end[1];
  turned_ = piece_.position_end[2];
  for (std::size_t i = 0; i < 3; ++i) reached_[2 + i] = piece_.velocity_end[i];
  plate_.write_end(piece_.plate, reached_.data());
  plate_.pass(piece_.plate);
}

void HeldStepper::evaluate(const double* times, std::size_t count, double* rows, bool servos) {
  constexpr std::size_t together = 16;
  const std::size_t row = reached_.size() + (model_->gamma ? 1 : 0);
  for (std::size_t first = 0; first < count; first += together) {
    evaluate_some(times + first, std::min(together, count - first), rows + first * row, servos);
  }
}

void HeldStepper::Shares::evaluate(const Piece& piece, double (&ball)[6]) const {
  for (int i = 0; i < 3; ++i) {
    double velocity = 0, position = 0;
    for (int m = 0; m < nodes; ++m) {
      velocity += of_velocity[m] * piece.series[i][m];
      position += of_position[m] * piece.series[i][m];
    }
    ball[2 + i] = piece.velocity[i] + velocity;
    ball[i < 2 ? i : 5] = piece.position[i] + (after * piece.velocity[i] + position);
  }
}

// The shares at an instant of the last step that recurs in similar steps; null at other instants.
const HeldStepper::Shares* HeldStepper::shares(double after) {
  const std::optional<double> meant = instants_.recurring(time_, after, piece_.length);
  if (!meant) return nullptr;
  for (const Shares& entry : shares_) {
    if (entry.after == *meant && entry.length == piece_.length) return &entry;
  }
  Shares& entry = shares_[next_shares_];
  next_shares_ = (next_shares_ + 1) % shares_.size();
  entry.after = *meant;
  entry.length = piece_.length;
  for (int first = 0; first < nodes; first += 3) {
    const int count = std::min(3, nodes - first);
    Piece unit{};  // each series is a single polynomial
    unit.length = piece_.length;
    for (int i = 0; i < count; ++i) unit.series[i][first + i] = 1;
    double ball[1][6];
    kernels_.evaluate(unit, &entry.after, 1, ball);
    for (int i = 0; i < count; ++i) {
      entry.of_velocity[first + i] = ball[0][2 + i];
      entry.of_position[first + i] = ball[0][i < 2 ? i : 5];
    }
  }
  return &entry;
}

void HeldStepper::evaluate_some(const double* times, std::size_t count, double* rows, bool servos) {
  double after[16], ball[16][6];
  const Shares* known[16] = {};
  bool others = false;
  const double rounding = 2 * rounding_of(time_);
  const auto is_end = [&](std::size_t i) { return std::abs(times[i] - time_) <= rounding; };
  for (std::size_t i = 0; i < count; ++i) {
    after[i] = times[i] - began_;
    if (is_end(i)) continue;
    known[i] = shares(after[i]);
    others = others || known[i] == nullptr;
  }
  if (others) kernels_.evaluate(piece_, after, count, ball);
  const std::size_t size = reached_.size();
  for (std::size_t i = 0; i < count; ++i) {
    double* const row = rows + i * (size + (model_->gamma ? 1 : 0));
    // A row at the end is exactly the state there. States beside the ball's and the servos' stay.
    std::copy(reached_.begin(), reached_.end(), row);
    if (is_end(i)) {
      if (model_->gamma) row[size] = turned_;
      put_work(row);
      continue;
    }
    if (known[i] != nullptr) known[i]->evaluate(piece_, ball[i]);
    std::copy_n(ball[i], 5, row);
    if (model_->gamma) row[size] = ball[i][5];
    if (!servos) continue;
    const model::HeldLaw& first = servo_[0].law;  // usually that of all servos
    const model::ImpulseAnswer of_first = instants_.answer(first, time_, after[i]);
    for (std::size_t k = 0; k < servos_; ++k) {
      const model::HeldMotion& servo = servo_[k];
      const model::HeldMotion::ServoState at = servo.after(
          servo.law == first ? of_first : instants_.answer(servo.law, time_, after[i]), after[i]);
      row[angle + k] = at.angle;
      row[rate_ + k] = at.rate;
    }
    put_work(row);
  }
}

// Sets the servos' work in states of the last step. Nothing else changes the energy until the next
// switch.
void HeldStepper::put_work(double* z) const {
  if (!counts_work_) return;
  z[reached_.size() - 1] = work_beyond_energy_ + model::rig_energy(model_->system, z);
}

std::vector<double> HeldStepper::state() const {
  std::vector<double> state = reached_;
  put_work(state.data());
  return state;
}

// As for radau, if 8 nodes just resolve the motion. Usually half as many would do.
std::size_t HeldStepper::parts() const {
  constexpr double least = 8, of_products = 2, a_radian = 3, most = 128;
  const double parts = std::max(last_error_ < 1e-3 ? least : of_products * nodes,
                                least + a_radian * std::abs(tempo_ * (time_ - began_)));
  return static_cast<std::size_t>(std::clamp(std::ceil(parts), least, most));
}

const Range& HeldStepper::range(Quantity of) {
  if (!evaluated_ && scene_.sizes) take_reference();
  if (!evaluated_) kernel_.evaluate_quantities(piece_, scene_, ranges_.data(), at_points_);
  evaluated_ = true;
  return ranges_[static_cast<std::size_t>(of)];
}

bool HeldStepper::no_monitor_changes(const std::vector<char>& occurring) {
  if (!attempted_) return false;
  for (std::size_t m = 0; m < occurring.size(); ++m) {
    const auto range_of = [this](Quantity quantity) { return range(quantity); };
    if (model_->events->monitors[m].kind == model::Monitor::Kind::dead_point) {
      if (occurring[m] != 0 || !plate_.stays_off_dead_points(piece_.plate, servo_, piece_.length)) {
        return false;
      }
      continue;
    }
    if (!stays_in_range(model_->events->monitors[m], model_->events->plate, occurring[m] != 0,
                        range_of)) {
      return false;
    }
  }
  return true;
}

// The reference at the start and at all nodes but the first. Where it jumps at the end of the step,
// it counts as before the jump.
void HeldStepper::take_reference() {
  const double last = model_->jumps_at(time_) ? model_->just_before(time_) : time_;
  with_given_plate(model_->system, [&](const auto& loop) {
    for (int n = 0; n < nodes; ++n) {
      const double t =
          n == 0 ? began_
                 : std::min(began_ + radau::radau_table<radau::Shared, nodes>.c[n] * piece_.length,
                            last);
      const auto at = loop.reference().at(t);
      for (int i = 0; i < 2; ++i) piece_.reference_at[i][n] = at[i].value;
    }
  });
}

std::optional<Bounds> HeldStepper::bounds(Bounded column, const model::BallConstants& constants,
                                          bool closely) {
  if (!attempted_) return {};
  const bool is_load = column >= Bounded::motor_torque_phi;
  if (is_load && loads_of_ != &constants) {
    loads_of_ = &constants;
    scene_.loads = true;
    scene_.mass = constants.mass;
    scene_.body = constants.body;
    evaluated_ = false;
  } else if (!is_load && !scene_.sizes) {
    scene_.sizes = true;
    evaluated_ = false;
  }
  // A value between the nodes exceeds the bounds by no more than the tolerance, unless a servo
  // moves there unseen.
  if (!is_load && loses_motion_) return {};
  std::optional<Bounds> bounds = column_bounds(column, [&](Quantity of) {
    const Range at_nodes = range(of);
    return closely ? widened_closely(kernels_.narrow(at_points_.at[of])) : widened(at_nodes);
  });
  if (bounds && loses_motion_) bounds->trend = 0;
  return bounds;
}

}  // namespace bbsim::solve::sampled
