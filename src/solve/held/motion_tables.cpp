#include "solve/held/motion_tables.hpp"

#include <algorithm>
#include <cmath>

#include "solve/held/start_weights.hpp"
#include "solve/radau/tables.hpp"

namespace bbsim::solve::held {
namespace {

void answer_at_nodes(const Kernels& kernels, const model::HeldLaw& law, double length,
                     NodeAnswers& answers) {
  if (model::suits_series(law, length)) {
    kernels.answers(law.damping, law.stiffness, length, answers);
    return;
  }
  for (int i = 0; i < nodes; ++i) {
    const model::ImpulseAnswer at = model::answer(law, radau::RadauTable<nodes>::c[i] * length);
    answers.integral[i] = at.integral;
    answers.value[i] = at.value;
    answers.slope[i] = at.slope;
  }
}

void fill(MotionTable& table, const Kernels& kernels, const model::HeldLaw& law, double length) {
  const model::HeldMotion by_rate{law, 0, 1, 0}, by_acceleration{law, 0, 0, 1};
  const auto put = [](double(&rows)[MotionTable::rows][nodes], int i,
                      const model::HeldMotion::Instant& at) {
    rows[MotionTable::angle][i] = at.angle;
    rows[MotionTable::rate][i] = at.rate;
    rows[MotionTable::acceleration][i] = at.acceleration;
  };
  NodeAnswers answers;
  answer_at_nodes(kernels, law, length, answers);
  table.most_by_rate = table.most_by_acceleration = 0;
  for (int i = 0; i < nodes; ++i) {
    const model::ImpulseAnswer at{answers.integral[i], answers.value[i], answers.slope[i]};
    put(table.by_rate, i, by_rate.after(at));
    put(table.by_acceleration, i, by_acceleration.after(at));
    table.most_by_rate =
        std::max(table.most_by_rate, std::abs(table.by_rate[MotionTable::angle][i]));
    table.most_by_acceleration = std::max(table.most_by_acceleration,
                                          std::abs(table.by_acceleration[MotionTable::angle][i]));
  }
  constexpr StartWeights start;
  table.missed_by_rate = 0;
  table.missed_by_acceleration = -1;
  for (int i = 0; i < nodes; ++i) {
    constexpr auto row = MotionTable::acceleration;
    table.missed_by_rate += start.of[i] * table.by_rate[row][i];
    table.missed_by_acceleration += start.of[i] * table.by_acceleration[row][i];
  }
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

}  // namespace bbsim::solve::held
