// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/accuracy_text.hpp"

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <vector>

#include "base/number_text.hpp"
#include "solve/choose.hpp"

namespace bbsim::study {
namespace {

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
  return std::string(solve::method_name(point.method));
}

const char* status(const AccuracyPoint& point) {
  return point.ending == solve::Ending::done      ? "done"
         : point.ending == solve::Ending::stopped ? "stopped"
                                                  : "failed";
}

}  // namespace

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
