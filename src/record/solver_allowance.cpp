// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// How far two results may differ according to the tolerances of their solvers.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "base/number_text.hpp"
#include "base/text.hpp"
#include "record/compare.hpp"
#include "scenario/columns.hpp"
#include "scenario/log_columns.hpp"
#include "scenario/measures.hpp"
#include "scenario/reader.hpp"

namespace bbsim::record {

using scenario::Column;
using scenario::find_column;
using scenario::find_measure;
using scenario::Needs;

namespace {

using yaml::Dimension;

constexpr double growth = 100;  // of errors from one step to the whole run

std::optional<std::string> attribute(const file::Table& table, std::string_view name) {
  for (const auto& [key, value] : table.attributes) {
    if (key == name) return value.text();
  }
  return {};
}

// The attribute as a number above 0.
std::optional<double> number(const file::Table& table, std::string_view name) {
  const std::optional<std::string> text = attribute(table, name);
  const auto value = text ? number_in<double>(*text) : std::nullopt;
  return value && std::isfinite(*value) && *value > 0 ? value : std::nullopt;
}

Source source_of(const file::Table& table) {
  return {"", attribute(table, "scenario_text").value_or(""),
          lines_of(attribute(table, "overrides").value_or(""))};
}

// A file's statement of its accuracy.
struct Claim {
  double rtol = 0, atol = 0;            // both 0 if unknown
  std::optional<double> error_bound{};  // m
  double spin_unit = 1, gamma_unit = 1, acceleration_unit = 1;
};

Claim claim_of(const file::Table& table) {
  Claim claim;
  const std::optional<double> rtol = number(table, "rtol"), atol = number(table, "atol");
  if (rtol && atol) claim = {*rtol, *atol};
  if (const auto bound = number(table, "error_bound")) {
    // A run that missed the bound states the error that it reached.
    claim.error_bound = std::max(*bound, number(table, "error_estimate").value_or(0));
  }
  const Source source = source_of(table);
  if (source.text.empty()) return claim;

  double radius = number_at(source, "ball.radius", Dimension::length).value_or(1);
  if (const file::Column* varied = table.find("ball.radius")) {
    for (const double value : varied->numbers) {
      if (value > 0) radius = std::min(radius, value);
    }
  }
  claim.spin_unit = 1 / radius;
  claim.gamma_unit = number_at(source, "time.end", Dimension::time).value_or(1) / radius;

  double frequency =
      number_at(source, "gimbal.servo.natural_frequency", Dimension::angular_rate).value_or(0);
  double damping = number_at(source, "gimbal.servo.damping", Dimension::number).value_or(0);
  if (const file::Column* varied = table.find("gimbal.servo.natural_frequency")) {
    frequency = std::max(frequency, scenario::largest_size(varied->numbers));
  }
  if (const file::Column* varied = table.find("gimbal.servo.damping")) {
    damping = std::max(damping, scenario::largest_size(varied->numbers));
  }
  claim.acceleration_unit = std::max(1.0, frequency * (frequency + 2 * damping));
  return claim;
}

// The column of this name, or of this measure; null if it is not computed from states.
const Column* computed(const std::string& name) {
  const Column* column = find_column(name);
  if (column == nullptr) {
    if (const auto measure = find_measure(name)) column = measure->column;
  }
  if (column == nullptr || column->name == "t" || column->name.ends_with("_reference")) {
    return nullptr;
  }
  return column;
}

// Columns of one kind have errors of one scale.
std::string_view kind_of(const Column& column) {
  if (column.needs == Needs::orientation) return "gamma";  // both are angles of the ball
  return column.name == "spin" || column.name == "gamma" ? column.name : column.unit;
}

double unit_of(const Column& column, const Claim& claim) {
  if (column.name == "spin") return claim.spin_unit;
  if (kind_of(column) == "gamma") return claim.gamma_unit;
  if (column.unit == "rad/s^2") return claim.acceleration_unit;
  return 1;
}

std::string claims_text(const Claim& claim) {
  std::string text;
  if (claim.rtol > 0) {
    text = "rtol " + number_text(claim.rtol) + ", atol " + number_text(claim.atol);
  }
  if (!claim.error_bound) return text;
  return text + (text.empty() ? "" : "; ") + "positions to " + number_text(*claim.error_bound) +
         " m";
}

}  // namespace

std::optional<Allowances> solver_allowances(const file::Table& a, const file::Table& b) {
  const Claim claims[] = {claim_of(a), claim_of(b)};
  std::vector<std::string> texts;
  for (const Claim& claim : claims) {
    const std::string text = claims_text(claim);
    if (!text.empty() && (texts.empty() || texts.back() != text)) texts.push_back(text);
  }
  if (texts.empty()) return {};

  std::map<std::string_view, double> sizes;  // largest values, by kind
  for (const file::Table* table : {&a, &b}) {
    for (const file::Column& of : table->columns) {
      const Column* const column = computed(of.name);
      if (column == nullptr) continue;
      double& size = sizes[kind_of(*column)];
      size = std::max(size, scenario::largest_size(of.numbers));
    }
  }

  Allowances allowances;
  allowances.reason = "100 (rtol size + atol) for each file, by its solver's ";
  for (const std::string& text : texts) {
    allowances.reason += (text == texts.front() ? "" : " and ") + text;
  }
  for (const file::Column& of : a.columns) {
    const Column* const column = computed(of.name);
    if (column == nullptr) continue;
    Allowance& own = allowances.by_column[of.name];
    for (const Claim& claim : claims) {
      if (claim.error_bound && column->unit == "m") {
        own.atol += *claim.error_bound;
      } else {
        own.atol +=
            growth * (claim.rtol * sizes[kind_of(*column)] + claim.atol * unit_of(*column, claim));
      }
    }
  }
  return allowances;
}

}  // namespace bbsim::record
