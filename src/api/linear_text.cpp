// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/linear_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "api/loop_text.hpp"
#include "base/short_number.hpp"

namespace bbsim::api {
namespace {

std::string degrees(double angle) {
  return short_number(angle * 180 / std::numbers::pi) + " deg";
}

std::string at(double frequency) {
  return " at " + short_number(frequency) + " rad/s";
}

std::string text_of(const model::Margins& margins) {
  std::string text;
  if (std::isfinite(margins.gain)) {
    text += "gain by " + short_number(margins.gain) + " (" +
            short_number(20 * std::log10(margins.gain)) + " dB)" + at(margins.gain_at);
  } else {
    text += "any gain above";
  }
  if (margins.reduction > 0) {
    text += ", or down by " + short_number(margins.reduction) + at(margins.reduction_at);
  }
  if (!std::isfinite(margins.phase)) return text + "; any phase and delay";
  text += "; phase " + degrees(std::abs(margins.phase)) + (margins.phase < 0 ? " of lead" : "") +
          at(margins.phase_at);
  return text + "; delay " + short_number(margins.delay) + " s";
}

std::string names_line(const std::vector<model::LinearSignal>& signals) {
  std::string line;
  for (const model::LinearSignal& signal : signals) {
    line += (line.empty() ? "" : ", ") + signal.name + " (" + signal.unit + ")";
  }
  return line;
}

std::string values_line(const model::Eigenvalues& values) {
  return values.empty() ? "none" : poles_line(values);
}

}  // namespace

Report margin_lines(const model::Linearization& made) {
  Report lines;
  for (const model::LoopMargins& loop : made.margins) {
    lines.push_back({"  " + loop.command.substr(0, loop.command.find('_')), text_of(loop.margins)});
  }
  const auto bandwidths = [&made](double model::Bandwidth::*of) {
    std::string text;
    for (const model::Bandwidth& one : made.bandwidths) {
      text += (text.empty() ? "" : ", ") + one.output + " " +
              (std::isfinite(one.*of) ? short_number(one.*of) + " rad/s" : "none");
    }
    return text;
  };
  const auto all_end = [&made](double model::Bandwidth::*of) {
    return std::ranges::all_of(made.bandwidths,
                               [of](const auto& one) { return std::isfinite(one.*of); });
  };
  if (made.bandwidths.empty()) return lines;
  if (all_end(&model::Bandwidth::value)) {
    lines.push_back({"  bandwidth", bandwidths(&model::Bandwidth::value)});
  } else if (all_end(&model::Bandwidth::of_feedback)) {
    lines.push_back(
        {"  bandwidth", bandwidths(&model::Bandwidth::of_feedback) +
                            ", of the feedback: with the reference's accelerations, which the law "
                            "knows, the response does not fall to 1/sqrt(2)"});
  } else {
    lines.push_back(
        {"  bandwidth", bandwidths(&model::Bandwidth::value) +
                            ": the response does not fall to 1/sqrt(2)" +
                            (made.system.period ? " up to half the sampling rate" : "")});
  }
  return lines;
}

Report linear_report(const std::string& of, const model::Linearization& made) {
  const model::LinearSystem& system = made.system;
  Report report{{"linear", of},
                {"states", names_line(system.states)},
                {"inputs", names_line(system.inputs)},
                {"outputs", names_line(system.outputs)},
                {"period", system.period ? short_number(*system.period) + " s" : "continuous time"},
                {"poles", values_line(made.poles)},
                {"zeros", values_line(made.zeros)}};
  if (!made.margins.empty()) {
    report.push_back(
        {"margins",
         std::string("of each command's loop, the other one closed") +
             (made.stable
                  ? ""
                  : "; the loop is not stable: these are where poles cross the stability limit")});
  }
  const Report margins = margin_lines(made);
  report.insert(report.end(), margins.begin(), margins.end());
  return report;
}

}  // namespace bbsim::api
