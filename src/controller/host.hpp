// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Gives runs of scenes their external controllers.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "controller/child.hpp"
#include "controller/protocol.hpp"
#include "model/model.hpp"

namespace bbsim::controller {

class Library;
class Program;
class SerialLine;

// For consecutive runs on one thread. A controller that can reset serves all of them.
class Host {
 public:
  // `tell` receives the lines of programs' standard error. `stop`, which may be null, ends all
  // waiting for them once it is true. Both must outlive the host.
  explicit Host(Report report, const std::atomic<bool>* stop = nullptr);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Gives the scene's model its external controller, if any, until the next call. Throws KeyError
  // if the controller cannot start or lacks a column of output.columns. A program that answers
  // wrongly fails the run.
  void attach(const Scenario& scenario, model::Model& model);

  // The unit of a number of your own controller, if the controller states it.
  [[nodiscard]] std::optional<std::string> unit_of(std::string_view own_column) const;

  // Describes the controller in lines of text. Throws model::ControllerFault if it does not begin
  // properly.
  [[nodiscard]] std::vector<std::string> describe() const;

  // After samples: throws KeyError if a column of the scenario is none that a sketch printed.
  void require_printed() const;
  // After samples: what is wrong with the serial line between a program and a sketch, as a
  // sentence; may be empty.
  [[nodiscard]] std::string line_remark() const;
  // What a sketch drives although nothing is wired to it, as a sentence; may be empty.
  [[nodiscard]] std::string unheard() const;

  // Lets a program end by itself, as the destructor also does.
  void finish();

 private:
  void start_program(const OwnController& own, const Setup& setup);
  void open_library(const OwnController& own, const Setup& setup);
  void require_columns(const std::vector<std::string>& asked) const;

  Report report_;
  const std::atomic<bool>* stop_;
  std::shared_ptr<Program> program_;
  std::shared_ptr<Library> library_;
  std::shared_ptr<SerialLine> line_;
};

// The files of your own controller, as far as its scenario tells: the library and its wiring, or
// each word of the command that names a file.
[[nodiscard]] std::vector<std::string> files_of(const Scenario& scenario);

}  // namespace bbsim::controller
