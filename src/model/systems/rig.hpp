// What a built rig has beside the right-hand side: what switches and what samples.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/systems/rig_loop.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::model {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

class ExternalController;

// A controller in discrete time and its sensor.
struct SampledLoop {
  Sampling sampling;
  Sensor sensor;
  ControlLaw law;  // what is computed at each sample; held, if that is not for the model to know
  double limit = unlimited;
  // Under a held law: who is asked instead (control/external_controller.hpp), which whoever runs
  // the model has to see to; and the names of the numbers that it gives for columns.
  std::shared_ptr<ExternalController> external{};
  std::vector<std::string> own_columns{};
};

// How the servos and the controller of a closed loop that is a RigLoop differ from ideal ones.
struct Rig {
  double angle_limit = unlimited;         // rad
  double rate_limit = unlimited;          // rad/s
  double acceleration_limit = unlimited;  // rad/s^2
  double dead_band = 0, backlash = 0;     // rad
  std::optional<double> time_constant;    // of a servo of first order, s
  Pair offset{0, 0};                      // angle of the plane at the servo's zero, rad
  // A continuous law's command is kept within it; in gravity compensation, the command's sine.
  double command_limit = unlimited;
  std::optional<SampledLoop> sampled;

  [[nodiscard]] bool switches() const {
    return angle_limit < unlimited || rate_limit < unlimited || acceleration_limit < unlimited ||
           backlash > 0 || command_limit < unlimited;
  }
};

}  // namespace bbsim::model
