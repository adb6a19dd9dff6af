// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A controller in a shared library (bbsim/controller.h).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "controller/setup.hpp"
#include "model/control/external_controller.hpp"
#include "sketch/wiring.hpp"

namespace bbsim::controller {

// The functions of a library, which stays open until the program ends.
struct LibraryFunctions;

class Library : public model::ExternalController {
 public:
  // Opens the library and creates a controller. Throws KeyError if either fails.
  Library(const OwnController& own, const Setup& setup);
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

 private:
  // The paths of the library and of its wiring, if any, from the current folder.
  [[nodiscard]] static std::string path_of(const OwnController& own);
  [[nodiscard]] static std::string wiring_path_of(const OwnController& own);
  void create();
  void destroy();
  [[nodiscard]] std::string last_error() const;

  std::string path_, wiring_path_;
  Setup setup_;
  std::optional<sketch::Wiring> wiring_;
  std::shared_ptr<const LibraryFunctions> functions_;
  void* controller_ = nullptr;
  bool fresh_ = false;  // no run since it was created or reset
};

}  // namespace bbsim::controller
