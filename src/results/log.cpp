// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads logs of real rigs: any CSV, with any names, units and clocks.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "file/clock.hpp"
#include "results/result.hpp"
#include "scenario/columns.hpp"
#include "scenario/log_columns.hpp"
#include "yaml/quantity.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::results {
namespace {

// FACTOR * COLUMN + OFFSET, a number in a unit.
struct Mapped {
  const scenario::Column* column;
  std::size_t from;  // the log's column
  double factor = 1, offset = 0;
  std::optional<yaml::UnitScale> unit{};
};

[[noreturn]] void refuse(std::string_view part, const std::string& what) {
  throw InputError("--map: found " + bbsim::quoted(part, uncut) + what);
}

yaml::UnitScale unit_of(std::string_view part, const scenario::Column& column,
                        std::string_view unit) {
  if (unit == column.unit) return {};
  const yaml::Dimension dimension = yaml::dimension_of(column.unit);
  if (const auto known = scenario::log_unit(unit, dimension)) return *known;
  const yaml::Quantity quantity = yaml::read_quantity("1 " + std::string(unit), false, dimension);
  refuse(part, quantity.fault + ": " + std::string(column.name) + " is in " +
                   std::string(column.unit) + "; allowed: no unit, or a unit of the same quantity");
}

std::string near(std::string_view name, const std::vector<std::string_view>& names) {
  const std::string_view nearest = yaml::nearest_name(name, names);
  return nearest.empty() ? "" : "; did you mean " + std::string(nearest) + "?";
}

// A number; blanks may follow its sign.
std::optional<double> number_of(std::string_view text) {
  text = trimmed(text);
  const bool negative = text.starts_with('-');
  if (negative || text.starts_with('+')) text = trimmed(text.substr(1));
  if (text.starts_with('-') || text.starts_with('+')) return {};
  const auto value = number_in<double>(text);
  if (!value || !std::isfinite(*value)) return {};
  return negative ? -*value : value;
}

const scenario::Column& target_of(std::string_view part, std::string_view name) {
  if (const scenario::Column* const column = scenario::find_column(name)) return *column;
  refuse(part, ": there is no column " + bbsim::quoted(name) +
                   near(name, scenario::column_names()) + "; allowed: those of `bbsim columns`");
}

// Reads one part of a map. A column's name may contain signs, colons and stars: a text that is a
// name counts as the name.
class PartReader {
 public:
  PartReader(std::string_view part, const Result& log)
      : part_(part), log_(log), names_(log.names()) {}

  Mapped read() {
    const std::size_t equals = part_.find('=');
    if (equals == std::string_view::npos || equals == 0) refuse_form();
    map_.column = &target_of(part_, trimmed(part_.substr(0, equals)));
    dimension_ = yaml::dimension_of(map_.column->unit);
    std::string_view from = trimmed(part_.substr(equals + 1));
    if (!is_column(from)) {
      if (const std::size_t colon = from.rfind(':'); colon != std::string_view::npos) {
        map_.unit = unit_of(part_, *map_.column, trimmed(from.substr(colon + 1)));
        from = trimmed(from.substr(0, colon));
      }
      read_sum(from);
    }
    if (!map_.unit) map_.unit = scenario::unit_in_name(names_[map_.from], dimension_);
    return map_;
  }

 private:
  [[noreturn]] void refuse_form() const {
    refuse(part_,
           "; allowed: COLUMN=NAME or COLUMN=NAME:UNIT, such as x=Ballx:mm, or "
           "COLUMN=FACTOR*NAME+OFFSET:UNIT");
  }

  bool is_column(std::string_view name) {
    const auto found = scenario::find_log_column(names_, name, dimension_);
    if (found) map_.from = *found;
    return found.has_value();
  }

