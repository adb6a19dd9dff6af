// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "model/control/frequency.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/maxima.hpp"
#include "model/eigenvalues.hpp"

namespace bbsim::model {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;

constexpr double pi = std::numbers::pi;

// A real function of a response, with a bound on its rounding.
struct Rounded {
  double value, rounding;
  [[nodiscard]] bool certain() const { return std::abs(value) > rounding; }
};
using Measure = Rounded (*)(const FrequencyResponse::Careful&);

Rounded imaginary_part(const FrequencyResponse::Careful& of) {
  return {of.value.imag(), of.rounding};
}

Rounded log_of_size(const FrequencyResponse::Careful& of) {
  const double size = std::abs(of.value);
  return {std::log(size), of.rounding / size};
}

// Zeros of a measure of the loop that show in its values at the points or in dips between them,
// without those that rounding makes. `responses`: the loop's at the points.
std::vector<double> zeros_of(Measure f, const FrequencyResponse& loop,
                             const std::vector<double>& points,
                             const std::vector<Complex>& responses) {
  const auto careful = [&](double w) { return f(loop.carefully_at(w, 0, 0)); };
  std::vector<double> at, values, known;
  const auto add = [&](double w, double value) {
    at.push_back(w);
    values.push_back(value);
  };
  for (const Complex& response : responses) known.push_back(f({response, 0}).value);
  for (std::size_t i = 0; i < points.size(); ++i) {
    add(points[i], known[i]);
    if (i == 0 || i + 1 == points.size()) continue;
    const bool dips =
        (known[i] < 0) == (known[i - 1] < 0) && (known[i] < 0) == (known[i + 1] < 0) &&
        std::abs(known[i]) < std::abs(known[i - 1]) && std::abs(known[i]) < std::abs(known[i + 1]);
    if (!dips) continue;
    // The greatest value with the other sign.
    const double sign = known[i] < 0 ? 1 : -1;
    const auto at_point = [&](std::size_t k) { return Peak{points[k], sign * known[k]}; };
    const Peak top = climb(within(at_point(i - 1), at_point(i), at_point(i + 1)),
                           good_place * (points[i + 1] - points[i - 1]), [&](double w) {
                             return sign * f({loop.at(w, 0, 0), 0}).value;
                           });
    const double lowest = top.at, value = sign * top.value;
    if (lowest == points[i] || (value < 0) == (known[i] < 0)) continue;
    add(lowest, value);
    if (lowest < points[i]) {
      std::swap(at[at.size() - 1], at[at.size() - 2]);
      std::swap(values[at.size() - 1], values[at.size() - 2]);
    }
  }
  std::vector<double> zeros;
  for (std::size_t i = 0; i + 1 < at.size(); ++i) {
    if ((values[i] < 0) == (values[i + 1] < 0)) continue;
    // Bracket it between the nearest points before and after it whose signs are certain.
    std::size_t low = i, high = i + 1;
    Rounded at_low = careful(at[low]), at_high = careful(at[high]);
    while (low > 0 && !at_low.certain()) at_low = careful(at[--low]);
    while (high + 1 < at.size() && !at_high.certain()) at_high = careful(at[++high]);
    i = high - 1;
    if (!at_low.certain() || !at_high.certain()) continue;
    if ((at_low.value < 0) == (at_high.value < 0)) continue;
    zeros.push_back(zero_between(at[low], at[high], [&](double w) { return careful(w).value; }));
  }
  return zeros;
}

// Transforms the states so that A is upper Hessenberg. Elimination keeps small entries beside large
// ones accurate.
void make_hessenberg(Eigen::MatrixXd& a, Eigen::MatrixXd& b, Eigen::MatrixXd& c) {
  const Index n = a.rows();
  for (Index k = 1; k + 1 < n; ++k) {
    Index pivot = k;
    a.col(k - 1).tail(n - k).cwiseAbs().maxCoeff(&pivot);
    pivot += k;
    if (a(pivot, k - 1) == 0) continue;
    if (pivot != k) {
      a.row(pivot).swap(a.row(k));
      a.col(pivot).swap(a.col(k));
      b.row(pivot).swap(b.row(k));
      c.col(pivot).swap(c.col(k));
    }
    for (Index i = k + 1; i < n; ++i) {
      const double factor = a(i, k - 1) / a(k, k - 1);
      if (factor == 0) continue;
      a.row(i) -= factor * a.row(k);
      b.row(i) -= factor * b.row(k);
      a.col(k) += factor * a.col(i);
      c.col(k) += factor * c.col(i);
      a(i, k - 1) = 0;
    }
  }
}

}  // namespace

