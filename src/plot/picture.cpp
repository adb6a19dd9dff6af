#include "plot/picture.hpp"

#include <cmath>
#include <limits>

namespace bbsim::plot {

double Axis::fraction(double value) const {
  if (!std::isfinite(value)) return std::numeric_limits<double>::quiet_NaN();
  if (!log) return (value / 2 - low / 2) / (high / 2 - low / 2);  // halves: no range overflows
  if (value <= 0) return std::numeric_limits<double>::quiet_NaN();
  return (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
}

}  // namespace bbsim::plot
