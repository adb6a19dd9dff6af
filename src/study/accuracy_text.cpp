// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "study/accuracy_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string_view>
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
  return point.ending == solve::Ending::done ? "done" : "failed";
}

// The text as a gnuplot string in single quotes, where only the quote is special: it is doubled.
std::string quoted(std::string_view text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') result += '\'';
    result += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return result + "'";
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

std::string accuracy_plot(const AccuracyStudy& study, const std::string& title, Picture picture) {
  // Okabe and Ito's colors, which color-blind people can distinguish.
  constexpr std::array<std::string_view, 6> colours{"#0072B2", "#D55E00", "#009E73",
                                                    "#CC79A7", "#E69F00", "#56B4E9"};
  std::vector<Method> methods;
  for (const AccuracyPoint& point : study.points) {
    if (std::find(methods.begin(), methods.end(), point.method) == methods.end()) {
      methods.push_back(point.method);
    }
  }

  std::string script, curves;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    std::string data;
    for (const AccuracyPoint& point : study.points) {
      if (point.method != methods[i] || point.ending != solve::Ending::done) continue;
      if (!std::isfinite(point.error)) continue;
      // A logarithm has no zero. An error below all rounding can be zero.
      append(data, "%.17g %.17g\n", std::max(point.error, 1e-20), microseconds(point));
    }
    if (data.empty()) continue;
    const std::string block = "$curve" + std::to_string(i);
    script += block;
    script += " << END\n";
    script += data;
    script += "END\n";
    const std::string colour(colours[i % colours.size()]);
    if (!curves.empty()) curves += ", \\\n     ";
    append(curves, "%s using 1:2 with linespoints lw 2 pt %zu ps 0.8 lc rgb '%s' title '%s'",
           block.c_str(), 5 + 2 * (i % 6), colour.c_str(),
           std::string(solve::method_name(methods[i])).c_str());
  }

  switch (picture) {
    case Picture::svg:
      script += "set terminal svg size 900,600 dynamic font 'sans-serif,15' background 'white'\n";
      break;
    case Picture::png:
      script += "set terminal pngcairo size 900,600 font 'sans-serif,12' background 'white'\n";
      break;
    case Picture::pdf:
      script += "set terminal pdfcairo size 9in,6in font 'sans-serif,15' background 'white'\n";
      break;
  }
  script += "set encoding utf8\n";
  script += "set title " + quoted(title) + " noenhanced\n";
  script +=
      "set logscale xy\n"
      "set format '10^{%L}'\n"
      "set xlabel 'error: largest |Δx|, |Δy| over the output times (m)'\n"
      "set ylabel 'processor time of a run (µs)'\n"
      "set grid xtics ytics mxtics mytics lc rgb '#c0c0c0' lw 1, lc rgb '#ececec' lw 1\n"
      "set mxtics 1\n"
      "set mytics 10\n"
      "set key outside right top title 'method'\n"
      "set tics nomirror\n"
      "set border 3\n";
  return script + "plot " + curves + "\n";
}

}  // namespace bbsim::study
