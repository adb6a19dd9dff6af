// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Results as tests need them, and what a reader of a picture would object to.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "plot/picture.hpp"
#include "plot/result.hpp"
#include "plot/text.hpp"

namespace bbsim_test {

using Function = std::function<double(double)>;

// A run over `rows` rows from 0 to `end`, a column a function of time.
inline bbsim::plot::Result run_of(const std::vector<std::pair<std::string, Function>>& columns,
                                  double end = 10, std::size_t rows = 101) {
  bbsim::plot::Result run;
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

// Where something is written, in pixels.
struct Written {
  std::string text;
  double left, right, top, bottom;
};

// All texts of a picture: words, and the labels of tics as the terminals set them.
inline std::vector<Written> all_texts(const bbsim::plot::Picture& picture) {
  using namespace bbsim::plot;
  std::vector<Written> texts;
  const auto add = [&texts](const std::string& text, double left, double y, double size) {
    const double width = width_of(text, size);
    texts.push_back({text, left, left + width, y - 0.4 * size, y + 0.4 * size});
  };
  for (const Words& words : picture.words) {
    const double width = width_of(words.text, words.size);
    if (words.upwards) {
      texts.push_back({words.text, words.x - 0.4 * words.size, words.x + 0.4 * words.size,
                       words.y - width / 2, words.y + width / 2});
      continue;
    }
    const double part = words.align == Words::Align::left     ? 0
                        : words.align == Words::Align::centre ? 0.5
                                                              : 1;
    add(words.text, words.x - part * width, words.y, words.size);
  }
  constexpr double size = 13, gap = 9;
  for (const Panel& panel : picture.panels) {
    for (const Tic& tic : panel.x.tics) {
      if (tic.label.empty()) continue;
      const double x = panel.box.left + panel.box.width() * panel.x.fraction(tic.at);
      add(tic.label, x - width_of(tic.label, size) / 2, panel.box.bottom + 18, size);
    }
    for (const Tic& tic : panel.y.tics) {
      if (tic.label.empty()) continue;
      const double y = panel.box.bottom - panel.box.height() * panel.y.fraction(tic.at);
      const double left = panel.y.at_right ? panel.box.right + gap
                                           : panel.box.left - gap - width_of(tic.label, size);
      add(tic.label, left, y, size);
    }
  }
  return texts;
}

// What collides or leaves the sheet, in words; empty if all can be read.
inline std::string collisions(const bbsim::plot::Picture& picture) {
  const std::vector<Written> texts = all_texts(picture);
  std::string found;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const Written& one = texts[i];
    if (one.left < 0 || one.right > picture.width || one.top < 0 || one.bottom > picture.height) {
      found += "outside: " + one.text + "\n";
    }
    for (std::size_t j = i + 1; j < texts.size(); ++j) {
      const Written& other = texts[j];
      const bool apart = one.right <= other.left || other.right <= one.left ||
                         one.bottom <= other.top || other.bottom <= one.top;
      if (!apart) found += "\"" + one.text + "\" over \"" + other.text + "\"\n";
    }
  }
  return found;
}

inline bool says(const bbsim::plot::Picture& picture, const std::string& text) {
  return std::ranges::any_of(picture.words, [&](const auto& words) { return words.text == text; });
}

}  // namespace bbsim_test
