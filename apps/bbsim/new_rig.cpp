// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim new rig`: a scenario for your rig to start from.
#include "new_rig.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "commands.hpp"
#include "embedded.hpp"
#include "terminal.hpp"
#include "yaml/quantity.hpp"

namespace bbsim::app {
namespace {

using yaml::value_in;

constexpr double mm = 1e-3;

InputError refused(const std::string& option, const std::string& found,
                   const std::string& allowed) {
  return InputError(option + ": found " + found + "; allowed: " + allowed);
}

// Sides along x and y. For a disc, both are the diameter.
struct Plate {
  double x = 0, y = 0;
  bool disc = false;

  [[nodiscard]] double least() const { return std::min(x, y); }
  [[nodiscard]] double most() const { return std::max(x, y); }
};

Plate read_plate(const std::string& text) {
  const auto side = [&](std::string_view part) {
    const auto value = value_in(part, "m");
    if (value && *value >= 150 * mm && *value <= 600 * mm) return *value;
    throw refused("--plate", text,
                  "two sides, or the diameter of a disc, from 150 mm to 600 mm, such as \"300 mm x "
                  "200 mm\" or \"250 mm\"");
  };
  const std::size_t by = text.find('x');
  if (by == std::string::npos) return {side(text), side(text), true};
  const std::string_view whole(text);
  return {side(whole.substr(0, by)), side(whole.substr(by + 1)), false};
}

struct Ball {
  double diameter = 0, mass = 0;
  bool hollow = false;
};

struct NamedBall {
  std::string_view name;
  Ball ball;
};
constexpr std::array balls = {
    NamedBall{"ping-pong", {40e-3, 2.7e-3, true}}, NamedBall{"steel", {20e-3, 32.7e-3, false}},
    NamedBall{"rubber", {40e-3, 33e-3, false}}, NamedBall{"golf", {42.7e-3, 45.9e-3, false}}};

// Density in kg/m^3 above that of thin shells and below that of wood and rubber.
constexpr double density_of_hollow_ones = 400;

// "40 mm 2.7 g", optionally with "hollow" or "solid".
std::optional<Ball> read_diameter_and_mass(std::string_view text) {
  std::optional<bool> hollow;
  for (const std::string_view word : {"hollow", "solid"}) {
    if (!text.ends_with(word)) continue;
    hollow = word == "hollow";
    text = trimmed(text.substr(0, text.size() - word.size()));
    break;
  }
  for (std::size_t blank = text.find(' '); blank != std::string_view::npos;
       blank = text.find(' ', blank + 1)) {
    const auto diameter = value_in(text.substr(0, blank), "m");
    const auto mass = value_in(text.substr(blank), "kg");
    if (!diameter || !mass || !(*diameter > 0) || !(*mass > 0)) continue;
    const double volume = std::numbers::pi / 6 * std::pow(*diameter, 3);
    return Ball{*diameter, *mass, hollow.value_or(*mass < density_of_hollow_ones * volume)};
  }
  return {};
}

// Name as in `balls`: "Table tennis" and "ping pong" become ping-pong.
std::string name_of_ball(std::string_view text) {
  std::string name = lower(text);
  std::ranges::replace(name, ' ', '-');
  return name == "table-tennis" ? "ping-pong" : name;
}

Ball read_ball(const std::string& text, const Plate& plate) {
  const auto* const named = std::ranges::find(balls, name_of_ball(trimmed(text)), &NamedBall::name);
  const std::optional<Ball> ball =
      named != balls.end() ? named->ball : read_diameter_and_mass(trimmed(text));
  if (!ball) {
    throw refused("--ball", text,
                  "ping-pong, steel, rubber, golf, or a diameter and a mass, such as \"40 mm 2.7 "
                  "g\", with or without hollow or solid");
  }
  if (ball->diameter < 5 * mm || ball->diameter > plate.least() / 2) {
    throw refused("--ball", text,
                  "a diameter from 5 mm to half of the plate's smaller side, " +
                      short_number(plate.least() / 2 / mm) + " mm");
  }
  return *ball;
}

// Rate in Hz.
double read_rate(const std::string& option, const std::string& text) {
  const bool hertz = trimmed(text).ends_with("Hz");
  const auto rate = hertz ? value_in(text, "rad/s") : std::nullopt;
  const double turns = rate.value_or(0) / (2 * std::numbers::pi);
  const double digits = 1e9;  // removes rounding of the conversion
  const double kept = std::round(turns * digits) / digits;
  if (kept >= 15 && kept <= 200) return kept;
  throw refused(option, text, "a rate from 15 Hz to 200 Hz, such as \"30 Hz\"");
}

bool is_motor_class(const std::string& name) {
  return name.starts_with("nema");
}

struct Rig {
  Plate plate;
  Ball ball;
  std::string servo;  // class of the servos or motors; empty for any stepper motor
  double rate = 0;
  bool touch = false, three_legs = false, stepper = false;
};

std::string word(const RigWords& words, const std::string& option, const char* otherwise = "") {
  const auto found = words.find(option);
  return found == words.end() || found->second.empty() ? otherwise : found->second;
}

Rig read_rig(const RigWords& words) {
  Rig rig;
  rig.plate = read_plate(word(words, "--plate", "300 mm x 200 mm"));
  rig.ball = read_ball(word(words, "--ball", "ping-pong"), rig.plate);
  rig.stepper = word(words, "--actuator") == "stepper";
  rig.servo = word(words, "--servo");
  if (!rig.servo.empty() && is_motor_class(rig.servo) != rig.stepper) {
    throw refused("--servo", rig.servo,
                  rig.stepper
                      ? "nema14, nema17, nema23 with --actuator stepper"
                      : "hobby-standard, hobby-micro, smart-serial; motor classes only with "
                        "--actuator stepper");
  }
  if (rig.servo.empty() && !rig.stepper) rig.servo = "hobby-standard";
  const std::string touch = word(words, "--touch");
  rig.touch = !touch.empty();
  rig.rate = rig.touch ? read_rate("--touch", touch)
                       : read_rate("--camera", word(words, "--camera", "30 Hz"));
  rig.three_legs = word(words, "--legs") == "3";
  return rig;
}

// Delays of a loop, s, and gains that suit them.
struct Loop {
  double sensor = 0, filter = 0, bandwidth = 0, kp = 0, kv = 0, ki = 0;
};

Loop loop_of(const Rig& rig) {
  constexpr double servo = 0.05;  // 2 damping / natural_frequency is at most this in all classes
  constexpr double code = 0.005;
  const double period = 1 / rig.rate;
  Loop loop;
  loop.sensor = rig.touch ? 0.005 : period;
  loop.filter = std::max(0.04, period);
  // The hold delays by half a period. The total delay takes 30 degrees off the phase margin.
  const double delay = servo + code + loop.sensor + loop.filter + period / 2;
  // With a larger bandwidth, noise drives a ball far from the center off the plate.
  constexpr double most = 2.5;
  const double inertia = rig.ball.hollow ? 2.0 / 3 : 0.4;
  // A plate that turns by 1 rad moves the contact point by so much, m, which the gain of the
  // velocity feeds back. With this factor all classes keep a gain margin of 6 dB.
  const double turn = inertia / (1 + inertia) * rig.ball.diameter / 2;
  const double factor = std::min(1.0, std::sqrt(0.0075 / turn));
  loop.bandwidth = std::stod(rounded(factor * std::min(most, 0.3 / delay), 2));
  const double acceleration = 9.81 / (1 + inertia);  // for 1 rad of tilt
  constexpr double damping = 0.9, integral = 0.15;
  loop.kp = loop.bandwidth * loop.bandwidth / acceleration;
  loop.kv = 2 * damping * loop.bandwidth / acceleration;
  loop.ki = integral * loop.bandwidth * loop.kp;
  return loop;
}

using Values = std::vector<std::pair<std::string_view, std::string>>;

std::string whole_mm(double length) {
  return short_number(std::round(length / mm)) + " mm";
}

std::string in_mm(double length) {
  return short_number(length / mm) + " mm";
}

Values values_of(const Rig& rig, const std::string& file) {
  const Loop loop = loop_of(rig);
  const Plate& plate = rig.plate;
  const double size = plate.least();
  // Rods scale with the plate.
  const auto part = [&](double of_size) { return std::round(of_size * size / mm) * mm; };
  const double horn = part(rig.three_legs ? 0.133 : 0.08), arm = part(0.2);
  const double pixels = rig.touch ? 1024 : 640;
  const auto ms = [](double time) { return rounded(time * 1e3, 2) + " ms"; };
  return {
      {"file", printable_ascii(file)},
      {"radius", in_mm(rig.ball.diameter / 2)},
      {"mass", short_number(rig.ball.mass * 1e3) + " g"},
      {"inertia", rig.ball.hollow ? "0.667" : "0.4"},
      {"x side", in_mm(plate.x)},
      {"y side", in_mm(plate.y)},
      {"step", whole_mm(std::min(plate.x / 6, 50 * mm))},
      {"circle", whole_mm(size / 6)},
      {"servo", rig.servo},
      {"motor", rig.servo},
      {"stop", rig.three_legs ? "50 deg" : "60 deg"},
      {"horn", in_mm(horn)},
      {"arm", in_mm(arm)},
      {"offset", in_mm(arm - horn)},
      {"length", in_mm(part(0.25))},
      {"base", in_mm(part(0.2))},
      {"joints", in_mm(part(0.3))},
      {"rod", in_mm(part(0.333))},
      {"height", in_mm(part(0.367))},
      {"bandwidth", short_number(loop.bandwidth)},
      {"kp", rounded(loop.kp, 2)},
      {"kv", rounded(loop.kv, 2)},
      {"ki", rounded(loop.ki, 2)},
      {"rate", short_number(rig.rate) + " Hz"},
      {"sample", rig.touch ? "reading" : "frame"},
      {"filter", ms(loop.filter)},
      {"resolution", rounded(plate.most() / pixels / mm, 1) + " mm"},
      {"delay", ms(loop.sensor)},
      {"end", short_number(std::ceil(std::max(15.0, 40 / loop.bandwidth)))},
  };
}

std::string filled(std::string_view line, const Values& values) {
  std::string text;
  for (std::size_t at = line.find('@'); at != std::string_view::npos; at = line.find('@')) {
    const std::size_t end = line.find('@', at + 1);
    const std::string_view name = line.substr(at + 1, end - at - 1);
    text += line.substr(0, at);
    text += std::ranges::find(values, name, &Values::value_type::first)->second;
    line.remove_prefix(end + 1);
  }
  return text += line;
}

// Aligns the comment at the end of a line with those of its neighbors.
std::string aligned(std::string line) {
  constexpr std::size_t column = 41;
  const std::size_t start = line.find_first_not_of(' '), comment = line.find(" # ");
  if (comment == std::string::npos || line[start] == '#') return line;
  if (comment + 1 < column) line.insert(comment, column - comment - 1, ' ');
  return line;
}

// Asks a question on standard error. Returns the trimmed answer, or nothing at the end of the
// input.
std::optional<std::string> answer_to(const std::string& question) {
  std::fputs((question + ": ").c_str(), stderr);
  std::string line;
  for (int letter = std::getchar(); letter != '\n'; letter = std::getchar()) {
    if (letter == EOF) {
      std::fputs("\n", stderr);
      return {};
    }
    line += static_cast<char>(letter);
  }
  return std::string(trimmed(line));
}

// Stores an answer in the words, or throws InputError. The rig is read again afterwards.
using Take = void (*)(RigWords&, const std::string&);

struct Question {
  const char* text;
  Take take;
};

constexpr std::array questions = {
    Question{"Plate, such as 300 mm x 200 mm, or 250 mm for a disc [300 mm x 200 mm]",
             [](RigWords& words, const std::string& answer) { words["--plate"] = answer; }},
    Question{"Ball: ping-pong, steel, rubber, golf, or such as 40 mm 2.7 g [ping-pong]",
             [](RigWords& words, const std::string& answer) { words["--ball"] = answer; }},
    Question{
        "Servos: hobby-standard, hobby-micro, smart-serial; or stepper motors: stepper, nema14, "
        "nema17, nema23 [hobby-standard]",
        [](RigWords& words, const std::string& answer) {
          if (answer.starts_with("stepper")) {
            words["--actuator"] = "stepper";
            return;
          }
          const std::vector<std::string> known = servo_classes();
          if (std::ranges::find(known, answer) == known.end()) {
            throw refused("--servo", answer,
                          "hobby-standard, hobby-micro, smart-serial, stepper, nema14, nema17, "
                          "nema23");
          }
          if (is_motor_class(answer)) words["--actuator"] = "stepper";
          words["--servo"] = answer;
        }},
    Question{"Sensor, such as camera 30 Hz or touch 50 Hz [camera 30 Hz]",
             [](RigWords& words, const std::string& answer) {
               const std::size_t blank = std::min(answer.find(' '), answer.size());
               const std::string kind = answer.substr(0, blank);
               const std::string rate(trimmed(answer.substr(blank)));
               if (rate.empty() || (kind != "camera" && kind != "touch")) {
                 throw refused("sensor", answer, "camera or touch, and a rate");
               }
               words["--" + kind] = rate;
             }},
    Question{"Legs: 2 push rods of a gimbal, or 3 servos under the plate [2]",
             [](RigWords& words, const std::string& answer) {
               if (answer != "2" && answer != "3") throw refused("--legs", answer, "2, 3");
               words["--legs"] = answer;
             }},
};

}  // namespace

std::vector<std::string> servo_classes() {
  return {"hobby-standard", "hobby-micro", "smart-serial", "nema14", "nema17", "nema23"};
}

void ask(RigWords& words) {
  for (const Question& question : questions) {
    for (bool taken = false; !taken;) {
      const std::optional<std::string> answer = answer_to(question.text);
      if (!answer) return;
      try {
        RigWords more = words;
        if (!answer->empty()) question.take(more, *answer);
        static_cast<void>(read_rig(more));
        words = std::move(more);
        taken = true;
      } catch (const InputError& fault) {
        say(fault.what());
      }
    }
  }
}

std::string rig_scenario(const RigWords& words, const std::string& file) {
  const Rig rig = read_rig(words);
  const Values values = values_of(rig, file);
  const std::array<std::string_view, 5> kept = {
      rig.touch ? "touch" : "camera", rig.stepper ? "stepper" : "servo",
      rig.servo.empty() ? "any motor"
      : rig.stepper     ? "motor class"
                        : "",
      rig.three_legs ? "3 legs" : "2 legs", rig.plate.disc ? "disc" : "rectangle"};
  constexpr std::string_view condition = "@if ", ends = "@ ";
  std::string text;
  for (const std::string& whole : lines_of(text_of(template_files(), "rig.yaml.in"))) {
    std::string_view line = whole;
    if (line.starts_with(condition)) {
      const std::size_t end = line.find(ends);
      const auto word = line.substr(condition.size(), end - condition.size());
      if (std::ranges::find(kept, word) == kept.end()) continue;
      line.remove_prefix(end + ends.size());
    }
    text += aligned(filled(line, values)) + '\n';
  }
  return text;
}

}  // namespace bbsim::app
