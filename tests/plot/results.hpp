// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Results for tests, and checks of the resulting pictures.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "file/external.hpp"
#include "plot/picture.hpp"
#include "plot/script.hpp"
#include "results/result.hpp"
#include "support/svg_texts.hpp"

namespace bbsim_test {

using Function = std::function<double(double)>;

// A run with `rows` rows from 0 to `end`; each column is a function of time.
inline bbsim::results::Result run_of(const std::vector<std::pair<std::string, Function>>& columns,
                                     double end = 10, std::size_t rows = 101) {
  bbsim::results::Result run;
  run.file = "run.csv";
  run.rows = rows;
  run.columns.push_back({"t", {}});
  for (const auto& [name, value] : columns) run.columns.push_back({name, {}});
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = end * static_cast<double>(i) / static_cast<double>(rows - 1);
    run.columns[0].numbers.push_back(t);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      run.columns[c + 1].numbers.push_back(columns[c].second(t));
    }
  }
  return run;
}

// gnuplot's SVG of a picture, preceded by its complaints.
inline std::string svg_of(const bbsim::plot::Picture& picture) {
  using namespace bbsim::plot;
  const std::string script =
      gnuplot_script(picture, Format::svg, [](std::uint32_t) { return true; });
  const auto drawn = bbsim::file::run_program({"gnuplot", "--default-settings", "-"}, script, "");
  return drawn && drawn->well() ? drawn->complaint + drawn->output : "gnuplot failed";
}

// Collisions in gnuplot's picture (svg_texts.hpp), and gnuplot's complaints.
inline std::string collisions(const bbsim::plot::Picture& picture) {
  const std::string svg = svg_of(picture);
  return svg.substr(0, svg.find("<?xml")) + collisions_in(svg);
}

// Whether the picture contains this text.
inline bool says(const bbsim::plot::Picture& picture, const std::string& text) {
  const auto named = [&](const std::vector<bbsim::plot::LegendEntry>& legend) {
    return std::ranges::find(legend, text, &bbsim::plot::LegendEntry::name) != legend.end();
  };
  return picture.title == text || picture.subtitle == text || named(picture.legend) ||
         std::ranges::any_of(picture.panels, [&](const bbsim::plot::Panel& panel) {
           return panel.heading == text || panel.x.label == text || panel.y.label == text ||
                  named(panel.legend);
         });
}

}  // namespace bbsim_test
