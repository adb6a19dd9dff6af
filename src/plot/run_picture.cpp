// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/run_picture.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "base/error.hpp"
#include "plot/run_parts.hpp"
#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr double left_axis = 78, left_end = 560, right_axis = 668, right_margin = 25;
constexpr double below_panel = 56;  // tic labels and axis label
constexpr std::size_t path_rows = 4;

// Panels in one or two columns. The second column is beside the path, if there is one.
struct Layout {
  bool path = false;
  std::size_t left = 0, right = 0;
  double pitch = 122;
  double width = 1200;
};

Layout lay_out(bool path, std::size_t panels) {
  const auto share = [panels](double whole, double least) {
    return std::max(whole / static_cast<double>(std::max<std::size_t>(panels, 1)), least);
  };
  if (path && panels == 0) return {true, 0, 0, 520, left_end + right_margin};
  if (path && panels < 6) return {true, 0, panels, share(520, 116)};
  const std::size_t right = path ? (panels + path_rows + 1) / 2 : panels / 2;
  if (path || panels > 6) return {path, panels - right, right};
  return {false, panels, 0, share(panels == 1 ? 360 : 440, 150), 900};
}

std::string status_text(const Result& run) {
  if (run.status.empty() || run.status == "done") return "";
  std::string text = run.status;
  if (run.end_time) text += " at t = " + number(*run.end_time, 6) + " s";
  if (run.status == "stopped" && !run.events.empty()) text += ": " + run.events.back().name;
  return text;
}

// The name of a run in a comparison: its file, with the folder if several files share a name.
std::string label_of(const std::vector<Result>& runs, const Result& run) {
  const auto same = std::ranges::count(runs, run.shown_file(), &Result::shown_file);
  const std::string status = status_text(run);
  return (same > 1 ? run.file : run.shown_file()) + (status.empty() ? "" : ", " + status);
}

void add_titles(Picture& picture, const std::vector<Result>& runs) {
  const Result& first = runs.front();
  if (std::ranges::count(runs, first.title, &Result::title) == std::ssize(runs)) {
    picture.title = first.title;
  }
  if (runs.size() > 1) {
    for (const Result& run : runs) {
      picture.legend.push_back({label_of(runs, run), stroke_of_run(runs, run)});
    }
    return;
  }
  picture.subtitle = first.shown_file();
  if (picture.title.empty()) std::swap(picture.title, picture.subtitle);
  const std::string status = status_text(first);
  if (!status.empty()) picture.subtitle += (picture.subtitle.empty() ? "" : ", ") + status;
}

}  // namespace

std::vector<double> Abscissa::of(const Result& run) const {
  std::vector<double> values(run.rows);
  for (std::size_t i = 0; i < run.rows; ++i) {
    values[i] = scale(is_time ? run.find("t")->numbers[i] : static_cast<double>(i));
  }
  return values;
}

Abscissa abscissa_of(const std::vector<Result>& runs) {
  Abscissa abscissa;
  abscissa.is_time = std::ranges::all_of(runs, [](const Result& run) {
    const Column* const t = run.find("t");
    return t != nullptr && !t->is_text();
  });
  Range range;
  for (const Result& run : runs) {
    if (abscissa.is_time) {
      range.include(run.find("t")->numbers);
      for (const Event& event : run.events) range.include(event.t);
    } else {
      range.include(Range{0, static_cast<double>(run.rows - 1)});
    }
  }
  abscissa.scale = choose_scale(abscissa.is_time ? unit_of(runs, "t") : Unit{}, range);
  abscissa.range = abscissa.scale(range);
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
  return static_cast<std::size_t>(std::ranges::find(kinds_, name, &Kind::name) - kinds_.begin());
}

Stroke EventMarks::stroke_of(const Result& run, const std::string& event) const {
  constexpr std::array shapes = {Marker::triangle, Marker::diamond, Marker::filled_square,
                                 Marker::square, Marker::plus};
  const std::string colour = runs_.size() == 1 ? "#d55e00" : stroke_of_run(runs_, run).colour;
  return {colour, 0, Dash::solid, shapes[index_of(event) % shapes.size()], 1.3};
}

std::vector<LegendEntry> EventMarks::legend() const {
  std::vector<LegendEntry> entries;
  for (const Kind& kind : kinds_) {
    Stroke stroke = stroke_of(runs_.front(), kind.name);
    if (runs_.size() > 1) stroke.colour = "#000000";
    std::string text = kind.name;
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
  const std::size_t rows_above = !path ? 0 : layout.left > 0 ? path_rows : 1;
  const auto height = [&](std::size_t rows) { return static_cast<double>(rows) * layout.pitch; };
  Picture picture;
  picture.width = layout.width;
  picture.height = height(std::max(layout.right, layout.left + rows_above)) + below_panel;
  add_titles(picture, runs);
  const Abscissa abscissa = abscissa_of(runs);
  const EventMarks marks(runs);
  if (path) {
    const double room = layout.left > 0 ? height(path_rows) - 44 : picture.height - below_panel - 6;
    add_path(picture, runs, marks, {left_axis, 27, left_end, std::min(room, 560.0)});
  }
  for (const LegendEntry& entry : marks.legend()) picture.legend.push_back(entry);

  const bool two_columns = path || layout.right > 0;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    // If there is a path, panels fill the right column first.
    const bool at_right = path ? p < layout.right : p >= layout.left;
    const std::size_t in_column = path == at_right ? p : p - (path ? layout.right : layout.left);
    const double y = height(in_column + (at_right ? 0 : rows_above));
    const double end = at_right || !two_columns ? layout.width - right_margin : left_end;
    const Box box{at_right ? right_axis : left_axis, y + 27, end, y + layout.pitch - 6};
    const bool lowest = in_column + 1 == (at_right ? layout.right : layout.left);
    picture.panels.push_back(time_panel(runs, panels[p], abscissa, marks, box, lowest));
  }
  return picture;
}

}  // namespace bbsim::plot
