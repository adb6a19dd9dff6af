// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>

#include "base/cpu_clock.hpp"
#include "base/number_text.hpp"
#include "base/real.hpp"
#include "solve/integrate.hpp"
#include "study/checks.hpp"
#include "study/reference.hpp"

namespace bbsim::study {
namespace {

// Far below the error of any double, even in scenes that grow a millionfold.
constexpr double reference_tolerance = 1e-22;
// The reference's share of the progress.
constexpr double reference_share = 0.05;

constexpr std::size_t least_repeats = 5;
constexpr double least_seconds = 0.02;
constexpr double most_seconds = 1;

double largest_error(const solve::Trajectory& rows, const ReferenceSolution& reference,
                     int coordinates) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(rows.rows(), reference.rows()); ++i) {
    for (int c = 0; c < coordinates; ++c) {
      const double error = std::abs(plain(rows.row(i)[c] - reference.row(i)[c]));
      if (!std::isfinite(error)) return infinity;
      largest = std::max(largest, error);
    }
  }
  return largest;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

AccuracyPoint measure(const model::Model& model, const solve::OutputGrid& grid, Method method,
                      double rtol, const ReferenceSolution& reference,
                      const std::atomic<bool>* stop) {
  AccuracyPoint point;
  point.method = method;
  point.tolerances = {rtol, ten_digits(rtol / 100)};
  const solve::Watch watch{stop, {}};
  std::vector<double> times;
  double total = 0;
  while (times.size() < least_repeats || total < least_seconds) {
    solve::Trajectory rows(reference.row_size);
    const CpuClock clock;
    const solve::Outcome outcome =
        solve::integrate(model, method, point.tolerances, grid, rows, watch);
    times.push_back(clock.seconds());
    total += times.back();
    point.ending = outcome.ending;
    if (times.size() == 1) {
      point.statistics = outcome.statistics;
      point.error = largest_error(rows, reference, coordinates(model));
    }
    if (outcome.ending == solve::Ending::interrupted || total > most_seconds) break;
  }
  point.cpu_seconds = median(times);
  point.repeats = times.size();
  return point;
}

// Appends text as printf does. Lines of this file are shorter than the buffer.
[[gnu::format(printf, 2, 3)]] void append(std::string& text, const char* format, ...) {
  char line[256];
  va_list arguments;
  va_start(arguments, format);
  // NOLINTNEXTLINE(clang-analyzer-valist.Uninitialized): va_start has just set it
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  text += line;
}

// Rounds to whole nanoseconds, the resolution of the clock.
double microseconds(const AccuracyPoint& point) {
  return std::round(1e9 * point.cpu_seconds) / 1000;
}

std::string name(const AccuracyPoint& point) {
  return std::string(method_name(point.method));
}

const char* status(const AccuracyPoint& point) {
  return point.ending == solve::Ending::done      ? "done"
         : point.ending == solve::Ending::stopped ? "stopped"
                                                  : "failed";
}

}  // namespace

double ten_digits(double value) {
  char digits[32];
  std::snprintf(digits, sizeof digits, "%.10g", value);
  return std::strtod(digits, nullptr);
}

AccuracyStudy measure_accuracy(const model::Model& model, const solve::OutputGrid& grid,
                               const std::vector<Method>& methods, const std::vector<double>& rtols,
                               const AccuracyWatch& watch) {
  const auto progress = [&](double fraction) {
    if (watch.progress) watch.progress(fraction);
  };
  const solve::Watch on{watch.stop,
                        [&](double time) { progress(reference_share * time / grid.end()); }};
  AccuracyStudy study;
  study.reference_by_cvode = model.hybrid();
  const ReferenceSolution reference = study.reference_by_cvode
                                          ? solve_by_cvode(model, grid, on)
                                          : solve_reference(model, grid, reference_tolerance, on);
  study.reference_error = reference.error_estimate;
  study.reference_complete = reference.complete;
  study.reference_reached = reference.reached;
  study.reference_reason = reference.reason;
  const auto all = static_cast<double>(methods.size() * rtols.size());
  for (const Method method : methods) {
    for (const double rtol : rtols) {
      if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) {
        study.interrupted = true;
        return study;
      }
      AccuracyPoint point = measure(model, grid, method, rtol, reference, watch.stop);
      // The check above then ends the study.
      if (point.ending == solve::Ending::interrupted) continue;
      study.points.push_back(point);
      progress(reference_share +
               (1 - reference_share) * static_cast<double>(study.points.size()) / all);
    }
  }
  study.interrupted = watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed);
  return study;
}

std::vector<BestChoice> best_by_decade(const AccuracyStudy& study) {
  std::vector<const AccuracyPoint*> done;
  for (const AccuracyPoint& point : study.points) {
    const bool ends = point.ending == solve::Ending::done || point.ending == solve::Ending::stopped;
    if (ends && std::isfinite(point.error)) done.push_back(&point);
  }
  if (done.empty()) return {};
  const auto by_error = [](const AccuracyPoint* a, const AccuracyPoint* b) {
    return a->error < b->error;
  };
  const auto [least, most] = std::minmax_element(done.begin(), done.end(), by_error);
  // A ball that does not move has an error of zero. It needs no decade below rounding.
  const auto decade = [](double error) {
    return static_cast<int>(std::ceil(std::log10(std::max(error, 1e-16))));
  };
  std::vector<BestChoice> best;
  for (int exponent = decade((*most)->error); exponent >= decade((*least)->error); --exponent) {
    const double allowed = std::pow(10.0, exponent);
    const AccuracyPoint* fastest = nullptr;
    for (const AccuracyPoint* point : done) {
      if (point->error > allowed) continue;
      if (fastest == nullptr || point->cpu_seconds < fastest->cpu_seconds) fastest = point;
    }
    if (fastest != nullptr) best.push_back({allowed, fastest});
  }
  return best;
}

std::string accuracy_table(const AccuracyStudy& study) {
  std::string text;
  append(text, "%-8s %8s %12s %12s %9s %9s %9s %s\n", "method", "rtol", "error (m)", "time (us)",
         "steps", "f evals", "J evals", "status");
  for (const AccuracyPoint& point : study.points) {
    append(text, "%-8s %8.0e %12.2e %12.1f %9zu %9zu %9zu %s\n", name(point).c_str(),
           point.tolerances.rtol, point.error, microseconds(point), point.statistics.steps,
           point.statistics.rhs_evaluations, point.statistics.jacobian_evaluations, status(point));
  }
  const std::vector<BestChoice> best = best_by_decade(study);
  if (best.empty()) return text;
  append(text, "\n%-14s %-8s %8s %12s %12s\n", "error within", "method", "rtol", "error (m)",
         "time (us)");
  for (const BestChoice& choice : best) {
    append(text, "%-14s %-8s %8.0e %12.2e %12.1f\n", (number_text(choice.error) + " m").c_str(),
           name(*choice.point).c_str(), choice.point->tolerances.rtol, choice.point->error,
           microseconds(*choice.point));
  }
  return text;
}

std::string accuracy_csv(const AccuracyStudy& study) {
  std::string text =
      "method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status\n";
  for (const AccuracyPoint& point : study.points) {
    text += name(point);
    for (const double value :
         {point.tolerances.rtol, point.tolerances.atol, point.error, microseconds(point)}) {
      text += ',' + number_text(value);
    }
    append(text, ",%zu,%zu,%zu,%s\n", point.statistics.steps, point.statistics.rhs_evaluations,
           point.statistics.jacobian_evaluations, status(point));
  }
  return text;
}

}  // namespace bbsim::study
