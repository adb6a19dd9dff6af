// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Step metrics and instants of the continuous motion, against closed forms.
#include <cmath>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "record/curve.hpp"
#include "record/instants.hpp"
#include "record/recorder.hpp"
#include "record/stored_run.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"
#include "support/measured.hpp"

namespace bbsim_test::test_instants {

using namespace bbsim;
using namespace bbsim::record;

namespace {

// 1 - exp(-zeta w t) (cos wd t + zeta w / wd sin wd t), of s^2 + 2 zeta w s + w^2.
struct SecondOrder {
  double w, zeta;
  [[nodiscard]] double wd() const { return w * std::sqrt(1 - zeta * zeta); }
  [[nodiscard]] double at(double t) const {
    return 1 -
           std::exp(-zeta * w * t) * (std::cos(wd() * t) + zeta * w / wd() * std::sin(wd() * t));
  }
  // The time at which it reaches the level, in an interval in which it is monotonic.
  [[nodiscard]] double time_of(double level, double low, double high) const {
    const bool rises = at(low) < level;
    for (int i = 0; i < 200; ++i) {
      const double middle = (low + high) / 2;
      ((at(middle) < level) == rises ? low : high) = middle;
    }
    return low;
  }
  [[nodiscard]] double peak_time(int number) const { return number * std::numbers::pi / wd(); }
  [[nodiscard]] double overshoot() const { return std::exp(-zeta * w * peak_time(1)); }
};

std::vector<double> measure_run(const Scenario& scene, const std::vector<std::string>& names,
                                solve::Tolerances tolerances) {
  const bbsim_test::MeasuredRun made =
      measured(scene, scenario::measures_named(names, scene), Method::automatic, tolerances);
  REQUIRE(made.outcome.ending == solve::Ending::done);
  return made.values;
}

// Adds a piece of a curve: f of the part of the time between two times.
template <class Function>
void add(Curve& curve, double from, double to, Function f) {
  static ChebyshevTables tables;  // the curve refers to them
  const ChebyshevPoints& points = tables.points(8);
  std::vector<double> values;
  for (std::size_t i = 0; i < points.size(); ++i) values.push_back(f(points[i]));
  curve.add_piece(from, to, points, values.data());
}

// The command stays at its limit, 0.1 rad: the servo gives its step response.
Scenario servo_step(double w, double zeta) {
  return parse_scenario(
      "ball: {radius: 0.01}\n"
      "gimbal: {servo: {natural_frequency: " +
          std::to_string(w) + ", damping: " + std::to_string(zeta) +
          "}}\n"
          "controller: {pd: {kp: [[1, 0], [0, 1]], kv: 0}, drives: angle, limit: 0.1,\n"
          "  reference: {point: [1000, -1000]}}\n"
          "time: {end: 12, step: 1}\n",
      "step.yaml");
}

}  // namespace

TEST_CASE("step metrics of a servo agree with the closed form") {
  const double zeta = GENERATE(0.3, 0.5, 0.7);
  const SecondOrder exact{5, zeta};
  const auto values =
      measure_run(servo_step(5, zeta),
                  {"phi.RiseTime", "phi.SettlingTime", "phi.SettlingMin", "phi.SettlingMax",
                   "phi.Overshoot", "phi.Undershoot", "phi.Peak", "phi.PeakTime",
                   "phi.SteadyStateValue", "theta.Overshoot", "theta.Peak", "when phi=0.05 rise=1",
                   "find phi_rate when phi=0.1 fall=1", "find phi at 0.25"},
                  {1e-12, 1e-14});
  // At the run's end, 12 s, at most 1e-8 of the motion remains, so the final value, to which the
  // metrics refer, differs by that.
  const double last = exact.at(12), first_peak = exact.peak_time(1);
  const auto level = [&](double part) { return exact.time_of(part * last, 0, first_peak); };
  CAPTURE(zeta);
  CHECK(values[0] == Approx(level(0.9) - level(0.1)).epsilon(1e-9));
  // The last time at 2 % follows the last extreme outside that band.
  int number = 1;
  while (std::abs(exact.at(exact.peak_time(number + 1)) / last - 1) >= 0.02) ++number;
  const double border = exact.at(exact.peak_time(number)) > last ? 1.02 * last : 0.98 * last;
  CHECK(values[1] ==
        Approx(exact.time_of(border, exact.peak_time(number), exact.peak_time(number + 1)))
            .epsilon(1e-9));
  const double dip = exact.at(exact.peak_time(2)), high = exact.at(first_peak);
  CHECK(values[2] == Approx(0.1 * std::min(dip, 0.9 * last)).epsilon(1e-9));
  CHECK(values[3] == Approx(0.1 * high).epsilon(1e-9));
  CHECK(values[4] == Approx(100 * (high / last - 1)).epsilon(1e-9));
  CHECK(high == Approx(1 + exact.overshoot()).epsilon(1e-12));
  CHECK(values[5] < 1e-10);  // rounding of a polynomial that begins at 0
  CHECK(values[6] == Approx(0.1 * high).epsilon(1e-9));
  CHECK(values[7] == Approx(first_peak).epsilon(1e-9));
  CHECK(values[8] == Approx(0.1 * last).epsilon(1e-9));
  // The other axis moves in the opposite direction.
  CHECK(values[9] == Approx(values[4]).epsilon(1e-9));
  CHECK(values[10] == Approx(values[6]).epsilon(1e-9));
  CHECK(values[11] == Approx(exact.time_of(0.5, 0, first_peak)).epsilon(1e-9));
  const double falls = exact.time_of(1, first_peak, exact.peak_time(2));
  const double h = 1e-5;
  CHECK(values[12] ==
        Approx(0.1 * (exact.at(falls + h) - exact.at(falls - h)) / (2 * h)).epsilon(1e-7));
  CHECK(values[13] == Approx(0.1 * exact.at(0.25)).epsilon(1e-9));
}

TEST_CASE("a response that starts in the wrong direction has an undershoot") {
  // A ball on a tilting plane first moves the wrong way: x'' = a phi - r phi''. Compared with very
  // dense rows.
  Scenario scene = servo_step(5, 0.7);
  scene.ball.radius = 0.3;
  scene.time = {1, 1e-5};
  // The step ends just beyond the ball's final position, so that the command stays at its limit.
  const double reference = (1 + 1e-4) * measure_run(scene, {"end_x"}, {1e-11, 1e-13})[0];
  scene.controller->reference = PointReference{{reference, -1000}};
  scene.controller->kp = {{{1e6, 0}, {0, 1e6}}};
  const std::vector<std::string> names{"x.Undershoot", "x.RiseTime", "x.SettlingTime",
                                       "x.PeakTime"};
  const auto values = measure_run(scene, names, {1e-11, 1e-13});
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  solve::Trajectory rows(model.row_size());
  static_cast<void>(solve::integrate(model, Method::automatic, {1e-11, 1e-13}, grid, rows));
  file::Table table{{"t", "x", "x_reference"}, {{}, {}, {}}};
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    table.columns[0].numbers.push_back(grid[i]);
    table.columns[1].numbers.push_back(model.sample(grid[i], rows.row(i)).ball.x);
    table.columns[2].numbers.push_back(reference);
  }
  const StoredRun stored(table, "rows.csv");
  const auto measures = stored.measures_named(names);
  CHECK(values[0] > 1);
  for (std::size_t m = 0; m < measures.size(); ++m) {
    CAPTURE(names[m]);
    // Linear interpolation has a second-order error in the row distance.
    CHECK(stored.value_of(measures[m]).value == Approx(values[m]).epsilon(1e-6));
  }
}

