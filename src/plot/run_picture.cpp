// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/run_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "plot/run_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr double sheet_width = 1200, narrow_sheet_width = 900;
constexpr double bottom_margin = 56;  // tics, and what they are of
constexpr double left_axis = 78, left_end = 560, right_axis = 668, right_margin = 25;
constexpr std::size_t path_rows = 4;

// Where panels go: a column beside the path, and when that is long, below the path too.
struct Layout {
  bool path = false;
  std::size_t right = 0, left = 0;  // panels in each column; without two columns all are at left
  double pitch = 0;
  double width = sheet_width;

  [[nodiscard]] double height() const { return static_cast<double>(rows()) * pitch; }
  [[nodiscard]] std::size_t rows() const {
    return std::max(right, left + (path && left > 0 ? path_rows : path ? 1 : 0));
  }
};

Layout lay_out(bool path, std::size_t panels) {
  Layout layout;
  layout.path = path;
  if (path && panels < 6) {
    layout.right = panels;
    const std::array<double, 6> pitches = {520, 520, 260, 173, 130, 116};
    layout.pitch = pitches[panels];
    if (panels == 0) layout.width = left_end + right_margin;
  } else if (path) {
    layout.right = (panels + path_rows + 1) / 2;
    layout.left = panels - layout.right;
    layout.pitch = 122;
  } else if (panels <= 6) {
    layout.left = panels;
    layout.width = narrow_sheet_width;
    layout.pitch = panels == 1 ? 360 : panels == 2 ? 220 : 150;
  } else {
    layout.left = (panels + 1) / 2;
    layout.right = panels - layout.left;
    layout.pitch = 122;
  }
  return layout;
}

std::string status_text(const Result& run) {
  if (run.status.empty() || run.status == "done") return "";
  std::string text = run.status;
  if (run.end_time) text += " at t = " + number(*run.end_time, 6) + " s";
  if (run.status == "stopped" && !run.events.empty()) text += ": " + run.events.back().name;
  return text;
}

// Names of runs in a comparison: of the files, with their folders if the files have one name.
std::vector<std::string> labels_of(const std::vector<Result>& runs) {
  std::vector<std::string> names;
  for (const Result& run : runs) {
    const auto same = std::ranges::count_if(
        runs, [&](const Result& other) { return other.shown_file() == run.shown_file(); });
    const std::string status = status_text(run);
    names.push_back((same > 1 ? run.file : run.shown_file()) +
                    (status.empty() ? "" : ", " + status));
  }
  return names;
}

// Title, subtitle or legend of the runs; where the panels begin.
double add_top(Picture& picture, const std::vector<Result>& runs) {
  const Result& first = runs.front();
  const bool one_title =
      std::ranges::all_of(runs, [&](const Result& run) { return run.title == first.title; });
  std::string title = one_title ? clean(first.title) : "";
  if (runs.size() == 1) {
    std::string subtitle = clean(first.shown_file());
    if (title.empty()) std::swap(title, subtitle);
    const std::string status = status_text(first);
    if (!status.empty()) subtitle += (subtitle.empty() ? "" : ", ") + status;
    return add_heading(picture, title, subtitle, {});
  }
  std::vector<Entry> legend;
  const std::vector<std::string> names = labels_of(runs);
  for (std::size_t r = 0; r < runs.size(); ++r) {
    legend.push_back({names[r], stroke_of_run(runs, runs[r])});
  }
  return add_heading(picture, title, "", legend);
}

}  // namespace

std::vector<double> Abscissa::of(const Result& run) const {
  std::vector<double> values;
  if (const Column* t = is_time ? run.find("t") : nullptr) {
    values = t->numbers;
  } else {
    for (std::size_t i = 0; i < run.rows; ++i) values.push_back(static_cast<double>(i));
  }
  for (double& value : values) value = scale(value);
  return values;
}

Abscissa abscissa_of(const std::vector<Result>& runs) {
  Abscissa abscissa;
  for (const Result& run : runs) {
    const Column* const t = run.find("t");
    abscissa.is_time = abscissa.is_time && t != nullptr && !t->is_text();
  }
  for (const Result& run : runs) {
    if (!abscissa.is_time) {
      abscissa.range.include(0);
      abscissa.range.include(static_cast<double>(run.rows - 1));
      continue;
    }
    abscissa.range.include(run.find("t")->numbers);
    for (const Event& event : run.events) abscissa.range.include(event.t);
  }
  abscissa.scale = choose_scale(abscissa.is_time ? unit_of(runs, "t") : Unit{}, abscissa.range);
  return abscissa;
}