  void read_sum(std::string_view text) {
    if (is_column(text)) return;
    if (const std::size_t star = text.find('*'); star != std::string_view::npos) {
      if (const auto factor = number_of(text.substr(0, star))) {
        map_.factor = *factor;
        text = trimmed(text.substr(star + 1));
      }
    } else if (text.starts_with('-')) {
      map_.factor = -1;
      text = trimmed(text.substr(1));
    }
    if (is_column(text)) return;
    std::string_view rest = text;  // without its offset
    for (std::size_t at = text.size(); at-- > 1;) {
      if (text[at] != '+' && text[at] != '-') continue;
      const auto offset = number_of(text.substr(at));
      if (!offset) continue;
      rest = trimmed(text.substr(0, at));
      map_.offset = *offset;
      if (is_column(rest)) return;
    }
    if (rest.empty()) refuse_form();
    std::vector<std::string_view> names(names_.begin(), names_.end());
    std::vector<std::string> known;
    for (const std::string_view name : names) known.push_back(shown(name));
    throw InputError("--map: " + log_.file + " has no column " + bbsim::quoted(rest) +
                     near(rest, names) + "; it has " + joined(known));
  }

  std::string_view part_;
  const Result& log_;
  std::vector<std::string> names_;
  yaml::Dimension dimension_ = yaml::Dimension::number;
  Mapped map_{};
};

std::vector<Mapped> read_maps(const std::vector<std::string>& maps, const Result& log) {
  std::vector<Mapped> all;
  for (const std::string& map : maps) {
    for (const std::string_view part : split(map, ",")) {
      all.push_back(PartReader(part, log).read());
      if (std::ranges::count(all, all.back().column, &Mapped::column) > 1) {
        refuse(part, ": " + std::string(all.back().column->name) + " is given twice");
      }
    }
  }
  return all;
}

void note(Result& log, const std::string& what, const char* kind = "note: ") {
  log.notes.push_back(kind + shown(log.file, uncut) + ": " + what);
}
void warn(Result& log, const std::string& what) {
  note(log, what, "warning: ");
}

// Converts a column of the log to a column of bbsim.
Column column_of(Result& log, const Mapped& mapped) {
  Column column = log.columns[mapped.from];
  const bool is_clock = mapped.column->name == "t";
  const auto stamps = is_clock ? file::read_stamps(column) : std::nullopt;
  if (column.is_text()) file::refuse_text(log.file, column);
  column = {std::string(mapped.column->name), std::move(column.numbers)};
  column.unit = mapped.column->unit;
  if (stamps) {
    warn(log, *stamps);
    return column;
  }
  if (is_clock) {
    if (const auto done = file::unwrap(column.numbers)) warn(log, *done);
  }
  for (double& number : column.numbers) {
    if (mapped.factor != 1) number *= mapped.factor;
    if (mapped.offset != 0) number += mapped.offset;
    if (mapped.unit) number = mapped.unit->in_si(number);
  }
  return column;
}

// Finds columns whose names are bbsim's with a unit beside them, and the clock.
std::vector<Mapped> by_their_names(const Result& log, const std::vector<Mapped>& mapped) {
  std::vector<Mapped> more;
  const std::vector<std::string> names = log.names();
  for (const scenario::Column& column : scenario::catalogue) {
    if (std::ranges::find(mapped, &column, &Mapped::column) != mapped.end()) continue;
    const yaml::Dimension dimension = yaml::dimension_of(column.unit);
    const auto found = scenario::find_log_column(names, column.name, dimension);
    if (!found) continue;
    if (names[*found] == column.name) {
      if (column.name == "t") more.push_back({&column, *found});
    } else {
      more.push_back({&column, *found, 1, 0, scenario::unit_in_name(names[*found], dimension)});
    }
  }
  return more;
}

// The usual names of clocks, with the unit of times without a unit in the name.
struct Usual {
  std::string_view name, unit;
};
constexpr Usual usual_clocks[] = {{"time", "s"},    {"timestamp", "s"}, {"millis", "ms"},
                                  {"micros", "us"}, {"seconds", "s"},   {"datetime", "s"}};

// A clock under one of its usual names, for a log without a column t.
std::optional<Mapped> usual_clock(const Result& log) {
  std::vector<std::string> names = log.names();
  for (std::string& name : names) name = lower(name);
  for (const Usual& usual : usual_clocks) {
    const auto found = scenario::find_log_column(names, usual.name, yaml::Dimension::time);
    if (!found) continue;
    return Mapped{scenario::find_column("t"), *found, 1, 0,
                  scenario::unit_in_name(names[*found], yaml::Dimension::time)};
  }
  return {};
}

// Completes the unit of a clock that has none, and says so, or what the clock is if it is `usual`.
void complete_clock(Result& log, Mapped& clock, bool usual) {
  const Column& column = log.columns[clock.from];
  std::string_view unit;
  if (!clock.unit && clock.factor == 1 && !column.is_text()) {
    const auto* const known = std::ranges::find(usual_clocks, lower(column.name), &Usual::name);
    const std::string_view since_epoch = file::unit_since_epoch(column.numbers);
    unit = known == std::end(usual_clocks) ? "s" : known->unit;
    if (unit == "s" && !since_epoch.empty()) unit = since_epoch;
    clock.unit = scenario::log_unit(unit, yaml::Dimension::time);
  }
  if (!usual && (unit.empty() || unit == "s")) return;
  note(log,
       "t is the column " + shown(column.name) + (unit.empty() ? "" : ", in " + std::string(unit)));
}

double time_of(std::string_view option, const std::string& text, const char* more) {
  const yaml::Quantity quantity = yaml::read_quantity(text, false, yaml::Dimension::time);
  if (quantity.value) return *quantity.value;
  throw InputError(std::string(option) + ": found " + bbsim::quoted(text) + quantity.fault +
                   "; allowed: a time, such as 0.1 or \"100 ms\"" + more);
}

void add_clock(Result& log, const std::string& period) {
  if (period.empty()) return;
  if (log.find("t") != nullptr) {
    throw InputError("--period: " + log.file +
                     " has a column t; allowed: --period for rows without a clock");
  }
  const double seconds = time_of("--period", period, "");
  if (!(seconds > 0)) throw InputError("--period: found " + period + "; allowed: more than 0 s");
  Column t{"t", {}};
  t.unit = "s";
  for (std::size_t row = 0; row < log.rows; ++row) {
    t.numbers.push_back(static_cast<double>(row) * seconds);
  }
  log.columns.insert(log.columns.begin(), std::move(t));
}

void keep_rows(Result& log, const std::vector<std::size_t>& rows) {
  for (Column& column : log.columns) column.keep(rows);
  log.rows = rows.size();
}

// The rows in which a column of positions has the number that stands for "not seen", before it is
// mapped. Empty if the user names none.
std::vector<bool> missing_rows(const Result& log, const LogChoice& choice,
                               const std::vector<Mapped>& mapped) {
  if (choice.missing.empty()) return {};
  const std::optional<double> missing = number_of(choice.missing);
  if (!missing) {
    throw InputError("--missing: found " + bbsim::quoted(choice.missing) +
                     "; allowed: the number that the log has where it does not see the ball, such "
                     "as -1");
  }
  std::vector<bool> rows(log.rows);
  const auto look = [&](const Column& column) {
    for (std::size_t row = 0; row < log.rows; ++row) {
      rows[row] = rows[row] || column.numbers[row] == *missing;
    }
  };
  const auto is_position = [](std::string_view unit) { return unit == "m"; };
  for (const Mapped& map : mapped) {
    if (is_position(map.column->unit)) look(log.columns[map.from]);
  }
  for (const Column& column : log.columns) {
    const scenario::Column* const known = scenario::find_column(column.name);
    const bool is_mapped = std::ranges::any_of(
        mapped, [&](const Mapped& map) { return map.column->name == column.name; });
    if (known != nullptr && !is_mapped && is_position(known->unit)) look(column);
  }
  return rows;
}

void leave_out(Result& log, const std::vector<bool>& rows, const std::string& missing) {
  std::vector<std::size_t> kept;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (!rows[row]) kept.push_back(row);
  }
  const std::size_t count = rows.size() - kept.size();
  if (count == 0) return;
  const auto first = static_cast<std::size_t>(std::ranges::find(rows, true) - rows.begin());
  keep_rows(log, kept);
  note(log, counted(count, "row") + (count == 1 ? " has" : " have") + " a position of " + missing +
                ", first in row " + std::to_string(first + 1) + "; left out (--missing)");
}

