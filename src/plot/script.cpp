// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "plot/script.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "plot/text.hpp"

namespace bbsim::plot {
namespace {

constexpr double seam = 0.7;  // pixels

// What differs between the terminals: each has sizes of its own.
struct Terminal {
  std::string name;
  std::string font;       // of tics, with its size as the terminal takes it
  double font_scale = 1;  // of a size in pixels to that
  double line_scale = 1, marker_scale = 1;
  double dash_scale = 1;                     // of a length in pixels to what the terminal takes ...
  bool dashes_grow = true;                   // ... for a line of width 1, or for any
  std::string x_offset = "", y_offset = "";  // of labels that are set too far from their axis
};

std::string fixed(double value, int digits = 6) {
  if (!std::isfinite(value)) return "NaN";
  char text[400];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::fixed, digits);
  return {text, end.ptr};
}

// Fonts that have Greek letters, superscripts and arrows; a picture has 100 pixels an inch.
Terminal terminal_for(const Picture& picture, Format format) {
  const std::string pixels = fixed(picture.width, 0) + "," + fixed(picture.height, 0);
  switch (format) {
    case Format::svg:
      return {.name = "svg size " + pixels,
              .font = "DejaVu Sans,Verdana,Helvetica,sans-serif,13",
              .marker_scale = 0.62,
              .dash_scale = 2,
              .x_offset = " offset 0, 0.35",
              .y_offset = " offset 0.6, 0"};
    case Format::png:
      return {.name = "pngcairo size " + pixels,
              .font = "DejaVu Sans,9.75",
              .font_scale = 0.75,
              .marker_scale = 0.98,
              .dash_scale = 4};
    case Format::pdf:
      break;
  }
  constexpr double pixels_an_inch = 100;
  return {.name = "pdfcairo size " + fixed(picture.width / pixels_an_inch) + "in," +
                  fixed(picture.height / pixels_an_inch) + "in",
          .font = "DejaVu Sans,12.8",
          .font_scale = 0.985,
          .line_scale = 1.35,
          .marker_scale = 0.62,
          .dash_scale = 2.62,
          .dashes_grow = false};
}

class Script {
 public:
  Script(const Picture& picture, Format format, const HasLetter& has_letter)
      : picture_(picture),
        terminal_(terminal_for(picture, format)),
        viewer_has_fonts_(format == Format::svg),
        has_letter_(has_letter) {}

  std::string write() {
    text_ = "set encoding utf8\napostrophe = \"\\047\"\nset terminal " + terminal_.name +
            " noenhanced rounded background '#ffffff' font '" + terminal_.font +
            "'\nset border 0\nunset key\n";
    for (std::size_t i = 0; i < picture_.panels.size(); ++i) write_data(picture_.panels[i], i);
    text_ += "set multiplot\n";
    for (std::size_t i = 0; i < picture_.panels.size(); ++i) write_panel(picture_.panels[i], i);
    write_words();
    return text_ + "unset multiplot\n";
  }

 private:
  [[nodiscard]] std::string screen_x(double x) const { return fixed(x / picture_.width); }
  [[nodiscard]] std::string screen_y(double y) const { return fixed(1 - y / picture_.height); }
  [[nodiscard]] std::string at(double x, double y) const {
    return "screen " + screen_x(x) + ", screen " + screen_y(y);
  }

  // As strings in single quotes, in which all is itself, with the variable `apostrophe` between
  // them: gnuplot 5 neither reads two quotes that are doubled, one after the other, nor leaves
  // macros alone after a quote in double quotes.
  [[nodiscard]] std::string quoted(std::string_view text) const {
    std::string shown = clean(text);
    if (!viewer_has_fonts_) shown = with_letters(shown, has_letter_);
    std::string result = "'";
    for (const char c : shown) {
      if (c == '\'') {
        result += "'.apostrophe.'";
      } else {
        result += c;
      }
    }
    return result += '\'';
  }

  static std::string block(std::size_t panel, const char* kind, std::size_t item) {
    std::string name = "$";
    name += kind;
    name += std::to_string(panel);
    name += '_';
    return name += std::to_string(item);
  }

