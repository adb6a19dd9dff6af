// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/sampled.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <variant>

#include "base/instant.hpp"
#include "simd/instruction_set.hpp"
#include "solve/collocation/step_length.hpp"
#include "solve/sampled/monitor_ranges.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr std::size_t angle = model::RigLayout::angle;

// Whether nothing but the plate's motion acts on a rolling ball: no viscous couple, no push.
template <class Link>
bool only_rolls(const model::CoupledLoop<model::SignalPair, Link>& coupled) {
  return coupled.by == model::GimbalBy::servos && coupled.parts.ball.law.viscous == 0 &&
         coupled.push.on.is_zero(0) && coupled.push.on.is_zero(1);
}

// Calls `use` with the rig's loop if the servos' motion determines the plate's, which determines
// the ball's. Returns false if it does not.
template <class Use>
bool with_given_plate(const model::System& system, Use use) {
  return std::visit(
      [&](const auto& any) {
        using Any = std::decay_t<decltype(any)>;
        if constexpr (std::is_same_v<Any, model::RigLoop<false>>) {
          use(any);
          return true;
        } else if constexpr (model::is_coupled_loop<Any>) {
          if constexpr (Any::pushes) {
            if (!only_rolls(any)) return false;
            use(any.loop);
            return true;
          }
        }
        return false;
      },
      system);
}

}  // namespace

const Kernels& choose_kernels() {
  return simd::kernels_by<simd::Widest::avx2>(
      [](auto isa) -> const auto& { return kernels<decltype(isa)>(); });
}

bool knows(const model::Model& model) {
  // A measured curve switches from piece to piece, which no closed form predicts.
  if (!model.rig || !model.rig->sampled || model.dry || model.rig->between.has_pieces()) {
    return false;
  }
  const bool works = model.work && !std::holds_alternative<model::RigLoop<false>>(model.system);
  return !works && with_given_plate(model.system, [](const auto& /*loop*/) {});
}

