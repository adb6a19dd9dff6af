// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/serial_line.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.hpp"

namespace bbsim::controller {

SerialLine::SerialLine(std::shared_ptr<Program> program, Setup of_program)
    : program_(std::move(program)), setup_(std::move(of_program)) {
  for (const auto& [name, unit] :
       program_->ready().columns.value_or(std::vector<std::pair<std::string, std::string>>{})) {
    if (std::ranges::find(setup_.columns, name) != setup_.columns.end()) {
      program_columns_.push_back(name);
    }
  }
  numbers_.resize(program_columns_.size());
  sketch_numbers_.resize(setup_.columns.size() - program_columns_.size());
}

void SerialLine::connect(std::shared_ptr<Library> sketch) {
  sketch_ = std::move(sketch);
  sketch_->require_line();
}

Setup SerialLine::without_columns(Setup of_sketch) const {
  std::erase_if(of_sketch.columns, [&](const std::string& name) {
    return std::ranges::find(program_columns_, name) != program_columns_.end();
  });
  return of_sketch;
}

void SerialLine::begin() {
  program_->begin();
  sketch_->begin();
  std::ranges::fill(numbers_, std::nan(""));
  arrived_.clear();
  samples_ = sent_ = 0;
  due_ = baud_ = 0;
}

// What the program sends at a sample of the board.
std::string SerialLine::answer(const model::ControllerSample& sample) {
  // Times are rounded; a sample that is due a moment later is this one.
  const double periods = sample.t / setup_.period + 1e-6;
  if (periods < due_) return {};
  due_ = std::floor(periods) + 1;
  const model::ControllerSample its{samples_++,   sample.t,          sample.seen,
                                    sample.servo, sample.servo_rate, sample.reference};
  SerialAnswer said = program_->exchange(its, arrived_, program_columns_, numbers_.data());
  arrived_.clear();
  sent_ += said.bytes.size();
  baud_ = said.baud.value_or(baud_);
  const double theirs = sketch_->line().baud;
  constexpr double tolerated = 0.04;  // receivers sample the tenth bit half a bit too late
  if (!said.bytes.empty() && baud_ > 0 && theirs > 0 && std::abs(baud_ / theirs - 1) > tolerated) {
    throw program_->refuse(its, "it opened the line at " + short_number(baud_) +
                                    " baud, and the sketch at " + rounded(theirs, 4) +
                                    "; allowed: the same");
  }
  return std::move(said.bytes);
}

model::Commands SerialLine::command(const model::ControllerSample& sample, double* own) {
  sketch_->receive(arrived_);
  sketch_->send(answer(sample), setup_.delay);
  const model::Commands command = sketch_->command(sample, sketch_numbers_.data());
  std::size_t of_sketch = 0;
  for (std::size_t i = 0; i < setup_.columns.size(); ++i) {
    const auto its = std::ranges::find(program_columns_, setup_.columns[i]);
    own[i] = its == program_columns_.end()
                 ? sketch_numbers_[of_sketch++]
                 : numbers_[static_cast<std::size_t>(its - program_columns_.begin())];
  }
  return command;
}

std::string SerialLine::remark() const {
  const bbsim_line line = sketch_->line();
  if (sent_ == 0) return "the program at the serial line sent no byte to the sketch";
  if (line.baud == 0) {
    return "the sketch received nothing at its serial line: it never calls Serial.begin()";
  }
  if (line.read == 0) return "the sketch read no byte of its serial line";
  if (line.overrun == 0) return "";
  return "the serial line lost " + std::to_string(line.overrun) + " of " + std::to_string(sent_) +
         " bytes: the sketch's buffer of 64 bytes was full; it reads too rarely, or the program "
         "sends too much";
}

}  // namespace bbsim::controller
