// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Something that was watched for and happened.
#pragma once

#include <string>
#include <vector>

#include "model/sample.hpp"

namespace bbsim::model {

struct Occurrence {
  double t = 0;               // s
  std::string name;           // as the scenario's key under events
  bool stopped = false;       // the run
  Sample sample;              // without Sample::own, which stands here:
  std::vector<double> own{};  // of one's own controller
};

}  // namespace bbsim::model