FrequencyResponse::FrequencyResponse(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                     const Eigen::MatrixXd& c, const Eigen::MatrixXd& d,
                                     double period)
    : a_(a), b_(b), c_(c), d_(d), period_(period) {
  Eigen::VectorXd scale;
  a_ = balanced(a, &scale);
  b_.array().colwise() /= scale.array();
  c_.array().rowwise() *= scale.transpose().array();
  balanced_a_ = a_;
  balanced_b_ = b_;
  balanced_c_ = c_;
  make_hessenberg(a_, b_, c_);
}

double FrequencyResponse::last() const {
  return period_ > 0 ? pi / period_ : Margins::none;
}

Complex FrequencyResponse::point(double w) const {
  if (!(period_ > 0)) return {0, w};
  return w == last() ? Complex(-1) : std::polar(1.0, w * period_);
}

Complex FrequencyResponse::at(double w, Index i, Index j) const {
  const Index n = a_.rows();
  Eigen::MatrixXcd m = (-a_).cast<Complex>();
  m.diagonal().array() += point(w);
  Eigen::VectorXcd x = b_.col(j).cast<Complex>();
  // Compare pivots as LAPACK does: a root for each would take a quarter of the time.
  const auto size = [](const Complex& z) { return std::abs(z.real()) + std::abs(z.imag()); };
  // Eliminate the subdiagonal, swapping rows if needed.
  for (Index k = 0; k + 1 < n; ++k) {
    if (size(m(k + 1, k)) > size(m(k, k))) {
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

FrequencyResponse::Careful FrequencyResponse::carefully_at(double w, Index i, Index j) const {
  // |c (sI - A)^-1| |what is rounded| |(sI - A)^-1 b|, with the entries as given: those of the
  // Hessenberg form hide the terms that they sum.
  const Index n = balanced_a_.rows();
  Eigen::MatrixXcd m = (-balanced_a_).cast<Complex>();
  m.diagonal().array() += point(w);
  const Eigen::PartialPivLU<Eigen::MatrixXcd> factors(m);
  const Eigen::VectorXd b = balanced_b_.col(j), c = balanced_c_.row(i);
  const Eigen::VectorXcd x = factors.solve(b.cast<Complex>()),
                         y = factors.transpose().solve(c.cast<Complex>());
  double sum = std::abs(d_(i, j));
  for (Index p = 0; p < n; ++p) {
    const double left = std::abs(y[p]), right = std::abs(x[p]);
    sum += left * std::abs(point(w)) * right + left * std::abs(b[p]) + std::abs(c[p]) * right;
    for (Index q = 0; q < n; ++q) sum += left * std::abs(balanced_a_(p, q)) * std::abs(x[q]);
  }
  // With a period, the entries are those of an exponential.
  const double rounding = (period_ > 0 ? 50 : 10) * std::numeric_limits<double>::epsilon() * sum;
  Complex value = d_(i, j);
  for (Index p = 0; p < n; ++p) value += c[p] * x[p];
  return {value, std::isfinite(rounding) ? rounding : Margins::none};
}

std::vector<double> frequencies_to_look_at(const std::vector<Complex>& open,
                                           const std::vector<Complex>& closed, double period) {
  // Poles as rates; with a period, from z = exp(s T).
  std::vector<Complex> rates;
  double slowest = Margins::none, fastest = 0;
  const auto add = [&](const std::vector<Complex>& poles, double least) {
    for (const Complex& pole : poles) {
      if (period > 0 && !(std::abs(pole) > 1e-6)) continue;
      const Complex rate = period > 0 ? std::log(pole) / period : pole;
      rates.push_back(rate);
      fastest = std::max(fastest, std::abs(rate));
      if (std::abs(rate) > least) slowest = std::min(slowest, std::abs(rate));
    }
  };
  // Rounding moves a double pole of the open loop off 0.
  add(open, 1e-6);
  add(closed, period > 0 ? 1e-9 / period : 0);
  if (!(fastest > 0)) fastest = 1;
  slowest = std::min(slowest, fastest);
  const double low = 1e-3 * slowest;
  const double high = period > 0 ? pi / period : 1e3 * fastest;
  // Delays of a hundred periods add a hundred states, and each point costs their square.
  const double size = static_cast<double>(rates.size());
  const double a_decade = std::clamp(200 * 2500 / (size * size), 20.0, 200.0);
  std::vector<double> points;
  const auto count = static_cast<std::size_t>(a_decade * std::max(1.0, std::log10(high / low)));
  for (std::size_t i = 0; i <= count; ++i) {
    points.push_back(low *
                     std::pow(high / low, static_cast<double>(i) / static_cast<double>(count)));
  }
  // A resonance is as narrow as its pole is close to the axis.
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

namespace {

// Adds gain margins, from the imaginary part of the response.
void add_gains(Margins& margins, const FrequencyResponse& open_loop,
               const std::vector<double>& frequencies, const std::vector<Complex>& responses,
               double slowest) {
  const auto loop = [&](double w) { return open_loop.carefully_at(w, 0, 0); };
  const auto cross = [&margins](double w, double l) {
    const double factor = -1 / l;
    if (factor >= 1 && factor < margins.gain) {
      margins.gain = factor;
      margins.gain_at = w;
    } else if (factor < 1 && factor > margins.reduction) {
      margins.reduction = factor;
      margins.reduction_at = w;
    }
  };
  for (const double w : zeros_of(imaginary_part, open_loop, frequencies, responses)) {
    if (w < slowest) continue;
    const Complex l = loop(w).value;
    // The imaginary part also changes sign at a pole on the axis.
    if (l.real() < 0 && std::abs(l.imag()) < 1e-6 * std::abs(l.real())) cross(w, l.real());
  }
  // At both ends of the range the response is real without a change of sign.
  for (const double w : {0.0, open_loop.last()}) {
    if (!std::isfinite(w)) continue;
    const FrequencyResponse::Careful end = loop(w);
    const double l = end.value.real();
    // The response at 0 counts only if it holds up to the slowest frequency that counts. It does
    // not beside a pole that rounding has moved off 0.
    const double first = std::max(slowest, frequencies.front());
    const bool counts = w > 0 || std::abs(loop(first).value - l) < 0.5 * std::abs(l);
    if (l < 0 && counts && end.rounding < 1e-3 * std::abs(l)) cross(w, l);
  }
}

// Adds margins of phase and delay, from the size of the response.
void add_phases(Margins& margins, const FrequencyResponse& open_loop,
                const std::vector<double>& frequencies, const std::vector<Complex>& responses) {
  for (const double w : zeros_of(log_of_size, open_loop, frequencies, responses)) {
    double phase = std::arg(open_loop.carefully_at(w, 0, 0).value) + pi;  // 0 to 2 pi
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
}

}  // namespace

Margins margins_of(const FrequencyResponse& open_loop, const std::vector<double>& frequencies,
                   double slowest, MarginParts parts) {
  std::vector<Complex> responses;
  responses.reserve(frequencies.size());
  for (const double w : frequencies) responses.push_back(open_loop.at(w, 0, 0));
  Margins margins;
  if (parts.gains) add_gains(margins, open_loop, frequencies, responses, slowest);
  if (parts.phases) add_phases(margins, open_loop, frequencies, responses);
  return margins;
}

double bandwidth_of(const std::function<Complex(double)>& closed_loop,
                    const std::vector<double>& frequencies) {
  const double border = std::abs(closed_loop(0)) / std::numbers::sqrt2;
  if (!std::isfinite(border) || border == 0) return Margins::none;
  const auto above = [&](double w) { return std::abs(closed_loop(w)) - border; };
  double last = 0;
  for (const double w : frequencies) {
    if (above(w) < 0) return zero_between(last, w, above);
    last = w;
  }
  return Margins::none;
}

}  // namespace bbsim::model
