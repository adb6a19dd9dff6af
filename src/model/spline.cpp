#include "model/spline.hpp"

#include <utility>

namespace bbsim::model {

Spline::Spline(std::vector<double> times, const std::vector<double>& values)
    : times_(std::move(times)) {
  const std::size_t last = times_.size() - 1;  // index of the last knot
  std::vector<double> h(last), slope(last);
  for (std::size_t i = 0; i < last; ++i) {
    h[i] = times_[i + 1] - times_[i];
    slope[i] = (values[i + 1] - values[i]) / h[i];
  }

  // Second derivatives m[i] at the knots: a tridiagonal system for the inner ones, whose first
  // and last rows take up m[0] and m[last] from the not-a-knot conditions.
  std::vector<double> diagonal(last + 1), upper(last + 1), lower(last + 1), m(last + 1);
  for (std::size_t i = 1; i < last; ++i) {
    lower[i] = h[i - 1];
    diagonal[i] = 2 * (h[i - 1] + h[i]);
    upper[i] = h[i];
    m[i] = 6 * (slope[i] - slope[i - 1]);
  }
  const double first_ratio = h[0] / h[1];
  const double last_ratio = h[last - 1] / h[last - 2];
  diagonal[1] += h[0] * (1 + first_ratio);
  upper[1] -= h[0] * first_ratio;
  diagonal[last - 1] += h[last - 1] * (1 + last_ratio);
  lower[last - 1] -= h[last - 1] * last_ratio;

  for (std::size_t i = 2; i < last; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    m[i] -= factor * m[i - 1];
  }
  m[last - 1] /= diagonal[last - 1];
  for (std::size_t i = last - 2; i >= 1; --i) m[i] = (m[i] - upper[i] * m[i + 1]) / diagonal[i];
  m[0] = (1 + first_ratio) * m[1] - first_ratio * m[2];
  m[last] = (1 + last_ratio) * m[last - 1] - last_ratio * m[last - 2];

  std::vector<Piece> pieces(last);
  for (std::size_t i = 0; i < last; ++i) {
    pieces[i] = {times_[i], values[i], slope[i] - h[i] * (2 * m[i] + m[i + 1]) / 6, m[i] / 2,
                 (m[i + 1] - m[i]) / (6 * h[i])};
  }
  pieces_ = std::make_shared<const std::vector<Piece>>(std::move(pieces));
}

}  // namespace bbsim::model