HeldStepper::HeldStepper(const model::Model& model, const Kernels& kernels, Tolerances tolerances)
    : model_(&model),
      kernels_(kernels),
      tables_(kernels),
      instants_(*model.rig->sampled),
      servos_(static_cast<std::size_t>(model.rig->servos)),
      rate_(angle + servos_),
      reached_(model.size()) {
  with_given_plate(model.system, [this](const auto& loop) { take(loop); });
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

template <class Loop>
void HeldStepper::take(const Loop& loop) {
  using Link = std::decay_t<decltype(loop.link)>;
  if constexpr (std::is_same_v<Link, model::Linkages>) {
    kernel_ = kernels_.linked;
    scene_.linkages = &loop.link;
  } else if constexpr (std::is_same_v<Link, model::ThreeServos>) {
    kernel_ = kernels_.three;
    scene_.three = &loop.link;
    pose_ = loop.link.home(pose_angles_);
    piece_.gain = 0;
    for (int i = 0; i < Link::servos; ++i) {
      double level[3] = {}, rates[3] = {}, none[3] = {};
      for (int k = 0; k < Link::servos; ++k) level[k] = loop.link.leg[k].level;
      rates[i] = 1;
      model::GimbalAngle<double> plane[2];
      loop.link.planes(level, rates, none, plane);
      piece_.gain = std::max({piece_.gain, std::abs(plane[0].rate), std::abs(plane[1].rate)});
    }
  } else {
    kernel_ = loop.rolling() == model::GeneralRolling{} ? kernels_.papers : kernels_.general;
  }
  mode_ = &loop.mode;
  response_ = loop.servo();
  scene_.radius = loop.radius();
  scene_.gravity = loop.gravity();
  scene_.rolling = loop.rolling();
  tempo_ = loop.reference().highest_frequency();
}

void HeldStepper::take_modes() {
  for (std::size_t i = 0; i < servos_; ++i) {
    servo_[i] = model::held_motion(response_.of[i], mode_->axis[i], mode_->command[i],
                                   reached_[angle + i], reached_[rate_ + i]);
    piece_.axis[i].ratio = mode_->axis[i].ratio;
    piece_.axis[i].offset = mode_->axis[i].offset;
  }
}

void HeldStepper::start(double t, const double* z) {
  if (attempted_) {
    if (model_->gamma && t != time_) {
      double row[model::CoupledLayout<model::most_servos>::states + 1];
      evaluate(&t, 1, row);
      turned_ = row[reached_.size()];
    }
    for (int i = 0; i < 3; ++i) piece_.guess[i] = piece_.acceleration_at[i][nodes - 1];
  }
  attempted_ = false;
  evaluated_ = false;
  time_ = t;
  std::copy_n(z, reached_.size(), reached_.begin());
  take_modes();
  settle();
}

// Makes the end of the last step the present state.
void HeldStepper::settle() {
  if (attempted_) {
    for (int i = 0; i < 3; ++i) piece_.guess[i] = piece_.acceleration_at[i][nodes - 1];
    for (std::size_t i = 0; i < servos_; ++i) {
      const model::HeldMotion& was = servo_[i];
      const MotionTable& table = *piece_.axis[i].table;
      constexpr auto row = MotionTable::acceleration;
      servo_[i] = {was.law, reached_[angle + i], reached_[rate_ + i],
                   table.by_rate[row][nodes - 1] * was.rate +
                       table.by_acceleration[row][nodes - 1] * was.acceleration};
    }
  }
  attempted_ = false;
  piece_.position[0] = reached_[0];
  piece_.position[1] = reached_[1];
  piece_.position[2] = turned_;
  for (std::size_t i = 0; i < 3; ++i) piece_.velocity[i] = reached_[2 + i];
}

void HeldStepper::prepare(double length) {
  piece_.length = length;
  for (std::size_t i = 0; i < servos_; ++i) {
    const model::HeldMotion& servo = servo_[i];
    PieceAxis& axis = piece_.axis[i];
    // The servos usually have the same law.
    axis.table =
        i > 0 && servo.law == servo_[0].law ? piece_.axis[0].table : &tables_.of(servo.law, length);
    axis.angle = servo.angle;
    axis.rate = servo.rate;
    axis.acceleration = servo.acceleration;
  }
  if (scene_.linkages != nullptr) {
    start_plate(*scene_.linkages);
    piece_.gain = 0;
    for (int i = 0; i < 2; ++i) {
      const PieceAxis& of = piece_.axis[i];
      const auto turn = scene_.linkages->of[i].plain_turn(of.ratio * of.angle + of.offset);
      piece_.gain = std::max(piece_.gain, std::abs(turn.slope));
    }
  } else if (scene_.three != nullptr) {
    start_plate(*scene_.three);
  }
}

// Computes the plate's motion at the start of the piece.
template <class Link>
void HeldStepper::start_plate(const Link& link) {
  double horn[Link::servos], rate[Link::servos], acting[Link::servos];
  for (int i = 0; i < Link::servos; ++i) {
    const PieceAxis& of = piece_.axis[i];
    horn[i] = of.ratio * of.angle + of.offset;
    rate[i] = of.ratio * of.rate;
    acting[i] = of.ratio * of.acceleration;
  }
  if constexpr (Link::servos == 3) {
    double sine[3], cosine[3];
    link.directions(horn, sine, cosine);
    double motion = 0;
    for (int i = 0; i < 3; ++i) motion = std::max(motion, std::abs(horn[i] - pose_angles_[i]));
    const auto near = link.follow(pose_, pose_angles_, horn, Link::parts_for(motion));
    piece_.pose_start = pose_ = link.pose_near(near, sine, cosine);
    std::copy_n(horn, 3, pose_angles_);
    link.pose_slopes(pose_, sine, cosine, piece_.pose_slopes);
    const double whole =
        link.planes_in(piece_.pose_start, sine, cosine, rate, acting, piece_.plane_start);
    link.edges(piece_.pose_start, sine, cosine, whole, piece_.edges_start);
  } else {
    link.planes(horn, rate, acting, piece_.plane_start);
  }
}

std::optional<Failure> HeldStepper::step(double limit) {
  settle();
  began_ = time_;
  evaluated_ = false;
  const double left = limit - time_;
  // Two guards may cross zero at one instant, apart only by the rounding of the time. Nothing moves
  // then.
  if (!(left > 0)) return {};
  bool rejected = false;
  for (;;) {
    const auto [step, arrives] = stride(left, next_step_);
    if (!arrives && is_lost(step, time_)) return step_is_lost;
    prepare(instants_.nominal(time_, step));
    Attempt attempt;
    kernel_.attempt(piece_, scene_, attempt);
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.iterations);
    statistics_.rhs_evaluations += nodes * static_cast<std::size_t>(attempt.iterations + 1);
    if (attempt.converged) worst_state_ = static_cast<std::size_t>(attempt.worst_state);
    if (!attempt.converged || !(attempt.error <= 1)) {
      next_step_ =
          step * (attempt.converged ? std::min(0.9, step_growth(attempt.error, nodes)) : 0.2);
      rejected = true;
      ++statistics_.error_test_failures;
      continue;
    }
    time_ = arrives ? limit : time_ + step;
    last_error_ = attempt.error;
    ++statistics_.steps;
    constexpr double most_growth = 8;
    // A step that the limit cut short says little about the length of the next.
    if (!arrives || rejected || next_step_ < most_growth * step) {
      const double factor = step_growth(attempt.error, nodes);
      const double next = step * (rejected ? std::min(factor, 1.0) : factor);
      next_step_ = arrives && !rejected ? std::max(next, next_step_) : next;
    }
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
  for (std::size_t i = 0; i < servos_; ++i) {
    const PieceAxis& axis = piece_.axis[i];
    const auto row = [&](MotionTable::Row of) {
      return axis.table->by_rate[of][nodes - 1] * axis.rate +
             axis.table->by_acceleration[of][nodes - 1] * axis.acceleration;
    };
    reached_[angle + i] = axis.angle + row(MotionTable::angle);
    reached_[rate_ + i] = row(MotionTable::rate);
    if (scene_.three != nullptr) pose_angles_[i] = axis.ratio * reached_[angle + i] + axis.offset;
  }
  if (scene_.three != nullptr) pose_ = piece_.pose_end;
}

void HeldStepper::evaluate(const double* times, std::size_t count, double* rows) {
  constexpr std::size_t together = 16;
  const std::size_t row = reached_.size() + (model_->gamma ? 1 : 0);
  for (std::size_t first = 0; first < count; first += together) {
    evaluate_some(times + first, std::min(together, count - first), rows + first * row);
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
  for (const Shares& one : shares_) {
    if (one.after == *meant && one.length == piece_.length) return &one;
  }
  Shares& made = shares_[next_shares_];
  next_shares_ = (next_shares_ + 1) % shares_.size();
  made.after = *meant;
  made.length = piece_.length;
  for (int first = 0; first < nodes; first += 3) {
    const int count = std::min(3, nodes - first);
    Piece one{};  // each series is a single polynomial
    one.length = piece_.length;
    for (int i = 0; i < count; ++i) one.series[i][first + i] = 1;
    double ball[1][6];
    kernels_.evaluate(one, &made.after, 1, ball);
    for (int i = 0; i < count; ++i) {
      made.of_velocity[first + i] = ball[0][2 + i];
      made.of_position[first + i] = ball[0][i < 2 ? i : 5];
    }
  }
  return &made;
}

void HeldStepper::evaluate_some(const double* times, std::size_t count, double* rows) {
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
      continue;
    }
    if (known[i] != nullptr) known[i]->evaluate(piece_, ball[i]);
    std::copy_n(ball[i], 5, row);
    if (model_->gamma) row[size] = ball[i][5];
    const model::ImpulseAnswer* answer = nullptr;
    for (std::size_t k = 0; k < servos_; ++k) {
      const model::HeldMotion& servo = servo_[k];
      if (k == 0 || !(servo.law == servo_[0].law)) {
        answer = &instants_.answer(servo.law, time_, after[i]);
      }
      const model::HeldMotion::Instant at = servo.after(*answer);
      row[angle + k] = at.angle;
      row[rate_ + k] = at.rate;
    }
  }
}

