// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sees to it that runs of scenes have the controllers that are not built in.
#pragma once

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "controller/child.hpp"
#include "model/model.hpp"

namespace bbsim::controller {

class Library;
class Program;

// For runs one after another on one thread; a controller that can reset serves them all.
class Host {
 public:
  // `tell` gets what programs say on their standard error; `stop`, which may be null, ends all
  // waiting for them once it is true. Both outlive it.
  explicit Host(Tell tell, const std::atomic<bool>* stop = nullptr);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // Gives the scene's model its controller, if it has one of its own, which stays until the next
  // call. Throws KeyError if there can be none, or none that gives what output.columns asks for. A
  // program that does not answer as it should fails the run.
  void attach(const Scenario& scenario, model::Model& model);

  // The unit of a number of that name, if the controller says it.
  [[nodiscard]] std::optional<std::string> unit_of(std::string_view own_column) const;

  // What is known of the controller: a line each. Throws model::ControllerFault if it does not
  // begin as it should.
  [[nodiscard]] std::vector<std::string> describe() const;

  // Lets a program end by itself, as the destructor does too.
  void finish();

 private:
  void require_columns(const std::vector<std::string>& asked) const;

  Tell tell_;
  const std::atomic<bool>* stop_;
  std::shared_ptr<Program> program_;
  std::shared_ptr<Library> library_;
};

// The files that a controller of one's own is made of, as far as its scenario tells: the library,
// or each word of the command that names a file.
[[nodiscard]] std::vector<std::string> files_of(const Scenario& scenario);

}  // namespace bbsim::controller
