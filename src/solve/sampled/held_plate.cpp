// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/held_plate.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace

HeldPlate::HeldPlate(const model::Model& model)
    : servos_(static_cast<std::size_t>(model.rig->servos)) {
  with_given_plate(model.system, [this](const auto& loop) {
    using Link = std::decay_t<decltype(loop.link)>;
    mode_ = &loop.mode;
    response_ = loop.servo();
    if constexpr (std::is_same_v<Link, model::Linkages>) linkages_ = &loop.link;
    if constexpr (std::is_same_v<Link, model::ThreeServos>) three_ = &loop.link;
  });
  if (three_ == nullptr) return;
  pose_ = three_->home(horns_);
  gain_ = 0;
  for (int i = 0; i < 3; ++i) {
    double rates[3] = {};
    const double none[3] = {};
    rates[i] = 1;
    model::GimbalAngle<double> plane[2];
    three_->planes(horns_, rates, none, plane);
    gain_ = std::max({gain_, std::abs(plane[0].rate), std::abs(plane[1].rate)});
  }
}

model::HeldMotions HeldPlate::motions(const double* z) const {
  model::HeldMotions motions{};
  for (std::size_t i = 0; i < servos_; ++i) {
    motions[i] = model::held_motion(response_.of[i], mode_->axis[i], mode_->command[i],
                                    z[angle + i], z[angle + servos_ + i]);
  }
  return motions;
}

void HeldPlate::prepare(const model::HeldMotions& motions, double length, MotionTables& tables,
                        PlateMotion& motion) {
  for (std::size_t i = 0; i < servos_; ++i) {
    const model::HeldMotion& servo = motions[i];
    // The servos usually have the same law.
    const MotionTable* const table =
        i > 0 && servo.law == motions[0].law ? motion.axis[0].table : &tables.of(servo.law, length);
    const model::AxisMode& mode = mode_->axis[i];
    motion.axis[i] = {table, servo.angle, servo.rate, servo.acceleration, mode.ratio, mode.offset};
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
template <class Link>
void HeldPlate::start_plate(const Link& link, PlateMotion& motion) {
  double horn[Link::servos], rate[Link::servos], acting[Link::servos];
  for (int i = 0; i < Link::servos; ++i) {
    const PieceAxis& of = motion.axis[i];
    horn[i] = horn_of(of, of.angle);
    rate[i] = of.ratio * of.rate;
    acting[i] = of.ratio * of.acceleration;
  }
  if constexpr (Link::servos == 3) {
    double sine[3], cosine[3];
    link.directions(horn, sine, cosine);
    // Usually the piece starts where the last one ended.
    if (!std::equal(horn, horn + 3, horns_)) {
      pose_ = link.pose_from(pose_, horns_, horn, sine, cosine);
      std::copy_n(horn, 3, horns_);
    }
    motion.pose_start = pose_;
    model::ThreeServos::Slopes<double> slopes[3];
    link.slopes(pose_, sine, cosine, slopes);
    link.pose_slopes(slopes, motion.pose_slopes);
    const double whole =
        link.planes_in(pose_, slopes, sine, cosine, rate, acting, motion.plane_start);
    link.edges(pose_, sine, cosine, whole, motion.edges_start);
  } else {
    motion.gain = 0;
    for (int i = 0; i < Link::servos; ++i) {
      // The rate for a unit rate of the horn.
      const model::Turn<double> turn = link.of[i].turn(horn[i]);
      motion.plane_start[i] = {turn.sin, turn.cos, turn.slope * rate[i],
                               turn.slope * acting[i] + turn.bend * (rate[i] * rate[i])};
      motion.gain = std::max(motion.gain, std::abs(turn.slope));
    }
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
  pose_ = motion.pose_end;
  for (std::size_t i = 0; i < servos_; ++i) {
    const PieceAxis& axis = motion.axis[i];
    horns_[i] = horn_of(axis, axis.angle + end_of(axis, MotionTable::angle));
  }
}

bool HeldPlate::stays_off_dead_points(const PlateMotion& motion, const model::HeldMotions& motions,
                                      double length) const {
  if (three_ != nullptr) {
    for (int k = 0; k < model::ThreeServos::edge_count; ++k) {
      double edge[nodes];  // the start replaces the first node, as for all ranges
      std::copy_n(motion.edges[k], nodes, edge);
      edge[0] = motion.edges_start[k];
      const auto [least, most] = std::minmax_element(edge, edge + nodes);
      if (!(widened({*least, *most}).least > 0)) return false;
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