  // Data come before `set multiplot`: within it gnuplot 5 takes no new blocks.
  void write_data(const Panel& panel, std::size_t number) {
    if (!panel.cells.empty()) {
      text_ += block(number, "cells", 0) + " << END\n";
      // Each cell goes a little under those that come after it, at its right and above it, so
      // that no seam is seen between them.
      const double more_x = seam / panel.box.width(), more_y = seam / panel.box.height();
      for (const Cell& cell : panel.cells) {
        const double left = panel.x.fraction(cell.left), low = panel.y.fraction(cell.bottom);
        const double right = std::min(panel.x.fraction(cell.right) + more_x, 1.0);
        const double high = std::min(panel.y.fraction(cell.top) + more_y, 1.0);
        for (const double value : {(left + right) / 2, (low + high) / 2, left, right, low, high}) {
          text_ += fixed(value) + ' ';
        }
        text_ += std::to_string(cell.rgb) + '\n';
      }
      text_ += "END\n";
    }
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      const Curve& curve = panel.curves[c];
      text_ += block(number, "curve", c) + " << END\n";
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        text_ += fixed(panel.x.fraction(curve.x[i])) + ' ' + fixed(panel.y.fraction(curve.y[i]));
        if (curve.shape == Curve::Shape::band) {
          text_ += ' ' + fixed(panel.y.fraction(curve.y_high[i]));
        }
        text_ += '\n';
      }
      text_ += "END\n";
    }
  }

  [[nodiscard]] std::string dashes_of(const Stroke& stroke) const {
    if (stroke.dash == Dash::solid) return "solid";
    // In pixels, without the round ends, which are as long as the line is wide.
    static const std::vector<double> patterns[] = {{}, {8, 6}, {0.5, 5}, {11, 5, 0.5, 5}};
    const double scale = terminal_.dash_scale / (terminal_.dashes_grow ? stroke.width : 1);
    std::string text;
    for (const double length : patterns[static_cast<int>(stroke.dash)]) {
      text += text.empty() ? '(' : ',';
      text += fixed(length * scale, 2);
    }
    return text += ')';
  }

  [[nodiscard]] std::string line_of(const Stroke& stroke) const {
    return "linewidth " + fixed(stroke.width * terminal_.line_scale, 2) + " dashtype " +
           dashes_of(stroke) + " linecolor rgb '" + stroke.colour + "'";
  }

  [[nodiscard]] std::string point_of(const Stroke& stroke) const {
    constexpr int types[] = {0, 1, 2, 4, 5, 6, 7, 8, 13};
    // A dot is smaller than a ring around it.
    const double size = stroke.marker == Marker::dot ? 0.55 : 1.0;
    return "pointtype " + std::to_string(types[static_cast<int>(stroke.marker)]) + " pointsize " +
           fixed(stroke.marker_size * size * terminal_.marker_scale, 2) + " linewidth " +
           fixed(1.6 * terminal_.line_scale, 2) + " linecolor rgb '" + stroke.colour + "'";
  }

  void write_tics(const char* name, const Axis& axis) {
    if (axis.tics.empty()) {
      text_ += "unset " + std::string(name) + '\n';
      return;
    }
    text_ += "set " + std::string(name) + " (";
    for (std::size_t i = 0; i < axis.tics.size(); ++i) {
      text_ += (i > 0 ? ", " : "") + quoted(axis.tics[i].label) + ' ' +
               fixed(axis.fraction(axis.tics[i].at));
    }
    text_ += ')';
    if (!axis.at_right) text_ += name[0] == 'x' ? terminal_.x_offset : terminal_.y_offset;
    text_ += '\n';
  }

  void write_panel(const Panel& panel, std::size_t number) {
    text_ += "reset\nset border " +
             std::string(panel.framed       ? "15"
                         : panel.y.at_right ? "9"
                                            : "3") +
             " linecolor rgb '#404040' linewidth " + fixed(terminal_.line_scale, 2) +
             "\nunset key\nset tics nomirror out textcolor rgb '#202020' scale 0.6\n";
    text_ += "set lmargin at screen " + screen_x(panel.box.left) + "\nset rmargin at screen " +
             screen_x(panel.box.right) + "\nset bmargin at screen " + screen_y(panel.box.bottom) +
             "\nset tmargin at screen " + screen_y(panel.box.top) + '\n';
    text_ += "set xrange [0:1]\nset yrange [0:1]\nset y2range [0:1]\n";
    write_tics("xtics", panel.x);
    if (panel.y.at_right) text_ += "unset ytics\n";
    write_tics(panel.y.at_right ? "y2tics" : "ytics", panel.y);
    if (panel.grid) {
      text_ += "set grid " + std::string(panel.y.at_right ? "xtics y2tics" : "xtics ytics") +
               " linecolor rgb '#e4e4e4' linewidth " + fixed(terminal_.line_scale, 2) +
               " linetype 1\n";
    }
    for (const Upright& upright : panel.uprights) {
      const std::string x = fixed(panel.x.fraction(upright.x));
      if (upright.stroke.width > 0) {
        text_ += "set arrow from first " + x + ", graph 0 to first " + x +
                 ", graph 1 nohead back " + line_of(upright.stroke) + '\n';
      }
      if (upright.stroke.marker != Marker::none) {
        text_ += "set label '' at first " + x + ", graph 1 point " + point_of(upright.stroke) +
                 " front\n";
      }
    }
    text_ += "plot ";
    if (!panel.cells.empty()) {
      text_ += block(number, "cells", 0) +
               " using 1:2:3:4:5:6:7 with boxxyerror fillstyle solid noborder "
               "linecolor rgb variable, ";
    }
    for (std::size_t c = 0; c < panel.curves.size(); ++c) {
      write_curve(panel.curves[c], block(number, "curve", c));
    }
    text_ += "NaN notitle\n";  // so that a panel may be empty
  }

  void write_curve(const Curve& curve, const std::string& data) {
    if (curve.shape == Curve::Shape::band) {
      text_ += data + " using 1:2:3 with filledcurves fillstyle solid noborder linecolor rgb '" +
               curve.stroke.colour + "', ";
      return;
    }
    if (curve.stroke.width > 0) {
      text_ += data + " using 1:2 with " +
               (curve.shape == Curve::Shape::steps ? "steps " : "lines ") + line_of(curve.stroke) +
               ", ";
    }
    if (curve.stroke.marker != Marker::none) {
      text_ += data + " using 1:2 with points " + point_of(curve.stroke) + ", ";
    }
  }

  // An empty plot over the whole sheet carries what stands outside the panels.
  void write_words() {
    text_ +=
        "reset\nset border 0\nunset key\nunset tics\nset lmargin at screen 0\n"
        "set rmargin at screen 1\nset bmargin at screen 0\nset tmargin at screen 1\n"
        "set xrange [0:1]\nset yrange [0:1]\n";
    for (const Words& words : picture_.words) {
      constexpr std::string_view aligns[] = {"left", "center", "right"};
      text_ += "set label " + quoted(words.text) + " at " + at(words.x, words.y) + ' ' +
               std::string(aligns[static_cast<int>(words.align)]) + " noenhanced font '," +
               fixed(words.size * terminal_.font_scale, 2) + "' textcolor rgb '" + words.colour +
               (words.upwards ? "' rotate by 90\n" : "'\n");
    }
    for (const Sample& sample : picture_.samples) {
      if (sample.stroke.width > 0) {
        text_ += "set arrow from " + at(sample.x, sample.y) + " to " +
                 at(sample.x + sample.length, sample.y) + " nohead " + line_of(sample.stroke) +
                 '\n';
      }
      if (sample.stroke.marker != Marker::none) {
        text_ += "set label '' at " + at(sample.x + sample.length / 2, sample.y) + " point " +
                 point_of(sample.stroke) + '\n';
      }
    }
    text_ += "plot NaN notitle\n";
  }

  const Picture& picture_;
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

// Where each format has room for a comment, at the end.
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
