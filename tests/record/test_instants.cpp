// Step metrics and instants of the continuous motion, against closed forms.
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "record/curve.hpp"
#include "record/instants.hpp"
#include "record/measure_rows.hpp"
#include "record/recorder.hpp"
#include "scenario/reader.hpp"
#include "solve/integrate.hpp"

using namespace bbsim;
using namespace bbsim::record;
using scenario::find_measure;
using scenario::Measure;

namespace {

// 1 - exp(-zeta w t) (cos wd t + zeta w / wd sin wd t), of s^2 + 2 zeta w s + w^2.
struct SecondOrder {
  double w, zeta;
  [[nodiscard]] double wd() const { return w * std::sqrt(1 - zeta * zeta); }
  [[nodiscard]] double at(double t) const {
    return 1 -
           std::exp(-zeta * w * t) * (std::cos(wd() * t) + zeta * w / wd() * std::sin(wd() * t));
  }
  // Where it is at the level, in an interval in which it rises or falls.
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
  std::vector<Measure> measures = scenario::measures_named(names, scene);
  const model::Model model = model::assemble(scene, false);
  const model::BallConstants constants = model::constants_of(scene);
  const solve::OutputGrid grid(scene.time);
  Recorder recorder({{}, measures});
  recorder.begin(model, constants, grid);
  const auto outcome = solve::integrate(model, Method::automatic, tolerances, grid, recorder);
  REQUIRE(outcome.ending == solve::Ending::done);
  std::vector<double> values(measures.size());
  recorder.finish(outcome, values.data());
  return values;
}

// A command at its limit, 0.1 rad, throughout: what follows is the servo's step response.
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

TEST_CASE("step metrics of a servo are those of the closed form") {
  const double zeta = GENERATE(0.3, 0.5, 0.7);
  const SecondOrder exact{5, zeta};
  const auto values =
      measure_run(servo_step(5, zeta),
                  {"phi.RiseTime", "phi.SettlingTime", "phi.SettlingMin", "phi.SettlingMax",
                   "phi.Overshoot", "phi.Undershoot", "phi.Peak", "phi.PeakTime",
                   "phi.SteadyStateValue", "theta.Overshoot", "theta.Peak", "when phi=0.05 rise=1",
                   "find phi_rate when phi=0.1 fall=1", "find phi at 0.25"},
                  {1e-12, 1e-14});
  // What the end of the run, 12 s, leaves of the motion is 1e-8 of it at most: a final value of its
  // own, to which the metrics refer.
  const double last = exact.at(12), first_peak = exact.peak_time(1);
  const auto level = [&](double part) { return exact.time_of(part * last, 0, first_peak); };
  CAPTURE(zeta);
  CHECK(values[0] == Approx(level(0.9) - level(0.1)).epsilon(1e-9));
  // The last time at 2 % is after the last extreme that is beyond it.
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
  CHECK(values[5] < 1e-10);  // the rounding of a polynomial that begins at 0
  CHECK(values[6] == Approx(0.1 * high).epsilon(1e-9));
  CHECK(values[7] == Approx(first_peak).epsilon(1e-9));
  CHECK(values[8] == Approx(0.1 * last).epsilon(1e-9));
  // The other axis goes the other way.
  CHECK(values[9] == Approx(values[4]).epsilon(1e-9));
  CHECK(values[10] == Approx(values[6]).epsilon(1e-9));
  CHECK(values[11] == Approx(exact.time_of(0.5, 0, first_peak)).epsilon(1e-9));
  const double falls = exact.time_of(1, first_peak, exact.peak_time(2));
  const double h = 1e-5;
  CHECK(values[12] ==
        Approx(0.1 * (exact.at(falls + h) - exact.at(falls - h)) / (2 * h)).epsilon(1e-7));
  CHECK(values[13] == Approx(0.1 * exact.at(0.25)).epsilon(1e-9));
}

TEST_CASE("a response to the other side first has an undershoot") {
  // The ball of a rolling plane goes the wrong way before it goes the right one: x'' = a phi - r
  // phi''. Against rows that are very dense.
  Scenario scene = servo_step(5, 0.7);
  scene.ball.radius = 0.3;
  scene.time = {1, 1e-5};
  const std::vector<std::string> names{"x.Undershoot", "x.RiseTime", "x.SettlingTime",
                                       "x.PeakTime"};
  const auto values = measure_run(scene, names, {1e-11, 1e-13});
  const model::Model model = model::assemble(scene, false);
  const solve::OutputGrid grid(scene.time);
  solve::Trajectory rows(model.row_size());
  static_cast<void>(solve::integrate(model, Method::automatic, {1e-11, 1e-13}, grid, rows));
  file::TableData table{{"t", "x"}, {{}, {}}};
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    table.columns[0].push_back(grid[i]);
    table.columns[1].push_back(model.sample(grid[i], rows.row(i)).ball.x);
  }
  const StoredRun stored(table, "rows.csv");
  const auto measures = stored.measures_named(names);
  CHECK(values[0] > 1);
  for (std::size_t m = 0; m < measures.size(); ++m) {
    CAPTURE(names[m]);
    // A straight line between rows is off by the square of their distance.
    CHECK(stored.value_of(measures[m]) == Approx(values[m]).epsilon(1e-6));
  }
}

