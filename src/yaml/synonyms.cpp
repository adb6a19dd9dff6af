// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "yaml/synonyms.hpp"

#include <algorithm>
#include <array>

namespace bbsim::yaml {
namespace {

struct Synonym {
  std::string_view word, path;
};
constexpr std::array synonyms{
    Synonym{"servo", "gimbal.servo"},
    Synonym{"servos", "gimbal.servo"},
    Synonym{"motor", "gimbal.motor"},
    Synonym{"sensor", "controller.sensor"},
    Synonym{"camera", "controller.sensor"},
    Synonym{"sampling", "controller.sampling"},
    Synonym{"sample_time", "controller.sampling.period"},
    Synonym{"sampling_time", "controller.sampling.period"},
    Synonym{"delay", "controller.sampling.delay"},
    Synonym{"latency", "controller.sampling.delay"},
    Synonym{"noise", "controller.sensor.noise"},
    Synonym{"kd", "controller.pd.kv"},
    Synonym{"setpoint", "controller.reference"},
    Synonym{"set_point", "controller.reference"},
    Synonym{"target", "controller.reference"},
    Synonym{"max_rate", "gimbal.servo.rate_limit"},
    Synonym{"max_speed", "gimbal.servo.rate_limit"},
    Synonym{"speed", "gimbal.servo.rate_limit"},
    Synonym{"max_angle", "gimbal.servo.angle_limit"},
    Synonym{"dt", "time.step"},
    Synonym{"timestep", "time.step"},
    Synonym{"duration", "time.end"},
    Synonym{"disturbance", "ball.push"},
    Synonym{"force", "ball.push"},
    Synonym{"initial_position", "ball.position"},
    Synonym{"diameter", "ball.radius"},
    Synonym{"width", "plate.size"},
};

}  // namespace

std::string_view synonym(std::string_view word, std::span<const std::string_view> known) {
  const auto* const found = std::ranges::find(synonyms, word, &Synonym::word);
  if (found == synonyms.end()) return {};
  const std::string_view key = found->path.substr(found->path.rfind('.') + 1);
  const auto here = std::ranges::find(known, key);
  return here == known.end() ? found->path : *here;
}

}  // namespace bbsim::yaml
