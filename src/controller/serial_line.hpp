// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A program and a sketch that speak over the serial line of the sketch's board.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "controller/library.hpp"
#include "controller/program.hpp"

namespace bbsim::controller {

class SerialLine : public model::ExternalController {
 public:
  // The setups are those of the two. Each column belongs to the program if its answer to the hello
  // names it, and else to the sketch, whose setup gets the rest.
  SerialLine(std::shared_ptr<Program> program, Setup of_program);
  // Throws KeyError.
  void connect(std::shared_ptr<Library> sketch);
  // A sketch's setup with the columns that are not the program's.
  [[nodiscard]] Setup without_columns(Setup of_sketch) const;

  void begin() override;
  model::Commands command(const model::ControllerSample& sample, double* own) override;

  // After samples: that no byte reached the sketch, or some were lost, as a sentence; may be empty.
  [[nodiscard]] std::string remark() const;

 private:
  std::string answer(const model::ControllerSample& sample);

  std::shared_ptr<Program> program_;
  std::shared_ptr<Library> sketch_;
  Setup setup_;
  std::vector<std::string> program_columns_;
  std::vector<double> numbers_, sketch_numbers_;  // of each one's columns
  std::string arrived_;                           // at the program, since its last sample
  std::size_t samples_ = 0, sent_ = 0;            // of the program; bytes
  double due_ = 0;                                // the time of its next sample, in its periods
  double baud_ = 0;                               // that it named, or 0
};

}  // namespace bbsim::controller