TEST_CASE("crossings are counted, and a touch is none") {
  // -(t - 1)^2 + 1 on [0, 2] touches 1; then a jump to 2, and down to -1 on [2, 5].
  ChebyshevTables tables;
  const ChebyshevPoints& points = tables.points(8);
  const auto add = [&](Curve& curve, double from, double to, auto f) {
    std::vector<double> values;
    for (std::size_t i = 0; i < points.size(); ++i)
      values.push_back(f(from + (to - from) * points[i]));
    curve.add_piece(from, to, points, values.data());
  };
  Curve curve;
  add(curve, 0, 2, [](double t) { return 1 - (t - 1) * (t - 1); });
  add(curve, 2, 5, [](double t) { return 2 - (t - 2); });
  using Way = scenario::Instant::Way;
  CHECK_FALSE(curve.crossing(1, Way::rise, 2));
  CHECK(curve.crossing(1, Way::rise, 1)->t == 2);  // the jump
  CHECK(curve.crossing(1, Way::fall, 1)->t == Approx(3).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::either, 1)->t == Approx(0.5).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::either, 2)->t == Approx(1.5).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::either, 0)->t == Approx(3.25).epsilon(1e-14));
  CHECK(curve.crossing(0.75, Way::rise, 0)->t == 2);
  // It begins at 0: that is no crossing, and neither is the end of the first piece.
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

TEST_CASE("measures of stored rows are on straight lines between them") {
  const StoredRun run({{"t", "u_integral", "x"}, {{0, 1, 2, 3}, {0, 1, 4, 4}, {-2, 0, 2, 1}}},
                      "own.csv");
  const auto value = [&](const std::string& name) {
    return run.value_of(run.measures_named({name}).front());
  };
  CHECK(value("u_integral.RiseTime") == Approx((1 + 2.6 / 3) - 0.4).epsilon(1e-15));
  CHECK(value("u_integral.SettlingTime") == Approx(1 + 2.92 / 3).epsilon(1e-15));
  CHECK(value("x.Overshoot") == Approx(100));
  CHECK(value("x.Undershoot") == Approx(200));
  CHECK(value("x.Peak") == 2);
  CHECK(value("x.PeakTime") == 0);  // the first of two alike
  CHECK(value("when x=1") == Approx(1.5));
  CHECK(value("find u_integral when x=1 rise=1") == Approx(2.5));
  CHECK(value("when x stays above -1") == Approx(0.5));
  CHECK(std::isnan(value("when x stays below 0.5")));
  CHECK(value("when x stays below 3") == 0);
  CHECK(std::isnan(value("when x=7")));
  CHECK(value("find x at 2.5") == Approx(1.5));
  CHECK(value("min_x") == -2);
  CHECK(value("rms_x") == Approx(1.5));
  CHECK(value("end_x") == 1);
  CHECK_THROWS_AS(run.measures_named({"y.RiseTime"}), InputError);
  CHECK_THROWS_AS(run.measures_named({"x.Peak", "x.Peak"}), InputError);
  CHECK_THROWS_AS(StoredRun({{"x"}, {{1}}}, "no-times.csv"), InputError);
  CHECK_THROWS_AS(StoredRun({{"t", "x"}, {{1, 0}, {1, 1}}}, "back.csv"), InputError);
  CHECK_THROWS_AS(StoredRun({{"t"}, {{}}}, "empty.csv"), InputError);
  // One row is a run that ended at once; of a response that ends at 0 nothing is a part.
  const StoredRun still({{"t", "x"}, {{0}, {3}}}, "still.csv");
  CHECK(still.value_of(still.measures_named({"x.RiseTime"}).front()) == 0);
  const StoredRun back({{"t", "x"}, {{0, 1}, {3, 0}}}, "zero.csv");
  CHECK(std::isnan(back.value_of(back.measures_named({"x.SettlingTime"}).front())));
}
