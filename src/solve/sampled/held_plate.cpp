// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/held_plate.hpp"

#include <algorithm>
#include <cmath>

#include "solve/collocation/radau_table.hpp"
#include "solve/sampled/monitor_ranges.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr std::size_t angle = model::RigLayout::angle;

// The angle of the horn, or of the plate that a servo turns directly.
double horn_of(const PieceAxis& axis, double servo) {
  return axis.ratio * servo + axis.offset;
}

// How far a servo's angle has moved at the end of the piece, its rate or its acceleration.
double end_of(const PieceAxis& axis, MotionTable::Row row) {
  return axis.table->by_rate[row][nodes - 1] * axis.rate +
         axis.table->by_acceleration[row][nodes - 1] * axis.acceleration;
}

// The table of a motion with drift, from that of its law.
void add_drift(const model::HeldMotion& servo, double length, const MotionTable& of_law,
               MotionTable& table) {
  const auto both = [&](double by_rate, double by_acceleration) {
    return by_rate * servo.rate + by_acceleration * servo.acceleration;
  };
  table = {};
  for (int n = 0; n < nodes; ++n) {
    const double time = radau::radau_table<radau::Shared, nodes>.c[n] * length;
    const double turned = servo.drift_acceleration * time;
    const double drift[MotionTable::rows] = {time * (servo.drift_rate + turned / 2),
                                             servo.drift_rate + turned, servo.drift_acceleration};
    for (int row = 0; row < MotionTable::rows; ++row) {
      table.by_rate[row][n] =
          both(of_law.by_rate[row][n], of_law.by_acceleration[row][n]) + drift[row];
    }
    table.most_by_rate =
        std::max(table.most_by_rate, std::abs(table.by_rate[MotionTable::angle][n]));
  }
  // Nodes resolve a drift exactly.
  table.missed_by_rate = both(of_law.missed_by_rate, of_law.missed_by_acceleration);
  table.lost = of_law.lost;
  table.lost_rate_by_rate = both(of_law.lost_rate_by_rate, of_law.lost_rate_by_acceleration);
  table.lost_angle_by_rate = both(of_law.lost_angle_by_rate, of_law.lost_angle_by_acceleration);
}

}  // namespace

HeldPlate::HeldPlate(const model::Model& model)
    : servos_(static_cast<std::size_t>(model.rig->servos)),
      drifting_(model.rig->rings() ? servos_ : 0) {
  with_given_plate(model.system, [this](const auto& loop) {
    using Link = std::decay_t<decltype(loop.link)>;
    mode_ = &loop.mode;
    response_ = loop.servo();
    if constexpr (std::is_same_v<Link, model::Linkages>) linkages_ = &loop.link;
    if constexpr (std::is_same_v<Link, model::ThreeServos>) three_ = &loop.link;
  });
  if (three_ == nullptr) return;
  known_.legs.pose = three_->home(known_.horn);
  gain_ = 0;
  for (int i = 0; i < 3; ++i) {
    double rates[3] = {};
    const double none[3] = {};
    rates[i] = 1;
    model::GimbalAngle<double> plane[2];
    three_->planes(known_.horn, rates, none, plane);
    gain_ = std::max({gain_, std::abs(plane[0].rate), std::abs(plane[1].rate)});
  }
}

void HeldPlate::set_motions(double t, const double* z, model::HeldMotions& motions) const {
  for (std::size_t i = 0; i < servos_; ++i) {
    motions[i] =
        model::held_motion(response_.of[i], *mode_, i, z[angle + i], z[angle + servos_ + i], t);
  }
}

void HeldPlate::prepare(const model::HeldMotions& motions, double length, MotionTables& tables,
                        PlateMotion& motion) {
  const MotionTable* first = nullptr;
  for (std::size_t i = 0; i < servos_; ++i) {
    const model::HeldMotion& servo = motions[i];
    // The servos usually have the same law.
    const MotionTable* const table =
        i > 0 && servo.law == motions[0].law ? first : &tables.of(servo.law, length);
    if (i == 0) first = table;
    const model::AxisMode& mode = mode_->axis[i];
    motion.axis[i] = {table,      servo.angle, servo.rate, servo.acceleration,
                      mode.ratio, mode.offset, servo.rate, servo.acceleration};
    if (mode_->rings && mode_->driver[i].rings) {
      add_drift(servo, length, *table, drifting_[i]);
      PieceAxis& axis = motion.axis[i];
      axis.table = &drifting_[i];
      axis.rate = 1;
      axis.acceleration = 0;
      axis.start_rate += servo.drift_rate;
      axis.start_acceleration += servo.drift_acceleration;
    }
  }
  motion.linkages = linkages_;
  motion.three = three_;
  motion.gain = gain_;
  if (linkages_ != nullptr) {
    start_plate(*linkages_, motion);
  } else if (three_ != nullptr) {
    start_plate(*three_, motion);
  }
}

