// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An event that occurred.
#pragma once

#include <string>
#include <vector>

#include "model/sample.hpp"

namespace bbsim::model {

struct Occurrence {
  double t = 0;               // s
  std::string name;           // the key in the scenario's events
  bool stopped = false;       // whether it stopped the run
  Sample sample;              // without Sample::own; see `own`
  std::vector<double> own{};  // numbers of an external controller
};

}  // namespace bbsim::model