std::vector<double> HeldStepper::state() const {
  return reached_;
}

// As for radau, if 8 nodes just resolve the motion. Usually half as many would do.
std::size_t HeldStepper::parts() const {
  constexpr double least = 8, of_products = 2, a_radian = 3, most = 128;
  const double parts = std::max(last_error_ < 1e-3 ? least : of_products * nodes,
                                least + a_radian * std::abs(tempo_ * (time_ - began_)));
  return static_cast<std::size_t>(std::clamp(std::ceil(parts), least, most));
}

const Range& HeldStepper::range(Quantity of) {
  if (!evaluated_) kernel_.evaluate_quantities(piece_, scene_, ranges_.data(), at_points_);
  evaluated_ = true;
  return ranges_[static_cast<std::size_t>(of)];
}

bool HeldStepper::no_monitor_changes(const std::vector<char>& occurring) {
  if (!attempted_) return false;
  for (std::size_t m = 0; m < occurring.size(); ++m) {
    const auto range_of = [this](Quantity quantity) { return range(quantity); };
    if (model_->events->monitors[m].kind == model::Monitor::Kind::dead_point) {
      if (occurring[m] != 0 || !stays_off_dead_points()) return false;
      continue;
    }
    if (!stays_in_range(model_->events->monitors[m], model_->events->plate, occurring[m] != 0,
                        range_of)) {
      return false;
    }
  }
  return true;
}

