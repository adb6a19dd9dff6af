// Something that was watched for and happened.
#pragma once

#include <string>

#include "model/sample.hpp"

namespace bbsim::model {

struct Occurrence {
  double t = 0;          // s
  std::string name;      // as the scenario's key under events
  bool stopped = false;  // the run
  Sample sample;
};

}  // namespace bbsim::model