// Computes the plate's motion at the start of the piece.
void HeldPlate::start_plate(const model::Linkages& link, PlateMotion& motion) const {
  motion.gain = 0;
  for (int i = 0; i < 2; ++i) {
    const PieceAxis& of = motion.axis[i];
    const double rate = of.ratio * of.start_rate, acting = of.ratio * of.start_acceleration;
    // The rate for a unit rate of the horn.
    const model::Turn<double> turn = link.of[i].turn(horn_of(of, of.angle));
    motion.plane_start[i] = {turn.sin, turn.cos, turn.slope * rate,
                             turn.slope * acting + turn.bend * (rate * rate)};
    motion.gain = std::max(motion.gain, std::abs(turn.slope));
  }
}

// The same for three servos. Usually the piece starts where the last one ended, and only the
// servos' accelerations differ.
void HeldPlate::start_plate(const model::ThreeServos& link, PlateMotion& motion) {
  double horn[3], rate[3], acting[3];
  for (int i = 0; i < 3; ++i) {
    const PieceAxis& of = motion.axis[i];
    horn[i] = horn_of(of, of.angle);
    rate[i] = of.ratio * of.start_rate;
    acting[i] = of.ratio * of.start_acceleration;
  }
  if (!known_.has_plate || !std::equal(horn, horn + 3, known_.horn) ||
      !std::equal(rate, rate + 3, known_.rate)) {
    double sine[3], cosine[3];
    link.directions(horn, sine, cosine);
    model::ThreeServos::Pose<double>& pose = known_.legs.pose;
    model::ThreeServos::Jacobian<double> there;
    pose = link.pose_from(pose, known_.horn, horn, sine, cosine, there);
    link.pose_slopes(there, known_.legs.slopes);
    link.planes_in(pose, there, sine, cosine, rate, acting, known_.plane);
    link.edges(there, known_.edges);
    std::copy_n(horn, 3, known_.horn);
    std::copy_n(rate, 3, known_.rate);
    std::copy_n(acting, 3, known_.acceleration);
    known_.has_plate = true;
  }
  motion.legs_start = known_.legs;
  std::copy_n(known_.edges, model::ThreeServos::edge_count, motion.edges_start);
  double more[3], by_more[2];
  for (int i = 0; i < 3; ++i) more[i] = acting[i] - known_.acceleration[i];
  link.tilt_rates(known_.legs.pose, known_.legs.slopes, more, by_more);
  for (int i = 0; i < 2; ++i) {
    motion.plane_start[i] = known_.plane[i];
    motion.plane_start[i].acceleration += by_more[i];
  }
}

void HeldPlate::write_end(const PlateMotion& motion, double* z) const {
  for (std::size_t i = 0; i < servos_; ++i) {
    const PieceAxis& axis = motion.axis[i];
    z[angle + i] = axis.angle + end_of(axis, MotionTable::angle);
    z[angle + servos_ + i] = end_of(axis, MotionTable::rate);
  }
}

void HeldPlate::pass(const PlateMotion& motion) {
  if (three_ == nullptr) return;
  constexpr int last = nodes - 1;
  known_.legs = motion.legs_end;
  known_.has_plate = true;
  for (int i = 0; i < 3; ++i) {
    const PieceAxis& axis = motion.axis[i];
    known_.horn[i] = horn_of(axis, axis.angle + end_of(axis, MotionTable::angle));
    known_.rate[i] = axis.ratio * end_of(axis, MotionTable::rate);
    known_.acceleration[i] = axis.ratio * end_of(axis, MotionTable::acceleration);
  }
  for (int i = 0; i < 2; ++i) {
    const PlateMotion::Plane& plane = motion.plane[i];
    known_.plane[i] = {plane.sin[last], plane.cos[last], plane.rate[last],
                       plane.acceleration[last]};
  }
  for (int k = 0; k < model::ThreeServos::edge_count; ++k) known_.edges[k] = motion.edges[k][last];
}

bool HeldPlate::stays_off_dead_points(const PlateMotion& motion, const model::HeldMotions& motions,
                                      double length) const {
  if (three_ != nullptr) {
    for (int k = 0; k < model::ThreeServos::edge_count; ++k) {
      // The start replaces the first node, as for all ranges.
      Range of{motion.edges_start[k], motion.edges_start[k]};
      for (int n = 1; n < nodes; ++n) {
        const double edge = motion.edges[k][n];
        of = {edge < of.least ? edge : of.least, edge > of.most ? edge : of.most};
      }
      if (!(widened(of).least > 0)) return false;
    }
    return true;
  }
  for (std::size_t i = 0; i < servos_ && linkages_ != nullptr; ++i) {
    const PieceAxis& axis = motion.axis[i];
    const model::MotionReach to = model::reach(motions[i], length);
    const double center = horn_of(axis, to.centre);
    const double most = std::abs(axis.ratio) * to.angle_most;
    const model::LinkCurve& curve = linkages_->of[i];
    if (!(center - most > curve.low && center + most < curve.high)) return false;
  }
  return true;
}

}  // namespace bbsim::solve::sampled
