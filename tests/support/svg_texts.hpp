// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Finds texts that collide in a picture.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace bbsim_test {

// Place of a text, in pixels.
struct Written {
  std::string text;
  double left, right, top, bottom;
};

// The text after `name` in a piece of XML, up to a quotation mark or a tag.
inline std::string behind(const std::string& xml, const std::string& name) {
  const std::size_t at = xml.find(name);
  if (at == std::string::npos) return "";
  const std::size_t start = at + name.size();
  return xml.substr(start, xml.find_first_of("\"<", start) - start);
}

// All nonempty texts of an SVG from gnuplot.
inline std::vector<Written> all_texts(const std::string& svg) {
  std::vector<Written> texts;
  const std::string begin = "<g transform=\"translate(";
  for (std::size_t at = 0; (at = svg.find(begin, at)) != std::string::npos; ++at) {
    const std::string group = svg.substr(at, svg.find("</g>", at) - at);
    const std::string place = behind(group, begin), text = behind(group, "<text>");
    if (text.empty()) continue;
    const double x = std::stod(place), y = std::stod(place.substr(place.find(',') + 1));
    const double size = std::stod(behind(group, "font-size=\""));
    const auto letters =
        std::ranges::count_if(text, [](unsigned char c) { return (c & 0xC0U) != 0x80U; });
    const double width = 0.6 * size * static_cast<double>(letters);  // width of an average letter
    const std::string anchor = behind(group, "text-anchor=\"");
    const double before = width * (anchor == "start" ? 0 : anchor == "middle" ? 0.5 : 1);
    if (group.find("rotate(") != std::string::npos) {
      texts.push_back({text, x - 0.8 * size, x, y - width + before, y + before});
    } else {
      texts.push_back({text, x - before, x - before + width, y - 0.8 * size, y});
    }
  }
  return texts;
}

// Describes what collides in an SVG or leaves the sheet; empty if everything is readable.
inline std::string collisions_in(const std::string& svg) {
  const std::string sheet = behind(svg, "viewBox=\"0 0 ");
  if (sheet.empty()) return "no size";
  const double width = std::stod(sheet), height = std::stod(sheet.substr(sheet.find(' ')));
  const std::vector<Written> texts = all_texts(svg);
  std::string found;
  if (texts.size() < 4) return "no texts";
  for (std::size_t i = 0; i < texts.size(); ++i) {
    const Written& one = texts[i];
    if (one.left < 0 || one.right > width || one.top < 0 || one.bottom > height) {
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

}  // namespace bbsim_test