// Whether the mechanism is certain to stay within its range over the last step.
bool HeldStepper::stays_off_dead_points() const {
  if (scene_.three != nullptr) {
    for (int k = 0; k < model::ThreeServos::edge_count; ++k) {
      double edge[nodes];  // the start replaces the first node, as for all ranges
      std::copy_n(piece_.edges[k], nodes, edge);
      edge[0] = piece_.edges_start[k];
      const auto [least, most] = std::minmax_element(edge, edge + nodes);
      if (!(widened({*least, *most}).least > 0)) return false;
    }
    return true;
  }
  for (std::size_t i = 0; i < servos_; ++i) {
    const PieceAxis& axis = piece_.axis[i];
    const model::MotionReach to = model::reach(servo_[i], piece_.length);
    const double center = axis.ratio * to.centre + axis.offset;
    const double most = std::abs(axis.ratio) * to.angle_most;
    const model::LinkCurve& curve = scene_.linkages->of[i];
    if (!(center - most > curve.low && center + most < curve.high)) return false;
  }
  return true;
}

std::optional<Bounds> HeldStepper::bounds(Load load, const model::BallConstants& constants,
                                          bool closely) {
  if (!attempted_) return {};
  if (loads_of_ != &constants) {
    loads_of_ = &constants;
    scene_.loads = true;
    scene_.mass = constants.mass;
    scene_.turned = model::turned_by_motors(constants);
    evaluated_ = false;
  }
  const auto place = static_cast<std::size_t>(load);
  const Range wide = widened(range(static_cast<Quantity>(Quantity::torque_phi + place)));
  if (!closely) return Bounds{wide.least, wide.most};
  if (closely_ != began_) kernels_.narrow(at_points_, close_.data());
  closely_ = began_;
  const Range& close = close_[place];
  const double beyond = close_overshoot * (close.most - close.least);
  return Bounds{close.least - beyond, close.most + beyond};
}

}  // namespace bbsim::solve::sampled