TEST_CASE("crossings are counted, touches are not") {
  // -(t - 1)^2 + 1 on [0, 2] touches 1; then a jump to 2, and down to -1 on [2, 5].
  Curve curve;
  add(curve, 0, 2, [](double s) { return 1 - (2 * s - 1) * (2 * s - 1); });
  add(curve, 2, 5, [](double s) { return 2 - 3 * s; });
  using Way = scenario::Instant::Way;
  CHECK_FALSE(curve.crossing(1, Way::rise, 2));
  CHECK(curve.crossing(1, Way::rise, 1)->t == 2);  // the jump
  CHECK(curve.crossing(1, Way::fall, 1)->t == Approx(3).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::either, 1)->t == Approx(0.5).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::either, 2)->t == Approx(1.5).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::either, 0)->t == Approx(3.25).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::rise, 0)->t == 2);
  // It begins at 0, which is no crossing; neither is the end of the first piece.
  CHECK(curve.crossing(0, Way::either, 1)->t == Approx(4).epsilon(1e-14));
  CHECK_FALSE(curve.crossing(0, Way::either, 2));
  const Curve::Extreme greatest = curve.greatest(1), least = curve.greatest(-1);
  CHECK(greatest.value == 2);
  CHECK(greatest.t == 2);
  CHECK(least.value == Approx(-1).epsilon(1e-14));
  CHECK(curve.greatest(-1, curve.place_at(4.5)).t == 5);
  CHECK(curve.value(*curve.place_at(1.25)) == Approx(0.9375).epsilon(1e-14));
  CHECK_FALSE(curve.place_at(5.5));
  CHECK_FALSE(curve.place_at(-1));
}

