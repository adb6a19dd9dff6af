// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/script.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr double title_size = 17, heading_size = 13, legend_size = 12, number_size = 11;
constexpr double legend_pitch = 19, legend_sample = 50;  // pixels: of a row; beside a name
// Least width of a letter relative to its size, because gnuplot counts the letters of a name.
constexpr double legend_letter = 0.65;
// The same for the single row of a panel, which may be tighter.
constexpr double panel_sample = 42, panel_letter = 0.5;
constexpr double side = 30;  // pixels left free beside the heading

std::string digits(double value) {
  if (!std::isfinite(value)) return "NaN";
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

// Differences between the terminals, which have their own sizes.
struct Terminal {
  const char* name;
  double pixel;      // size of a pixel
  const char* unit;  // unit of `pixel`
  double marker_scale;
  double row_height;              // of a legend, in pixels
  const char* tics_offset = "";   // for labels that are too far from their axis
  const char* label_offset = "";  // for labels below them
};

// The fonts have Greek letters, superscripts and arrows. A PDF has 100 pixels per inch.
Terminal terminal_of(Format format) {
  switch (format) {
    case Format::svg:
      return {"svg font 'DejaVu Sans,Verdana,Helvetica,sans-serif,13' dashlength 0.5",
              1,
              "",
              0.62,
              18,
              " offset 0, 0.35",
              " offset 0, 0.9"};
    case Format::png:
      return {"pngcairo font 'DejaVu Sans,13' fontscale 0.75 dashlength 0.6", 1, "", 0.98, 14.1};
    case Format::pdf:
      break;
  }
  return {"pdfcairo font 'DejaVu Sans,13' fontscale 0.985 linewidth 1.35", 0.01, "in", 0.62, 14.1};
}

// Escapes a tic label, because gnuplot reads it as a format of its number.
std::string unformatted(const std::string& label) {
  std::string result;
  for (const char c : label) result.append(c == '%' ? 2 : 1, c);
  return result;
}

struct Heading {
  double height = 0;
  std::size_t columns = 1;  // of the legend
};

Heading heading_of(const Picture& picture) {
  double widest = 0;
  for (const LegendEntry& entry : picture.legend) {
    widest = std::max(widest, width_of(clean(entry.name), legend_size, legend_letter));
  }
  const std::size_t entries = picture.legend.size();
  const double fit = std::floor((picture.width - 2 * side) / (widest + legend_sample));
  const auto columns = std::clamp<std::size_t>(static_cast<std::size_t>(fit), 1, entries + 1);
  const std::size_t rows = (entries + columns - 1) / columns;
  return {20.0 + (picture.title.empty() ? 0 : 23) + (picture.subtitle.empty() ? 0 : 20) +
              (rows == 0 ? 0 : 10 + legend_pitch * static_cast<double>(rows)),
          columns};
}

class Script {
 public:
  Script(const Picture& picture, Format format, const HasLetter& has_letter)
      : picture_(picture),
        heading_(heading_of(picture)),
        height_(picture.height + heading_.height),
        terminal_(terminal_of(format)),
        viewer_has_fonts_(format == Format::svg),
        has_letter_(has_letter) {}

  std::string write() {
    const auto size = [&](double pixels) { return digits(pixels * terminal_.pixel); };
    text_ = std::string("set encoding utf8\nset minussign\napostrophe = \"\\047\"\nset terminal ") +
            terminal_.name + " noenhanced rounded background '#ffffff' size " +
            size(picture_.width) + terminal_.unit + ',' + size(height_) + terminal_.unit + '\n';
    for (std::size_t p = 0; p < picture_.panels.size(); ++p) write_data(picture_.panels[p], p);
    text_ += "set multiplot\n";
    write_heading();
    for (std::size_t p = 0; p < picture_.panels.size(); ++p) write_panel(picture_.panels[p], p);
    return text_ + "unset multiplot\n";
  }

 private:
  [[nodiscard]] std::string screen_x(double x) const {
    return "screen " + digits(x / picture_.width);
  }
  [[nodiscard]] std::string screen_y(double y) const { return "screen " + digits(1 - y / height_); }

  // Returns strings in single quotes, which gnuplot does not interpret, joined by the variable
  // `apostrophe`. gnuplot 5 cannot read two doubled quotes in a row, and expands macros after a
  // quote in double quotes.
  [[nodiscard]] std::string quoted(std::string_view text) const {
    std::string shown = clean(text);
    if (!viewer_has_fonts_) shown = with_letters(shown, has_letter_);
    std::string result = "'";
    for (const char c : shown) result += c == '\'' ? "'.apostrophe.'" : std::string(1, c);
    return result += '\'';
  }

  [[nodiscard]] static std::string font(double size) { return " font '," + digits(size) + '\''; }

  static std::string block(std::size_t panel, const char* kind, std::size_t item) {
    return '$' + std::string(kind) + std::to_string(panel) + '_' + std::to_string(item);
  }

  // Data come before `set multiplot`, because gnuplot 5 accepts no new blocks within it.
  void write_data(const Panel& panel, std::size_t number) {
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const Curve& curve = panel.curves[c];
      text_ += block(number, "curve", c) + " << END\n";
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        text_ += digits(curve.x[i]) + ' ' + digits(curve.y[i]);
        if (curve.shape == Curve::Shape::band) text_ += ' ' + digits(curve.y_high[i]);
        text_ += '\n';
      }
      text_ += "END\n";
    }
    if (panel.cells.empty()) return;
    text_ += block(number, "cells", 0) + " << END\n";
    for (const Cell& cell : panel.cells) {
      for (const double value :
           {panel.x.middle(cell.left, cell.right), panel.y.middle(cell.bottom, cell.top), cell.left,
            cell.right, cell.bottom, cell.top, cell.value}) {
        text_ += digits(value) + ' ';
      }
      // White text is readable on the dark half of the colors.
      const bool dark = panel.colours && panel.colours->fraction(cell.value) < 0.55;
      text_ += (dark ? "0xffffff " : "0 ") + (cell.text.empty() ? "-" : cell.text) + '\n';
    }
    text_ += "END\n";
  }

  [[nodiscard]] std::string style_of(const Stroke& stroke) const {
    constexpr std::array points = {0, 1, 2, 4, 5, 6, 7, 8, 13};
    std::string text = stroke.width > 0 && stroke.marker != Marker::none ? "linespoints"
                       : stroke.width > 0                                ? "lines"
                                                                         : "points";
    text += " linecolor rgb '" + stroke.colour + "'";
    if (stroke.width > 0) {
      text += " dashtype " + std::to_string(static_cast<int>(stroke.dash) + 1);
    }
    if (stroke.marker == Marker::none) return text + " linewidth " + digits(stroke.width);
    // A dot is smaller than a ring around it.
    const double size = stroke.marker_size * (stroke.marker == Marker::dot ? 0.55 : 1.0);
    return text + " linewidth " + digits(stroke.width > 0 ? stroke.width : 1.6) + " pointtype " +
           std::to_string(points[static_cast<std::size_t>(stroke.marker)]) + " pointsize " +
           digits(size * terminal_.marker_scale);
  }

  void write_axis(const std::string& name, const Axis& axis) {
    text_ += "set " + name + "range [" + digits(axis.low) + ':' + digits(axis.high) + "]\n";
    if (axis.log) text_ += "set logscale " + name + '\n';
    if (!axis.label.empty())
      text_ += "set " + name + "label " + quoted(axis.label) +
               (name == "x" ? terminal_.label_offset : "") + '\n';
    text_ += "set " + name + "tics ";
    if (axis.step > 0) {
      text_ += digits(axis.step);
    } else {
      text_ += '(';
      for (const Tic& tic : axis.tics) {
        if (&tic != axis.tics.data()) text_ += ", ";
        text_ += quoted(axis.numbered ? unformatted(tic.label) : "") + ' ' + digits(tic.at);
      }
      text_ += ')';
    }
    if (name == "x") text_ += terminal_.tics_offset;
    text_ += "\nset format " + name + " '" +
             (axis.numbered ? "%." + std::to_string(axis.decimals()) + "f" : "") + "'\n";
  }

  void write_panel(const Panel& panel, std::size_t number) {
    const Box& box = panel.box;
    const double top = heading_.height + box.top, bottom = heading_.height + box.bottom;
    text_ += "reset\nset border " + std::string(panel.colours ? "15" : "3") +
             " linecolor rgb '#404040'\nset tics nomirror out textcolor rgb '#202020' scale 0.6\n"
             "set lmargin at " +
             screen_x(box.left) + "\nset rmargin at " + screen_x(box.right) + "\nset tmargin at " +
             screen_y(top) + "\nset bmargin at " + screen_y(bottom) + '\n';
    write_axis("x", panel.x);
    write_axis("y", panel.y);
    if (panel.colours) {
      // Viridis: its lightness grows with the value, in print and for any color vision.
      text_ +=
          "set palette defined (0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', "
          "5 '#28ae80', 6 '#5ec962', 7 '#addc30', 8 '#fde725')\nset colorbox user origin " +
          screen_x(box.right + 16) + ", " + screen_y(bottom) + " size " + screen_x(14) +
          ", screen " + digits(box.height() / height_) + "\n";
      write_axis("cb", *panel.colours);
      const auto has_value = [](const Cell& cell) { return std::isfinite(cell.value); };
      if (std::ranges::none_of(panel.cells, has_value)) text_ += "unset colorbox\n";
    } else {
      text_ += "set grid linecolor rgb '#e4e4e4' linetype 1\n";
    }
    const std::string heading = cut(clean(panel.heading), 0.7 * box.width(), heading_size);
    text_ += "set label " + quoted(heading) + " at " + screen_x(box.left - 4) + ", " +
             screen_y(top - 12) + '\n';
    text_ += "set key at " + screen_x(box.right) + ", " + screen_y(top - 6) +
             " right bottom horizontal Left reverse samplen 2" + font(legend_size) + '\n';
    text_ += "plot ";
    if (!panel.cells.empty()) write_cells(panel, block(number, "cells", 0));
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      write_curve(panel.curves[c], block(number, "curve", c));
    }
    const double room = (box.width() - width_of(heading, heading_size) - 10) /
                        static_cast<double>(panel.legend.size());
    write_legend(panel.legend, room - panel_sample, panel_letter);
  }

  void write_cells(const Panel& panel, const std::string& data) {
    const auto boxes = [&](const char* x, const char* value, const char* colour) {
      // A border of the same color hides seams between cells.
      text_ += data + " using " + x + ":2:3:4:5:6" + value + " with boxxyerror linecolor " +
               colour + " fillstyle solid border notitle, ";
    };
    if (!panel.colours) return boxes("1", "", "rgb '#7fb8d8'");
    boxes("1", "", "rgb '#d9d9d9'");
    boxes("($7 == $7 ? $1 : NaN)", ":7", "palette");
    text_ += data +
             " using 1:2:(strcol(9) eq '-' ? '' : strcol(9)):8 with labels textcolor rgb variable" +
             font(number_size) + " notitle, ";
  }

  void write_curve(const Curve& curve, const std::string& data) {
    if (std::ranges::none_of(curve.y, [](double y) { return std::isfinite(y); })) return;
    if (curve.shape == Curve::Shape::band) {
      text_ += data +
               " using 1:2:3 with filledcurves fillstyle transparent solid 0.25 noborder linecolor "
               "rgb '" +
               curve.stroke.colour + "' notitle, ";
      return;
    }
    std::string style = style_of(curve.stroke);
    if (curve.shape == Curve::Shape::steps && style.starts_with("lines "))
      style.replace(0, 5, "steps");
    text_ += data + " using 1:2 with " + style + " notitle, ";
  }

  // Ends a plot and gives it at least one element. Cuts names to the room.
  void write_legend(const std::vector<LegendEntry>& legend, double room, double narrowest) {
    text_ += "NaN notitle";
    for (const LegendEntry& entry : legend) {
      text_ += ", keyentry with " + style_of(entry.stroke) + " title " +
               quoted(cut(clean(entry.name), room, legend_size, narrowest));
    }
    text_ += '\n';
  }

  // Writes everything above the panels as a plot without axes.
  void write_heading() {
    const double room = picture_.width - 2 * side;
    double y = 26;
    text_ +=
        "unset border\nunset tics\nset margins 0, 0, 0, 0\nset xrange [0:1]\nset yrange [0:1]\n";
    const auto line = [&](const std::string& words, double size, const char* colour,
                          double height) {
      if (words.empty()) return;
      text_ += "set label " + quoted(cut(clean(words), room, size)) + " at screen 0.5, " +
               screen_y(y) + " center" + font(size) + " textcolor rgb '" + colour + "'\n";
      y += height;
    };
    line(picture_.title, title_size, "#202020", 23);
    line(picture_.subtitle, legend_size, "#505050", 20);
    text_ += "set key at screen 0.5, " + screen_y(y - 6) +
             " center top horizontal Left reverse samplen 2 spacing " +
             digits(legend_pitch / terminal_.row_height) + " maxcols " +
             std::to_string(heading_.columns) + font(legend_size) + "\nplot ";
    write_legend(picture_.legend, 0.9 * room - legend_sample, legend_letter);
  }

  const Picture& picture_;
  Heading heading_;
  double height_;
  Terminal terminal_;
  bool viewer_has_fonts_;
  const HasLetter& has_letter_;
  std::string text_;
};

