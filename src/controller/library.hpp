// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A controller in a shared library (bbsim/controller.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "controller/child.hpp"
#include "controller/protocol.hpp"
#include "model/control/external_controller.hpp"
#include "sketch/wiring.hpp"

namespace bbsim::controller {

// The functions of a library, which stays open until the program ends.
struct LibraryFunctions;

class Library : public model::ExternalController {
 public:
  // Opens the library and creates a controller. Throws KeyError if either fails. `report` receives
  // the lines that a sketch prints.
  Library(const OwnController& own, const Setup& setup, Report report);
  ~Library() override;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  void begin() override;
  model::Commands command(const model::ControllerSample& sample, double* own) override;

  // Prepares for a run with this setup. Throws KeyError.
  void renew(const Setup& setup);

  [[nodiscard]] bool is(const OwnController& own) const {
    return path_ == path_of(own) && wiring_path_ == wiring_path_of(own);
  }
  // The library and the files of its wiring. Throws InputError.
  [[nodiscard]] static std::vector<std::string> files_of(const OwnController& own);

  // The serial line of a sketch, for a program (bbsim/wiring.h). Throws KeyError if the sketch has
  // none, or a camera there.
  void require_line() const;
  void send(std::string_view bytes, double delay);
  void receive(std::string& bytes);
  [[nodiscard]] bbsim_line line() const;

  // After samples: throws KeyError if a column of the scenario is none that the sketch printed.
  void require_columns() const;
  // The pins that the sketch drives although nothing is wired to them, as a sentence; may be empty.
  [[nodiscard]] std::string unheard() const;

 private:
  void fit_steppers(bbsim_wiring& wired) const;
  // The paths of the library and of its wiring, if any, from the current folder.
  [[nodiscard]] static std::string path_of(const OwnController& own);
  [[nodiscard]] static std::string wiring_path_of(const OwnController& own);
  void create();
  void destroy();
  [[nodiscard]] std::string last_error() const;
  void pass_on_prints();
  // Whether a sketch has printed a column; true of other libraries.
  [[nodiscard]] bool is_printed(std::size_t column) const;

  std::string path_, wiring_path_;
  Setup setup_;
  Report report_;
  std::optional<sketch::Wiring> wiring_;
  std::vector<std::string> printed_;  // lines since the last report
  std::size_t shown_ = 0;             // lines
  std::shared_ptr<const LibraryFunctions> functions_;
  void* controller_ = nullptr;
  bool fresh_ = false;  // no run since it was created or reset
};

}  // namespace bbsim::controller