TEST_CASE("stored rows whose times go back are refused") {
  CHECK_THROWS_AS(StoredRun({{"t", "x"}, {{1, 0}, {1, 1}}}, "back.csv"), InputError);
}

TEST_CASE("step metrics do not depend on the start") {
  Scenario scene = servo_step(5, 0.5);
  const std::vector<std::string> names{"phi.Overshoot", "phi.RiseTime", "phi.SettlingTime",
                                       "phi.PeakTime"};
  const auto from_zero = measure_run(scene, names, {1e-11, 1e-13});
  scene.gimbal.start.phi = -0.2;
  const auto from_elsewhere = measure_run(scene, names, {1e-11, 1e-13});
  for (std::size_t i = 0; i < names.size(); ++i) {
    CHECK(from_elsewhere[i] ==
          Approx(from_zero[i]).epsilon(1e-8));  // two runs, each with its own error
  }
}

TEST_CASE("a motion that starts at a level stays above or below it from the start") {
  const Scenario ramps = parse_scenario(
      "ball: {radius: 0.01}\n"
      "gimbal: {motion: {phi: {ramp: {start: -0.1, rate: 0.1}},\n"
      "                  theta: {ramp: {start: 0.1, rate: -0.1}}}}\n"
      "time: {end: 2, step: 0.5}\n",
      "ramps.yaml");
  const auto values = measure_run(
      ramps, {"when phi stays above -0.1", "when theta stays below 0.1"}, {1e-8, 1e-10});
  CHECK(values[0] == 0);
  CHECK(values[1] == 0);
}