void set_clock(Result& log, const LogChoice& choice) {
  Column* const t = log.find("t");
  if (t == nullptr || t->is_text()) {
    if (choice.time_offset.empty()) return;
    throw InputError("--time-offset: " + without_clock(log));
  }
  const file::Clock clock = file::clock_of(t->numbers);
  if (clock.restart) {
    const std::size_t row = *clock.restart;
    throw InputError(log.file + ": its clock starts again in row " + std::to_string(row + 1) +
                     ": t falls to " + number_text(t->numbers[row]) +
                     " s; split the file there, or remove the column t and use --period");
  }
  for (const std::string& done : clock.done) warn(log, done);
  if (!clock.done.empty()) keep_rows(log, clock.rows);
  if (t->numbers.empty()) return;
  double offset = 0;
  if (choice.time_offset == "start") {
    offset = -t->numbers.front();
  } else if (!choice.time_offset.empty() && !choice.aligns()) {
    offset = time_of("--time-offset", choice.time_offset, ", start, or auto");
  } else if (file::counts_from_epoch(t->numbers)) {
    offset = -t->numbers.front();
    warn(log, "its times count from an epoch (" + number_text(t->numbers.front()) +
                  " s); the first row is t = 0");
  }
  if (offset == 0) return;
  for (double& time : t->numbers) time += offset;
}

}  // namespace

