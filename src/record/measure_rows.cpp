#include "record/measure_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "record/curve.hpp"
#include "record/instants.hpp"
#include "record/square_sum.hpp"

namespace bbsim::record {

using scenario::Column;
using scenario::Measure;
using Kind = Measure::Kind;

StoredRun::StoredRun(file::TableData table, const std::string& name)
    : name_(name), table_(std::move(table)) {
  for (const std::string& column : table_.names) {
    const Column* const known = scenario::find_column(column);
    columns_.push_back(known != nullptr ? *known
                                        : Column{column, "", column, scenario::Needs::ball});
    columns_.back().name = column;
  }
  const Column* const t = find("t");
  if (t == nullptr) {
    throw InputError(name_ + ": has no column t; allowed: the result of a run, with its times");
  }
  times_ = &values_of(*t);
  if (times_->empty()) throw InputError(name_ + ": has no rows; allowed: at least one");
  for (std::size_t i = 0; i < times_->size(); ++i) {
    if (std::isfinite((*times_)[i]) && (i == 0 || (*times_)[i] >= (*times_)[i - 1])) continue;
    throw InputError(name_ + ": column t, row " + std::to_string(i + 1) + ": found " +
                     number_text((*times_)[i]) + "; allowed: a finite number, not before the last");
  }
}

const Column* StoredRun::find(std::string_view name) const {
  const auto found = std::ranges::find(columns_, name, &Column::name);
  return found == columns_.end() ? nullptr : &*found;
}

const std::vector<double>& StoredRun::values_of(const Column& column) const {
  return table_.columns[static_cast<std::size_t>(&column - columns_.data())];
}

std::vector<Measure> StoredRun::measures_named(const std::vector<std::string>& names) const {
  std::vector<Measure> measures;
  for (const std::string& name : names) {
    const auto measure =
        scenario::find_measure(name, [this](std::string_view column) { return find(column); });
    if (!measure) {
      std::string columns;
      for (const std::string& column : table_.names) columns += " " + column;
      const std::vector<std::string_view> known(table_.names.begin(), table_.names.end());
      throw InputError("measure: found " + name + scenario::measure_hint(name, known) + "; " +
                       name_ + " has the columns" + columns +
                       "; allowed: " + scenario::allowed_measures());
    }
    for (const Measure& other : measures) {
      if (other.name == measure->name) throw InputError("measure: found " + name + " twice");
    }
    measures.push_back(*measure);
  }
  return measures;
}

double StoredRun::value_of(const Measure& measure) const {
  const std::vector<double>& values = values_of(*measure.column);
  if (measure.kind == Kind::end) return values.back();
  if (!is_of_curves(measure)) {
    SquareSum squares;
    std::size_t rows = 0;
    double least = std::numeric_limits<double>::infinity(), greatest = -least;
    for (const double value : values) {
      if (std::isnan(value)) continue;
      squares.add(value);
      ++rows;
      least = std::min(least, value);
      greatest = std::max(greatest, value);
    }
    if (rows == 0) return std::numeric_limits<double>::quiet_NaN();
    if (measure.kind == Kind::rms) return squares.root_mean(rows);
    return measure.kind == Kind::least ? least : greatest;
  }
  std::map<const Column*, Curve> curves;
  return measured(measure, [&](const Column& column) -> const Curve& {
    const auto [found, is_new] = curves.try_emplace(&column);
    if (is_new) {
      const std::vector<double>& of = values_of(column);
      Curve& curve = found->second;
      if (of.size() == 1) curve.add_line(times_->front(), times_->front(), of[0], of[0]);
      for (std::size_t i = 1; i < of.size(); ++i) {
        curve.add_line((*times_)[i - 1], (*times_)[i], of[i - 1], of[i]);
      }
    }
    return found->second;
  });
}

}  // namespace bbsim::record
