// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "report.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <optional>

#include "base/number_text.hpp"
#include "equal_error.hpp"

namespace bbsim::bench {
namespace {

// Upper bound on radau's time relative to another tool, with AVX-512.
struct Target {
  const char* scene;
  const char* other;
  double error;  // m
  double ratio;
};

constexpr Target targets[] = {
    {"fig2a", "dopri5", 1e-9, 0.4},     {"fig2a", "dopri5", 1e-12, 0.15},
    {"fast", "dopri5", 1e-9, 0.2},      {"fig2b", "dopri5", 1e-9, 0.4},
    {"fig2b", "dopri5", 1e-12, 0.15},   {"stiff-servo", "bdf", 1e-6, 0.15},
    {"stiff-servo", "bdf", 1e-9, 0.12},
};

// AVX2, with half as many lanes, may take twice the time. Without AVX there is no target.
std::optional<double> target(const std::string& scene, const std::string& other, double error,
                             const std::string& kernels) {
  const double factor = kernels == "avx512" ? 1 : kernels == "avx2" ? 2 : 0;
  const auto* const found =
      std::find_if(std::begin(targets), std::end(targets), [&](const Target& one) {
        return scene == one.scene && other == one.other && error == one.error;
      });
  if (factor == 0 || found == std::end(targets)) return {};
  return factor * found->ratio;
}

std::string text(const char* format, double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string padded(const std::string& value, std::size_t width) {
  return std::string(width - std::min(width, value.size()), ' ') + value;
}

std::string microseconds(std::optional<double> seconds) {
  return padded(seconds ? text("%.1f", 1e6 * *seconds) : "-", 10);
}

std::string ratio(std::optional<double> own, std::optional<double> other,
                  std::optional<double> allowed) {
  std::string line = padded(own && other ? text("%.3f", *own / *other) : "-", 15);
  if (!allowed) return line + std::string(16, ' ');
  const bool holds = own && other && *own / *other <= *allowed;
  return line + "  <= " + text("%.2f", *allowed) + (holds ? " holds" : " FAILS") + ' ';
}

}  // namespace

std::string ratio_table(const std::vector<Measured>& scenes, const std::string& kernels) {
  std::string table =
      "scene         error (m)  radau us dopri5 us   by hand    BDF us  Adams us"
      "   radau/dopri5  (target)         radau/BDF  (target)\n";
  for (const Measured& measured : scenes) {
    for (const double error : {1e-6, 1e-9, 1e-12}) {
      const auto time = [&](const char* tool) { return seconds_at(measured.points, tool, error); };
      const auto own = time("radau"), dopri5 = time("dopri5"), bdf = time("bdf");
      std::string line =
          measured.scene + std::string(14 - std::min<std::size_t>(13, measured.scene.size()), ' ');
      line += padded(text("%.0e", error), 9) + microseconds(own) + microseconds(dopri5) +
              microseconds(time("by hand")) + microseconds(bdf) + microseconds(time("adams"));
      line += ratio(own, dopri5, target(measured.scene, "dopri5", error, kernels));
      line += "   " + ratio(own, bdf, target(measured.scene, "bdf", error, kernels));
      line.erase(line.find_last_not_of(' ') + 1);
      table += line + '\n';
    }
  }
  return table;
}

std::string points_csv(const std::vector<Measured>& scenes) {
  std::string csv = "scene,tool,rtol,atol,error_m,time_us,runs\n";
  for (const Measured& measured : scenes) {
    for (const Point& point : measured.points) {
      csv += measured.scene + ',' + point.tool;
      for (const double value :
           {point.tolerances.rtol, point.tolerances.atol, point.error, 1e6 * point.seconds}) {
        csv += ',' + number_text(value);
      }
      csv += ',' + std::to_string(point.runs) + '\n';
    }
  }
  return csv;
}

}  // namespace bbsim::bench
