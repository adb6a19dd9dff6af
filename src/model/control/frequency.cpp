#include "model/control/frequency.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "model/dense.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Real = std::function<double(double)>;

constexpr double pi = std::numbers::pi;

// The zero of f in [low, high], at whose ends it has different signs: by halves, to rounding.
double zero_between(const Real& f, double low, double high) {
  const bool rises = f(low) < 0;
  for (;;) {
    const double middle = low + (high - low) / 2;
    if (middle <= low || middle >= high) return middle;
    ((f(middle) < 0) == rises ? low : high) = middle;
  }
}

// All zeros of f that its values at the points, and the dips between them, show.
std::vector<double> zeros_of(const Real& f, const std::vector<double>& points) {
  std::vector<double> values, zeros;
  for (const double w : points) values.push_back(f(w));
  const auto look = [&](double low, double at_low, double high, double at_high) {
    if ((at_low < 0) != (at_high < 0)) zeros.push_back(zero_between(f, low, high));
  };
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const bool dips = i > 0 && (values[i] < 0) == (values[i - 1] < 0) &&
                      (values[i] < 0) == (values[i + 1] < 0) &&
                      std::abs(values[i]) < std::abs(values[i - 1]) &&
                      std::abs(values[i]) < std::abs(values[i + 1]);
    if (!dips) {
      look(points[i], values[i], points[i + 1], values[i + 1]);
      continue;
    }
    // The least size on both sides of the point, by golden sections.
    constexpr double golden = 0.6180339887498949;
    const double sign = values[i] < 0 ? -1 : 1;
    double a = points[i - 1], b = points[i + 1];
    for (int k = 0; k < 80 && b - a > 1e-15 * b; ++k) {
      const double c = b - golden * (b - a), d = a + golden * (b - a);
      if (sign * f(c) < sign * f(d)) {
        b = d;
      } else {
        a = c;
      }
    }
    const double lowest = a + (b - a) / 2, value = f(lowest);
    look(points[i - 1], values[i - 1], lowest, value);
    look(lowest, value, points[i + 1], values[i + 1]);
  }
  return zeros;
}

}  // namespace

FrequencyResponse::FrequencyResponse(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                     const Eigen::MatrixXd& c, const Eigen::MatrixXd& d,
                                     double period)
    : a_(a), b_(b), c_(c), d_(d), period_(period) {
  if (a.rows() < 3) return;  // as it is
  const HessenbergForm form = hessenberg_form(a);
  a_ = form.h;
  b_ = product(form.q.transpose(), b);
  c_ = product(c, form.q);
}

Complex FrequencyResponse::at(double w, Index i, Index j) const {
  const Index n = a_.rows();
  const Complex s = period_ > 0 ? std::polar(1.0, w * period_) : Complex(0, w);
  Eigen::MatrixXcd m = (-a_).cast<Complex>();
  m.diagonal().array() += s;
  Eigen::VectorXcd x = b_.col(j).cast<Complex>();
  // Only what is next to the diagonal has to go, by rows in either order.
  for (Index k = 0; k + 1 < n; ++k) {
    if (std::abs(m(k + 1, k)) > std::abs(m(k, k))) {
      m.row(k).tail(n - k).swap(m.row(k + 1).tail(n - k));
      std::swap(x[k], x[k + 1]);
    }
    if (m(k, k) == Complex(0)) continue;
    const Complex factor = m(k + 1, k) / m(k, k);
    m.row(k + 1).tail(n - k) -= factor * m.row(k).tail(n - k);
    x[k + 1] -= factor * x[k];
  }
  m.triangularView<Eigen::Upper>().solveInPlace(x);
  return (c_.row(i).cast<Complex>() * x)(0) + d_(i, j);
}

std::vector<double> frequencies_to_look_at(const std::vector<Complex>& poles, double period) {
  // As rates, of samples too: z = exp(s T).
  std::vector<Complex> rates;
  for (const Complex& pole : poles) {
    if (period <= 0) {
      rates.push_back(pole);
    } else if (std::abs(pole) > 1e-6) {
      rates.push_back(std::log(pole) / period);
    }
  }
  double slowest = Margins::none, fastest = 0;
  for (const Complex& rate : rates) {
    fastest = std::max(fastest, std::abs(rate));
    // A double pole at 0 is rounded to one that is not.
    if (std::abs(rate) > 1e-6) slowest = std::min(slowest, std::abs(rate));
  }
  if (!(fastest > 0)) fastest = 1;
  slowest = std::min(slowest, fastest);
  const double low = 1e-3 * slowest;
  const double high = period > 0 ? pi / period : 1e3 * fastest;
  // Delays of a hundred periods make a hundred states, whose squares each point costs.
  const double size = static_cast<double>(poles.size());
  const double a_decade = std::clamp(200 * 2500 / (size * size), 20.0, 200.0);
  std::vector<double> points;
  const auto count = static_cast<std::size_t>(a_decade * std::max(1.0, std::log10(high / low)));
  for (std::size_t i = 0; i <= count; ++i) {
    points.push_back(low *
                     std::pow(high / low, static_cast<double>(i) / static_cast<double>(count)));
  }
  // A resonance is as narrow as its pole is near to the axis.
  for (const Complex& rate : rates) {
    for (const double away : {-4.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 4.0}) {
      points.push_back(std::abs(rate.imag()) + away * std::abs(rate.real()));
    }
  }
  std::erase_if(points, [&](double w) { return !(w >= low && w <= high); });
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

Margins margins_of(const std::function<Complex(double)>& open_loop,
                   const std::vector<double>& frequencies) {
  Margins margins;
  for (const double w : zeros_of([&](double at) { return open_loop(at).imag(); }, frequencies)) {
    const Complex l = open_loop(w);
    // The imaginary part changes its sign at a pole on the axis too.
    if (!(l.real() < 0) || !(std::abs(l.imag()) < 1e-6 * std::abs(l.real()))) continue;
    const double factor = -1 / l.real();
    if (factor >= 1 && factor < margins.gain) {
      margins.gain = factor;
      margins.gain_at = w;
    } else if (factor < 1 && factor > margins.reduction) {
      margins.reduction = factor;
      margins.reduction_at = w;
    }
  }
  const auto size = [&](double at) { return std::log(std::abs(open_loop(at))); };
  for (const double w : zeros_of(size, frequencies)) {
    double phase = std::arg(open_loop(w)) + pi;  // 0 to 2 pi
    const double delay = phase / w;
    if (phase > pi) phase -= 2 * pi;
    if (std::abs(phase) < std::abs(margins.phase)) {
      margins.phase = phase;
      margins.phase_at = w;
    }
    if (delay < margins.delay) {
      margins.delay = delay;
      margins.delay_at = w;
    }
  }
  return margins;
}

double bandwidth_of(const std::function<Complex(double)>& closed_loop,
                    const std::vector<double>& frequencies) {
  const double border = std::abs(closed_loop(0)) / std::numbers::sqrt2;
  if (!std::isfinite(border) || border == 0) return Margins::none;
  const Real above = [&](double w) { return std::abs(closed_loop(w)) - border; };
  double last = 0;
  for (const double w : frequencies) {
    if (above(w) < 0) return zero_between(above, last, w);
    last = w;
  }
  return Margins::none;
}

}  // namespace bbsim::model
