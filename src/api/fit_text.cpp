// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/fit_text.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

#include "api/version.hpp"
#include "base/fnv1a.hpp"
#include "base/json.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "base/short_number.hpp"
#include "file/whole_file.hpp"
#include "fit/free_key.hpp"
#include "record/aligned.hpp"
#include "scenario/edit_text.hpp"

namespace bbsim::api {
namespace {

using Json = nlohmann::ordered_json;

// Shows as many digits as the standard deviation justifies.
std::string with_digits_of(double value, double sd) {
  if (!std::isfinite(sd) || sd <= 0 || value == 0) return short_number(value);
  const double digits = std::ceil(std::log10(std::abs(value) / sd)) + 2;
  return rounded(value, static_cast<int>(std::min(std::max(digits, 2.0), 12.0)));
}

}  // namespace

std::vector<std::vector<std::string>> parameter_table(const fit::Fitted& fitted) {
  std::vector<std::vector<std::string>> lines{
      {"key", "before", "estimate", "sd", "95 % from", "to", "unit"}};
  for (const fit::Parameter& one : fitted.parameters) {
    const auto number = [&](double value) {
      return one.told ? with_digits_of(value, one.sd) : std::string("-");
    };
    lines.push_back({one.key, short_number(one.start), with_digits_of(one.estimate, one.sd),
                     one.told ? record::rounded(one.sd) : "-", number(one.low), number(one.high),
                     record::unit_or_one(one.unit)});
  }
  return lines;
}

std::vector<std::vector<std::string>> residual_table(const fit::Fitted& fitted) {
  const bool has_ideal = std::ranges::any_of(
      fitted.columns, [](const auto& column) { return column.ideal || column.held_ideal; });
  const auto number = [](const std::optional<double>& rms) {
    return rms ? record::rounded(*rms) : std::string("-");
  };
  std::vector<std::vector<std::string>> lines{{"rms residual"}};
  std::vector<std::string>& head = lines.front();
  if (has_ideal) head.emplace_back("ideal rig");
  head.insert(head.end(), {"before", "fitted"});
  if (fitted.held > 0) {
    if (has_ideal) head.emplace_back("held out: ideal rig");
    head.insert(head.end(), {has_ideal ? "before" : "held out: before", "fitted"});
  }
  head.emplace_back("unit");
  for (const fit::ColumnResidual& column : fitted.columns) {
    std::vector<std::string> line{column.column};
    if (has_ideal) line.push_back(number(column.ideal));
    line.insert(line.end(), {record::rounded(column.before), record::rounded(column.rms)});
    if (fitted.held > 0) {
      if (has_ideal) line.push_back(number(column.held_ideal));
      line.push_back(number(column.held_before));
      line.push_back(number(column.held));
    }
    line.push_back(record::unit_or_one(column.unit));
    lines.push_back(std::move(line));
  }
  return lines;
}

namespace {

// Keys that correlate with another one, in one line.
std::string correlations_text(const fit::Fitted& fitted) {
  std::vector<std::string> names;
  double largest = 0;
  for (std::size_t i = 0; i < fitted.parameters.size(); ++i) {
    double most = 0;
    for (std::size_t k = 0; k < fitted.parameters.size(); ++k) {
      if (k != i) most = std::fmax(most, std::abs(fitted.correlations[i][k]));
    }
    if (most <= 0.95) continue;
    names.push_back(fitted.parameters[i].key);
    largest = std::fmax(largest, most);
  }
  if (names.empty()) return "";
  std::string text = "note: ";
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text + " are correlated, up to " + rounded(largest, 4) +
         ": the logs determine a combination of them better than each\n";
}

std::string hash_of(const std::string& file) {
  char text[24];
  std::snprintf(text, sizeof text, "%016llx",
                static_cast<unsigned long long>(fnv1a(file::read_whole(file))));
  return text;
}

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace

std::string report_of(const FitRequest& request, const fit::Fitted& fitted) {
  return record::aligned(parameter_table(fitted)) + "\n" + record::aligned(residual_table(fitted)) +
         "\n" + remarks_of(request, fitted);
}

std::string remarks_of(const FitRequest& request, const fit::Fitted& fitted) {
  std::string text = std::to_string(fitted.numbers) + " numbers in " +
                     std::to_string(fitted.windows) +
                     (fitted.windows == 1 ? " window" : " windows");
  if (std::isfinite(fitted.window)) text += " of " + short_number(fitted.window) + " s";
  if (fitted.joints) {
    text += ", joined at " + std::to_string(*fitted.joints) +
            (*fitted.joints == 1 ? " joint" : " joints");
  }
  if (fitted.held > 0) text += ", " + std::to_string(fitted.held) + " more held out";
  text += "; " + std::to_string(request.logs.size()) +
          (request.logs.size() == 1 ? " log\n" : " logs\n");
  for (const std::string& words : fitted.untold) text += "not identifiable: " + words + "\n";
  for (const fit::Parameter& one : fitted.parameters) {
    if (one.at_bound) text += "note: " + one.key + " is at a bound of its range\n";
  }
  text += correlations_text(fitted);
  for (const fit::ColumnResidual& column : fitted.columns) {
    if (column.outliers == 0) continue;
    text += "note: " + std::to_string(column.outliers) +
            (column.outliers == 1 ? " number of " : " numbers of ") + column.column +
            (column.outliers == 1 ? " is" : " are") +
            " beyond 5 standard deviations, the first at t = " + short_number(column.outlier_time) +
            " s of " + shown(column.outlier_log) +
            (request.loss == "huber" ? "\n" : "; --loss huber gives such numbers less weight\n");
  }
  if (fitted.interrupted) {
    text += "note: interrupted after " + std::to_string(fitted.iterations) +
            (fitted.iterations == 1 ? " iteration" : " iterations") +
            ": these are the best values so far\n";
  }
  if (!fitted.white) {
    text += "note: neighboring residuals are correlated (";
    bool first = true;
    for (const fit::ColumnResidual& column : fitted.columns) {
      text += (first ? "" : ", ") + column.column + ": " + rounded(column.correlation, 2);
      first = false;
    }
    text += "); the model is incomplete and the intervals are too short\n";
    if (const auto& one = fitted.suggestion) {
      text += "note: --free " + one->key + " could make the residuals about " +
              rounded(100 * one->share, 2) + " % smaller\n";
    }
  }
  return text;
}

std::string json_of(const fit::Fitted& fitted) {
  Json json;
  json["parameters"] = Json::array();
  for (const fit::Parameter& one : fitted.parameters) {
    json["parameters"].push_back(
        {{"key", one.key},
         {"estimate", one.estimate},
         {"sd", number_or_null(one.sd)},
         {"interval", {number_or_null(one.low), number_or_null(one.high)}}});
  }
  json["residual_rms"] = Json::object();
  json["hold_out_rms"] = Json::object();
  for (const fit::ColumnResidual& column : fitted.columns) {
    json["residual_rms"][column.column] = column.rms;
    if (column.held) json["hold_out_rms"][column.column] = *column.held;
  }
  for (const fit::ColumnResidual& column : fitted.columns) {
    if (column.ideal) json["ideal_rms"][column.column] = *column.ideal;
    if (column.held_ideal) json["hold_out_ideal_rms"][column.column] = *column.held_ideal;
  }
  json["identifiable"] = fitted.untold.empty();
  json["correlations"] = Json::array();
  for (const std::vector<double>& row : fitted.correlations) {
    Json line = Json::array();
    for (const double one : row) line.push_back(number_or_null(one));
    json["correlations"].push_back(std::move(line));
  }
  json["white"] = fitted.white;
  if (const auto& one = fitted.suggestion) {
    json["suggestion"] = {{"key", one->key}, {"residuals_smaller_by", one->share}};
  }
  json["outliers"] = Json::object();
  for (const fit::ColumnResidual& column : fitted.columns) {
    json["outliers"][column.column] = column.outliers;
  }
  if (fitted.joints) json["joints"] = *fitted.joints;
  if (fitted.interrupted) json["interrupted"] = true;
  return json_text(json, 2) + '\n';
}

std::string fitted_scenario(const FitRequest& request, const fit::Fitted& fitted) {
  const Source& source = request.family.source();
  std::string text = "# Fitted by bbsim " + std::string(version()) + " to\n";
  for (const std::string& log : request.logs) {
    text += "#   " + shown(log) + " (FNV-1a " + hash_of(log) + ")\n";
  }
  for (const fit::Parameter& one : fitted.parameters) {
    const std::string unit = one.unit.empty() ? "" : " " + one.unit;
    text += "# " + one.key + ": " + with_digits_of(one.estimate, one.sd) + unit;
    text += one.told ? ", 95 % from " + with_digits_of(one.low, one.sd) + " to " +
                           with_digits_of(one.high, one.sd) + unit + "; was " +
                           short_number(one.start) + unit + "\n"
                     : ", which the logs do not determine\n";
  }
  std::vector<ScenarioFamily::Setting> settings;
  for (const fit::Parameter& one : fitted.parameters) {
    if (fit::is_of_log(one.key)) continue;  // no scenario has it
    const std::string unit = one.unit.empty() ? "" : " " + one.unit;
    settings.push_back({one.key, number_text(one.estimate) + unit});
  }
  return edited_scenario(source, text, std::move(settings));
}

}  // namespace bbsim::api
