// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/sampled/motion_tables.hpp"

#include <algorithm>
#include <cmath>

#include "solve/collocation/radau_table.hpp"

namespace bbsim::solve::sampled {
namespace {

constexpr const auto& rule = radau::radau_table<radau::Shared, nodes>;

void answer_at_nodes(const Kernels& kernels, const model::HeldLaw& law, double length,
                     NodeAnswers& answers) {
  if (model::suits_series(law, length)) {
    kernels.answers(law.damping, law.stiffness, length, answers);
    return;
  }
  for (int i = 0; i < nodes; ++i) {
    const model::ImpulseAnswer at = model::answer(law, rule.c[i] * length);
    answers.integral[i] = at.integral;
    answers.value[i] = at.value;
    answers.slope[i] = at.slope;
  }
}

// The part of `whole` that `sum` lacks, or 0 if it is rounding relative to `motion`. An initial
// acceleration that decays within a millionth of the length counts as rounding here; `missed`
// covers it.
double lost_of(double whole, double sum, double motion) {
  constexpr double rounding = 1e-13;
  const double left = whole - sum;
  return std::abs(left) > rounding * motion ? left : 0;
}

// Compares the integrals of the nodal accelerations with the closed form. This is not needed if a
// power series gives the motion: eight nodes are then exact to rounding.
void find_lost(MotionTable& table, double h) {
  constexpr int end = nodes - 1;
  const auto integrals = [&](const double(&rows)[MotionTable::rows][nodes], double& once,
                             double& twice) {
    once = twice = 0;
    for (int j = 0; j < nodes; ++j) {
      once += h * rule.a[j][end] * rows[MotionTable::acceleration][j];
      twice += h * h * rule.a_squared[j][end] * rows[MotionTable::acceleration][j];
    }
  };
  double once = 0, twice = 0;
  integrals(table.by_rate, once, twice);
  table.lost_rate_by_rate = lost_of(table.by_rate[MotionTable::rate][end] - 1, once, 1);
  table.lost_angle_by_rate = lost_of(table.by_rate[MotionTable::angle][end] - h, twice, h);
  integrals(table.by_acceleration, once, twice);
  table.lost_rate_by_acceleration = lost_of(table.by_acceleration[MotionTable::rate][end], once, h);
  table.lost_angle_by_acceleration =
      lost_of(table.by_acceleration[MotionTable::angle][end], twice, h * h);
  table.lost = table.lost_rate_by_rate != 0 || table.lost_angle_by_rate != 0 ||
               table.lost_rate_by_acceleration != 0 || table.lost_angle_by_acceleration != 0;
}

void fill(MotionTable& table, const Kernels& kernels, const model::HeldLaw& law, double length) {
  const model::HeldMotion by_rate{law, 0, 1, 0}, by_acceleration{law, 0, 0, 1};
  const auto put = [](double(&rows)[MotionTable::rows][nodes], int i,
                      const model::HeldMotion::ServoState& at) {
    rows[MotionTable::angle][i] = at.angle;
    rows[MotionTable::rate][i] = at.rate;
    rows[MotionTable::acceleration][i] = at.acceleration;
  };
  NodeAnswers answers;
  answer_at_nodes(kernels, law, length, answers);
  table.most_by_rate = table.most_by_acceleration = 0;
  for (int i = 0; i < nodes; ++i) {
    const model::ImpulseAnswer at{answers.integral[i], answers.value[i], answers.slope[i]};
    put(table.by_rate, i, by_rate.after(at, rule.c[i] * length));
    put(table.by_acceleration, i, by_acceleration.after(at, rule.c[i] * length));
    table.most_by_rate =
        std::max(table.most_by_rate, std::abs(table.by_rate[MotionTable::angle][i]));
    table.most_by_acceleration = std::max(table.most_by_acceleration,
                                          std::abs(table.by_acceleration[MotionTable::angle][i]));
  }
  constexpr radau::StartWeights<nodes> start;
  table.missed_by_rate = 0;
  table.missed_by_acceleration = -1;
  for (int i = 0; i < nodes; ++i) {
    constexpr auto row = MotionTable::acceleration;
    table.missed_by_rate += start.of[i] * table.by_rate[row][i];
    table.missed_by_acceleration += start.of[i] * table.by_acceleration[row][i];
  }
  table.lost = false;
  table.lost_rate_by_rate = table.lost_rate_by_acceleration = 0;
  table.lost_angle_by_rate = table.lost_angle_by_acceleration = 0;
  if (!model::suits_series(law, length)) find_lost(table, length);
}

}  // namespace

const MotionTable& MotionTables::of(const model::HeldLaw& law, double length) {
  if (entries_.empty()) entries_.reserve(kept);
  ++asked_;
  for (Entry& entry : entries_) {
    if (entry.length == length && entry.law == law) {
      entry.used = asked_;
      return entry.table;
    }
  }
  if (entries_.size() < kept) entries_.emplace_back();
  Entry& oldest = *std::min_element(entries_.begin(), entries_.end(),
                                    [](const Entry& a, const Entry& b) { return a.used < b.used; });
  oldest.law = law;
  oldest.length = length;
  oldest.used = asked_;
  fill(oldest.table, kernels_, law, length);
  return oldest.table;
}

}  // namespace bbsim::solve::sampled