EventMarks::EventMarks(const std::vector<Result>& runs) : runs_(runs) {
  for (const Result& run : runs) {
    for (const Event& event : run.events) {
      const std::size_t index = index_of(event.name);
      if (index == kinds_.size()) kinds_.push_back({event.name});
      ++kinds_[index].times;
      kinds_[index].stopped = kinds_[index].stopped || event.stopped;
    }
  }
}

std::size_t EventMarks::index_of(const std::string& name) const {
  const auto found = std::ranges::find(kinds_, name, &Kind::name);
  return static_cast<std::size_t>(found - kinds_.begin());
}

Stroke EventMarks::stroke_of(const Result& run, const Event& event) const {
  constexpr std::array shapes = {Marker::triangle, Marker::diamond, Marker::filled_square,
                                 Marker::square, Marker::plus};
  const std::string colour = runs_.size() == 1 ? "#d55e00" : stroke_of_run(runs_, run).colour;
  return {colour, 1, Dash::dotted, shapes[index_of(event.name) % shapes.size()], 1.3};
}

std::vector<Entry> EventMarks::legend() const {
  std::vector<Entry> entries;
  for (const Kind& kind : kinds_) {
    Stroke stroke = stroke_of(runs_.front(), {kind.name});
    stroke.width = 0;
    if (runs_.size() > 1) stroke.colour = "#000000";
    std::string text = clean(kind.name);
    if (kind.times > 1) text += ", " + std::to_string(kind.times) + " times";
    if (kind.stopped && runs_.size() == 1) text += " (stops)";
    entries.push_back({text, stroke});
  }
  return entries;
}

Stroke stroke_of_run(const std::vector<Result>& runs, const Result& run) {
  return stroke_of(static_cast<std::size_t>(&run - runs.data()));
}

Picture run_picture(const std::vector<Result>& runs, const Asked& asked) {
  Asked columns = asked;
  const bool path_asked = std::erase(columns, std::vector<std::string>{"path"}) > 0;
  if (path_asked && !has_path(runs)) {
    throw InputError("--columns: found path; " + runs.front().file + " has no numbers x and y");
  }
  const std::vector<PlannedPanel> panels =
      asked.empty() ? plan_panels(runs) : plan_panels(runs, columns);
  const bool path =
      asked.empty() ? has_path(runs) && (panels.empty() || !is_along_an_axis(runs)) : path_asked;
  if (panels.empty() && !path) {
    throw InputError(runs.front().file + ": nothing to draw: no column but t holds finite numbers");
  }

  const Layout layout = lay_out(path, panels.size());
  Picture picture;
  picture.width = layout.width;
  const double top = add_top(picture, runs);
  picture.height = top + layout.height() + bottom_margin;
  const Abscissa abscissa = abscissa_of(runs);
  const EventMarks marks(runs);
  if (path) {
    const double rows = layout.left > 0 ? path_rows * layout.pitch - 44 : layout.height() - 6;
    add_path(picture, runs, marks, {left_axis, top, left_end, top + std::min(rows, 560.0)});
  }

  const bool two_columns = path || layout.right > 0;
  const double end = layout.width - right_margin;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    // Beside a path the right column is the first one.
    const bool at_right = path ? p < layout.right : p >= layout.left;
    const std::size_t in_column = path == at_right ? p : p - (path ? layout.right : layout.left);
    const std::size_t row = in_column + (path && !at_right ? path_rows : 0);
    const bool lowest = in_column + 1 == (at_right ? layout.right : layout.left);
    const double y = top + static_cast<double>(row) * layout.pitch;
    const Box box{at_right ? right_axis : left_axis, y + 27,
                  at_right || !two_columns ? end : left_end, y + layout.pitch - 6};
    add_time_panel(picture, runs, panels[p], abscissa, marks, box, lowest);
    if (!lowest) continue;
    add_axis_label(picture, box, abscissa.scale.heading(abscissa.is_time ? "t" : "row"));
  }
  return picture;
}

}  // namespace bbsim::plot
