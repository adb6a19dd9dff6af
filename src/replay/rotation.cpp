#include "replay/rotation.hpp"

#include <cmath>

namespace bbsim::replay {

Quaternion plane_orientation(const Mounting& mounting, double phi, double theta) {
  Quaternion turned = rotation_by({mounting.base_tilt, 0, 0});
  turned = product(turned, rotation_by({0, phi, 0}));
  turned = product(turned, rotation_by({0, 0, mounting.skew}));
  turned = product(turned, rotation_by({theta, 0, 0}));
  return product(turned, rotation_by({0, 0, mounting.yaw - mounting.skew}));
}

std::vector<Quaternion> rolled(const std::vector<double>& x, const std::vector<double>& y,
                               const std::vector<double>* gamma, double radius) {
  std::vector<Quaternion> result;
  result.reserve(x.size());
  Quaternion now{1, 0, 0, 0};
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (row > 0) {
      const double dgamma = gamma == nullptr ? 0 : (*gamma)[row] - (*gamma)[row - 1];
      const std::array<double, 3> turn{-(y[row] - y[row - 1]) / radius,
                                       (x[row] - x[row - 1]) / radius, dgamma};
      if (std::isfinite(turn[0] + turn[1] + turn[2])) {
        now = normalised(product(rotation_by(turn), now));
      }
    }
    result.push_back(now);
  }
  return result;
}

std::vector<Quaternion> orientation_of(const Run& run, double radius) {
  if (!run.orientation.empty()) return run.orientation;
  const Series* gamma = find_series(run, "gamma");
  return rolled(coordinate(run, "x"), coordinate(run, "y"),
                gamma == nullptr ? nullptr : &gamma->values, radius);
}

}  // namespace bbsim::replay