// A chunk of PNG: the length of its content, its kind and content, and the CRC-32 of those two.
std::string png_chunk(std::string_view kind_and_content) {
  const auto number = [](std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift & 0xFFU);
    return bytes;
  };
  std::uint32_t crc = 0xFFFFFFFF;
  for (const char c : kind_and_content) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (crc & 1U) * 0xEDB88320U;
  }
  constexpr std::size_t kind = 4;
  return number(static_cast<std::uint32_t>(kind_and_content.size() - kind)) +
         std::string(kind_and_content) + number(~crc);
}

}  // namespace

std::string gnuplot_script(const Picture& picture, Format format, const HasLetter& has_letter) {
  return Script(picture, format, has_letter).write();
}

std::string mended(std::string drawn, Format format) {
  if (format != Format::svg || drawn.find("<![CDATA[") != std::string::npos) return drawn;
  constexpr std::string_view end_of_section = "]]>", as_text = "]]&gt;";
  for (std::size_t at = 0; (at = drawn.find(end_of_section, at)) != std::string::npos;) {
    drawn.replace(at, end_of_section.size(), as_text);
    at += as_text.size();
  }
  return drawn;
}

// Each format permits a comment at the end.
std::string marked(std::string drawn, Format format) {
  switch (format) {
    case Format::svg:
      return drawn.append("<!-- ").append(picture_mark).append(" -->\n");
    case Format::pdf:
      return drawn.append("% ").append(picture_mark).append("\n");
    case Format::png:
      break;
  }
  const std::string last = png_chunk("IEND");
  const std::string comment = std::string("tEXtComment") + '\0' + picture_mark;
  if (drawn.ends_with(last)) drawn.insert(drawn.size() - last.size(), png_chunk(comment));
  return drawn;
}

}  // namespace bbsim::plot
