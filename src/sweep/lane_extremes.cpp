#include "sweep/lane_extremes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bbsim::sweep {
namespace {

using solve::rosenbrock::looks;
using solve::rosenbrock::states;

// Over a step states are polynomials of degree 4.
constexpr std::size_t parts = 8;

// What promises less than this part more is about as great.
constexpr double worth = 1e-9;

}  // namespace

LaneExtremes::LaneExtremes()
    : points_(search_.points(parts)), times_(parts + 1), sizes_(parts + 1) {
  rows_.resize((parts + 1) * states * group);
}

void LaneExtremes::begin(std::vector<const model::SignalPair*> references) {
  references_ = std::move(references);
  looks_ = {};
}

void LaneExtremes::accept(const solve::rosenbrock::GroupStep& step) {
  if (!step.look(looks_)) return;
  evaluated_ = false;
  for (int look = 0; look < looks; ++look) {
    for (std::size_t lane = 0; lane < references_.size(); ++lane) {
      if (looks_.promise[look][lane] > (1 + worth) * looks_.greatest[look][lane]) {
        look_closer(step, look, lane);
      }
    }
  }
}

void LaneExtremes::look_closer(const solve::rosenbrock::GroupStep& step, int look,
                               std::size_t lane) {
  if (!evaluated_) {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      times_[i] = step.from() + (step.to() - step.from()) * points_[i];
    }
    step.evaluate(times_.data(), times_.size(), rows_.data());
    evaluated_ = true;
  }
  double& greatest = looks_.greatest[look][lane];
  for (std::size_t i = 0; i < sizes_.size(); ++i) {
    sizes_[i] = size(look, lane, i);
    greatest = std::max(greatest, sizes_[i]);
  }
  greatest = search_.greatest_within(parts, sizes_.data(), record::Spacing::close, greatest);
}

double LaneExtremes::size(int look, std::size_t lane, std::size_t point) const {
  const double* const row = rows_.data() + point * states * group + lane;
  const auto state = [row](std::size_t number) { return row[number * group]; };
  const auto square = [](double value) { return value * value; };
  switch (look) {
    case Look::versine: {
      const double a = square(std::sin(state(5) / 2)), b = square(std::sin(state(6) / 2));
      return 2 * (a + b) - 4 * a * b;
    }
    case Look::rate_squared:
      return square(state(7)) + square(state(8));
    case Look::distance_squared:
      return square(state(0)) + square(state(1));
    default: {
      const auto [x, y] = references_[lane]->at(times_[point]);
      return square(state(0) - x.value) + square(state(1) - y.value);
    }
  }
}

std::optional<record::TrackExtremes> LaneExtremes::of(std::size_t lane) const {
  const double distance = looks_.greatest[Look::distance_squared][lane];
  const double error = looks_.greatest[Look::error_squared][lane];
  if (!record::is_square(distance) || !record::is_square(error)) return {};
  return record::TrackExtremes{looks_.greatest[Look::versine][lane],
                               looks_.greatest[Look::rate_squared][lane], std::sqrt(distance),
                               std::sqrt(error)};
}

}  // namespace bbsim::sweep
