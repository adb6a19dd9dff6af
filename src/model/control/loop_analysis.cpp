// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/loop_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <string_view>

#include "base/real.hpp"
#include "model/control/sample_times.hpp"

namespace bbsim::model {

using Kind = scenario::LoopMeasure::Kind;

namespace {

constexpr const char* one_axis = "the ball moves along the other axis only";

}  // namespace

LoopParts parts_of(const std::vector<scenario::Measure>& measures) {
  LoopParts parts{false, {MarginParts{false, false}, MarginParts{false, false}}, {false, false}};
  for (const scenario::Measure& measure : measures) {
    if (measure.kind != scenario::Measure::Kind::loop) continue;
    const std::size_t axis = measure.loop->axis;
    switch (measure.loop->kind) {
      case Kind::gain_margin:
      case Kind::gain_reduction:
        parts.margins[axis].gains = true;
        break;
      case Kind::phase_margin:
      case Kind::delay_margin:
        parts.margins[axis].phases = true;
        break;
      case Kind::bandwidth:
      case Kind::feedback_bandwidth:
        parts.bandwidths[axis] = true;
        break;
      default:
        break;
    }
  }
  return parts;
}

const Eigenvalues& LoopAnalysis::poles() {
  if (!poles_) poles_ = sampled() ? sampled_poles(model_) : closed_loop_poles(model_);
  return *poles_;
}

bool LoopAnalysis::is_stable() {
  return stable(poles(), sampled());
}

LoopAnalysis::Value LoopAnalysis::pole_value(Kind kind) {
  if (kind == Kind::stable) return {is_stable() ? 1.0 : 0.0};
  if (!sampled()) return {poles().front().real()};
  const SampledLoop& loop = *model_.rig->sampled;
  const double size = std::abs(poles().front());
  const double samples = common_cycle(loop.sampling, loop.sensor).samples;
  if (kind == Kind::spectral_radius) return {samples > 1 ? std::pow(size, 1 / samples) : size};
  return {std::log(size) / (samples * loop.sampling.period)};
}

LoopAnalysis::Value LoopAnalysis::margin(const scenario::LoopMeasure& measure) {
  const std::string_view command = measure.axis == 0 ? "phi_command" : "theta_command";
  const auto found = std::ranges::find(loop_->margins, command, &LoopMargins::command);
  if (found == loop_->margins.end()) return {no_number, one_axis};
  const Margins& margins = found->margins;
  switch (measure.kind) {
    case Kind::gain_margin:
      return {margins.gain};
    case Kind::gain_reduction:
      return {margins.reduction};
    case Kind::phase_margin:
      return {std::abs(margins.phase)};
    default:
      return {margins.delay};
  }
}

LoopAnalysis::Value LoopAnalysis::bandwidth(const scenario::LoopMeasure& measure) {
  const std::string_view output = measure.axis == 0 ? "x" : "y";
  const auto found = std::ranges::find(loop_->bandwidths, output, &Bandwidth::output);
  if (found == loop_->bandwidths.end()) return {no_number, one_axis};
  return {measure.kind == Kind::bandwidth ? found->value : found->of_feedback};
}

LoopAnalysis::Value LoopAnalysis::value_of(const scenario::LoopMeasure& measure) {
  if (poles().empty()) return {no_number, "the loop has no linear equations about home"};
  if (!measure.of_response()) return pole_value(measure.kind);
  if (!is_stable()) return {no_number, "the loop is not stable"};
  if (sampled()) {
    const SampledLoop& loop = *model_.rig->sampled;
    if (common_cycle(loop.sampling, loop.sensor).samples > 1) {
      return {no_number, "the loop differs from sample to sample because of the sensor's frames"};
    }
  }
  if (!loop_) loop_ = linearize(scene_, model_, LinearKind::loop, home_point(), parts_);
  if (!loop_->stable) return {no_number, "the loop is not stable"};
  const bool is_width = measure.kind == Kind::bandwidth || measure.kind == Kind::feedback_bandwidth;
  return is_width ? bandwidth(measure) : margin(measure);
}

}  // namespace bbsim::model