std::string without_clock(const Result& log) {
  std::vector<std::string> names;
  for (const Column& column : log.columns) {
    names.push_back((column.is_text() ? "the text " : "") + shown(column.name));
  }
  return log.file + " has no column t with numbers; it has " + joined(names) +
         "; --map t=NAME:UNIT names it, --period gives the rows one";
}

void make_log(Result& log, const LogChoice& choice, bool only_mapped) {
  std::vector<Mapped> mapped = read_maps(choice.maps, log);
  const auto is_clock = [](const Mapped& map) { return map.column->name == "t"; };
  const bool maps = !mapped.empty();
  // A map of the clock alone says nothing about the other columns.
  only_mapped = only_mapped && !std::ranges::all_of(mapped, is_clock);
  for (Mapped& map : by_their_names(log, mapped)) {
    const bool is_time = map.column->name == "t";
    if (is_time && !choice.period.empty()) continue;  // add_clock() refuses t
    if (!only_mapped || is_time) mapped.push_back(map);
  }
  const auto clock = std::ranges::find_if(mapped, is_clock);
  if (clock != mapped.end()) {
    complete_clock(log, *clock, false);
  } else if (choice.period.empty()) {
    if (auto usual = usual_clock(log)) {
      complete_clock(log, *usual, true);
      mapped.push_back(*usual);
    }
  }
  const std::vector<bool> missing = missing_rows(log, choice, mapped);
  std::vector<Column> columns;
  for (const Mapped& map : mapped) {
    columns.push_back(column_of(log, map));
    log.raw.push_back(log.columns[map.from].name);
  }
  if (only_mapped) log.columns.clear();
  for (Column& column : columns) {
    Column* const there = log.find(column.name);
    if (there != nullptr) {
      const bool is_unit_known = maps || !there->unit.empty();
      if (!is_unit_known) column.unit = there->unit;  // it may not be in SI units
      *there = std::move(column);
    } else {
      log.columns.push_back(std::move(column));
    }
  }
  add_clock(log, choice.period);
  leave_out(log, missing, choice.missing);
  set_clock(log, choice);
}

Result read_log(const std::string& file, const LogChoice& choice, bool only_mapped) {
  Result log = read_columns(file, choice.header);
  make_log(log, choice, only_mapped);
  return log;
}

void refuse_auto(const LogChoice& choice) {
  if (!choice.aligns()) return;
  throw InputError(
      "--time-offset: found \"auto\", which needs a run; allowed here: a time or start, and auto "
      "in `bbsim compare` and `bbsim replay`");
}

}  // namespace bbsim::results