TEST_CASE("a level exceeded only by rounding counts as touched") {
  using Way = scenario::Instant::Way;
  // Up to the level, switched late by `too_much`, along it, and down again.
  const auto plateau = [&](double too_much) {
    Curve curve;
    add(curve, 10, 10.01, [&](double s) { return s * (1 + too_much); });
    add(curve, 10.01, 11, [](double) { return 1.0; });
    add(curve, 11, 11.01, [](double s) { return 1 - s; });
    return curve;
  };
  // A time of 10 s is rounded to 1e-15 s, in which the curve moves 1e-13.
  const Curve touched = plateau(1e-13);
  CHECK_FALSE(touched.crossing(1, Way::either, 1));
  CHECK(touched.last_at_least(1, 1)->t == Approx(11).epsilon(1e-15));
  const Curve crossed = plateau(1e-10);
  REQUIRE(crossed.crossing(1, Way::rise, 1));
  CHECK(crossed.crossing(1, Way::rise, 1)->t == Approx(10.01).epsilon(1e-12));
  CHECK(crossed.crossing(1, Way::fall, 1)->t == Approx(10.01).epsilon(1e-12));
  // A servo at its rate limit.
  const Scenario servo = parse_scenario(
      "ball: {radius: 0.01}\n"
      "gimbal: {servo: {natural_frequency: 20, damping: 0.7, rate_limit: 1.0}}\n"
      "controller: {drives: angle, limit: 0.5, sampling: {period: 0.2},\n"
      "  pd: {kp: [[20, 0], [0, -20]], kv: [[0.4, 0], [0, -0.4]]},\n"
      "  reference: {circle: {radius: 0.05, rate: 1}}}\n"
      "time: {end: 3, step: 0.1}\n",
      "servo.yaml");
  const auto values = measure_run(servo,
                                  {"when phi_rate=1", "when phi_rate=-1",
                                   "when theta_rate=1 "
                                   "cross=last",
                                   "when phi_rate=0.999"},
                                  {1e-8, 1e-10});
  CHECK(std::isnan(values[0]));
  CHECK(std::isnan(values[1]));
  CHECK(std::isnan(values[2]));
  CHECK(values[3] > 0);
}

TEST_CASE("measures of a window equal those of a run over the window only") {
  // phi of the servo's step response; the window's ends are not ends of pieces.
  const SecondOrder exact{5, 0.3};
  const double from = 0.37, to = 2.11;
  const auto values = measure_run(
      servo_step(5, 0.3),
      {"max_phi from 0.37 s to 2.11 s", "min_phi from 370 ms to 2.11 s", "max_phi from 0.37 s",
       "max_phi to 0.37 s", "end_phi to 2.11 s", "find phi at 1 from 0.37 s to 2.11 s",
       "when phi=0.1 from 0.7 s", "phi.Overshoot from 0.37 s to 2.11 s",
       "phi.PeakTime from 0.37 s to 2.11 s", "max_phi", "find phi at 0.2 from 0.37 s",
       "rms_phi from 3 s to 5 s", "rms_phi from 3.2 s to 3.8 s"},
      {1e-12, 1e-14});
  const double peak = exact.at(exact.peak_time(1)), dip = exact.at(exact.peak_time(2));
  REQUIRE(exact.peak_time(2) < to);
  CHECK(values[0] == Approx(0.1 * peak).epsilon(1e-9));
  CHECK(values[1] == Approx(0.1 * std::min(exact.at(from), dip)).epsilon(1e-9));
  CHECK(values[2] == values[0]);
  CHECK(values[3] == Approx(0.1 * exact.at(from)).epsilon(1e-9));
  CHECK(values[4] == Approx(0.1 * exact.at(to)).epsilon(1e-9));
  CHECK(values[5] == Approx(0.1 * exact.at(1)).epsilon(1e-9));
  CHECK(values[6] ==
        Approx(exact.time_of(1, exact.peak_time(1), exact.peak_time(2))).epsilon(1e-9));
  const double step = exact.at(to) - exact.at(from);
  CHECK(values[7] == Approx(100 * (peak - exact.at(to)) / step).epsilon(1e-8));
  CHECK(values[8] == Approx(exact.peak_time(1) - from).epsilon(1e-8));
  CHECK(values[9] == values[0]);
  CHECK(std::isnan(values[10]));
  // Rows are at whole seconds: the window has three, both ends included, or none.
  double sum = 0;
  for (const int t : {3, 4, 5}) sum += exact.at(t) * exact.at(t);
  CHECK(values[11] == Approx(0.1 * std::sqrt(sum / 3)).epsilon(1e-9));
  CHECK(std::isnan(values[12]));
}

}  // namespace bbsim_test::test_instants
