// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "api/fit.hpp"
#include "base/error.hpp"
#include "catch.hpp"
#include "fit/student.hpp"
#include "rig.hpp"

namespace bbsim_test::test_fit {

using namespace bbsim;

namespace {

// A fit in a folder with a scenario and its logs.
class Case {
 public:
  explicit Case(const std::string& log, const std::string& scenario = assumed_rig) {
    folder_.put("log.csv", log);
    folder_.put("rig.yaml", scenario);
  }

  api::FitResult fit(const std::vector<std::string>& free, const std::string& window = "",
                     double hold_out = 0) const {
    const ScenarioFamily family(folder_ / "rig.yaml", {});
    api::FitRequest request{family, {folder_ / "log.csv"}, {}, free, window};
    request.hold_out = hold_out;
    request.threads = threads;
    request.loss = loss;
    request.starts = starts;
    api::Watch nobody;
    return api::fit(request, true, watch != nullptr ? *watch : nobody);
  }

  [[nodiscard]] const Folder& folder() const { return folder_; }
  std::size_t threads = 2, starts = 1;
  std::string loss = "squares";
  api::Watch* watch = nullptr;

 private:
  Folder folder_;
};

// Holds for 99.99 % of all logs; the logs of a test never change.
bool is_near(const fit::Parameter& one, double value) {
  return std::abs(one.estimate - value) < 3.9 * one.sd;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("Student's t at 95 %") {
  CHECK(fit::student_95(1) == Approx(12.7062047).epsilon(1e-7));
  CHECK(fit::student_95(5) == Approx(2.57058184).epsilon(1e-8));
  CHECK(fit::student_95(30) == Approx(2.04227246).epsilon(1e-8));
  CHECK(fit::student_95(500) == Approx(1.96471983).epsilon(1e-8));
  CHECK(fit::student_95(501) == Approx(1.96471025).epsilon(1e-7));
  CHECK(fit::student_95(1e6) == Approx(1.95996636).epsilon(1e-7));
}

TEST_CASE("keys of a rig are found from its log, within their intervals") {
  const Case rig(log_text(5e-4, 1.1, 0.01));
  const std::vector<std::string> free = {"ball.inertia_factor", "gimbal.motion.phi.table.scale",
                                         "gimbal.motion.phi.table.offset=-5 deg:5 deg"};
  const api::FitResult made = rig.fit(free);
  CAPTURE(made.text);
  REQUIRE(made.fitted.parameters.size() == 3);
  const double truth[] = {0.43, 1.1, 0.01};
  for (std::size_t k = 0; k < 3; ++k) {
    const fit::Parameter& one = made.fitted.parameters[k];
    CAPTURE(one.key, one.estimate, one.sd);
    CHECK(is_near(one, truth[k]));
    CHECK(one.sd < 0.05 * truth[k]);
    CHECK(one.low < one.estimate);
    CHECK(one.estimate < one.high);
  }
  CHECK(made.fitted.untold.empty());
  CHECK(made.fitted.windows == 10);
  REQUIRE(made.fitted.columns.size() == 2);
  // Each window's two starts, four numbers in 41 rows, absorb part of the noise.
  for (const fit::ColumnResidual& column : made.fitted.columns) {
    CHECK(column.rms == Approx(5e-4).epsilon(0.12));
  }
  // The assumed rig is ideal, and its starts are fitted with other column weights.
  for (const fit::ColumnResidual& column : made.fitted.columns) {
    REQUIRE(column.ideal);
    CHECK(*column.ideal == Approx(column.before).epsilon(1e-3));
  }
  CHECK(contains(made.json, R"("ideal_rms")"));
  CHECK(contains(made.text, "ideal rig"));
  CHECK(made.fitted.columns[0].before > 2 * made.fitted.columns[0].rms);
  CHECK(made.fitted.columns[1].before > made.fitted.columns[1].rms);
  CHECK(made.fitted.white);
  CHECK(contains(made.json, R"("identifiable": true)"));

  SECTION("the result is the same for any number of threads") {
    Case alone(log_text(5e-4, 1.1, 0.01));
    alone.threads = 1;
    CHECK(alone.fit(free).json == made.json);
  }
  SECTION("the fitted scenario is the user's with the estimates") {
    CHECK(contains(made.scenario, "# A rig, as bought.\n"));
    CHECK(contains(made.scenario, "  # solid\n"));
    const ScenarioFamily fitted(Source{rig.folder() / "fitted.yaml", made.scenario, {}});
    const Scenario scenario = fitted.read({});
    CHECK(scenario.ball.inertia_factor == made.fitted.parameters[0].estimate);
    CHECK(fitted.number_at("gimbal.motion.phi.table.scale", {}) ==
          made.fitted.parameters[1].estimate);
    CHECK(fitted.number_at("gimbal.motion.phi.table.offset", {}) ==
          made.fitted.parameters[2].estimate);
  }
}

TEST_CASE("eight keys of a rig are found together, from a log with noise and rounding") {
  std::string slowed = true_rig;
  slowed.replace(slowed.find("inertia_factor: 0.43"), 20,
                 "inertia_factor: 0.43, mass: 3 g, losses: {viscous: 2e-7}");
  std::string believed = assumed_rig;
  believed.replace(believed.find("radius: 1 cm"), 12,
                   "radius: 1 cm, mass: 3 g, losses: {viscous: 0}");
  const Case rig(log_text(5e-4, 1.1, 0.01, 3, slowed, 3.2e-4), believed);
  const api::FitResult made =
      rig.fit({"ball.inertia_factor", "ball.losses.viscous", "gimbal.motion.phi.table.scale",
               "gimbal.motion.phi.table.offset", "gimbal.motion.theta.table.scale",
               "gimbal.motion.theta.table.offset", "gimbal.motion.phi.table.delay=-100:100 ms",
               "gimbal.motion.theta.table.delay=-100:100 ms"});
  CAPTURE(made.text);
  const double truth[] = {0.43, 2e-7, 1.1, 0.01, 1, 0, 0, 0};
  REQUIRE(made.fitted.parameters.size() == 8);
  for (std::size_t k = 0; k < 8; ++k) {
    const fit::Parameter& one = made.fitted.parameters[k];
    CAPTURE(one.key, one.estimate, one.sd);
    CHECK(one.told);
    CHECK(is_near(one, truth[k]));
    // A friction torque, whose scale is unknown beforehand: to a tenth.
    if (k == 1) CHECK(one.sd < 0.1 * truth[1]);
  }
  CHECK(made.fitted.white);
}

TEST_CASE("without noise, the fit is exact") {
  const Case rig(log_text(0, 0.9));
  const api::FitResult made = rig.fit({"ball.inertia_factor", "gimbal.motion.phi.table.scale"});
  CAPTURE(made.text);
  // The spline through rows 50 ms apart differs from the sines by 1e-6 rad.
  CHECK(made.fitted.parameters[0].estimate == Approx(0.43).epsilon(2e-3));
  CHECK(made.fitted.parameters[1].estimate == Approx(0.9).epsilon(2e-3));
}

TEST_CASE("a delay of the table is found") {
  // The gimbal follows its command 60 ms late.
  std::string late = true_rig;
  const auto shift = [&](const std::string& from, const std::string& to) {
    const auto at = late.find(from);
    REQUIRE(at != std::string::npos);
    late.replace(at, from.size(), to);
  };
  shift("5.3 rad/s, phase: 1.5708 rad", "5.3 rad/s, phase: 1.2528 rad");
  shift("2.9 rad/s, phase: 1.5708 rad", "2.9 rad/s, phase: 1.3968 rad");
  const std::string delayed = log_text(3e-4, 1, 0, 3, late);
  // The log contains the command: phi of the rig without the delay.
  const std::string command = log_text(0);
  std::string log;
  const auto line = [](const std::string& text, std::size_t& at) {
    const std::size_t end = text.find('\n', at);
    std::string one = text.substr(at, end - at);
    at = end + 1;
    return one;
  };
  for (std::size_t a = 0, b = 0; a < delayed.size() && b < command.size();) {
    std::vector<std::string> ball, given;
    for (auto* const into : {&ball, &given}) {
      std::string one = into == &ball ? line(delayed, a) : line(command, b);
      for (std::size_t comma; (comma = one.find(',')) != std::string::npos;) {
        into->push_back(one.substr(0, comma));
        one.erase(0, comma + 1);
      }
      into->push_back(one);
    }
    log += ball[0] + ',' + ball[1] + ',' + ball[2] + ',' + given[3] + ',' + ball[4] + '\n';
  }
  const Case rig(log);
  const api::FitResult made =
      rig.fit({"gimbal.motion.phi.table.delay=0:200 ms", "ball.inertia_factor"});
  CAPTURE(made.text);
  const fit::Parameter& delay = made.fitted.parameters[0];
  // Before the delayed table begins, the first rows are not the sines.
  CHECK(delay.estimate == Approx(0.06).margin(0.004));
  CHECK(delay.unit == "s");
}

TEST_CASE("keys that trade off exactly do not get small error bars") {
  const Case rig(log_text(5e-4, 1, 0.01));
  const api::FitResult made = rig.fit(
      {"gimbal.motion.phi.table.offset", "gimbal.mounting.phi_offset", "ball.inertia_factor"});
  CAPTURE(made.text, made.json);
  CHECK(made.code == ExitCode::done);
  REQUIRE(made.fitted.untold.size() == 1);
  CHECK(contains(
      made.fitted.untold.front(),
      "gimbal.motion.phi.table.offset and gimbal.mounting.phi_offset cannot be told apart"));
  CHECK_FALSE(made.fitted.parameters[0].told);
  CHECK_FALSE(made.fitted.parameters[1].told);
  CHECK(made.fitted.parameters[2].told);
  CHECK(is_near(made.fitted.parameters[2], 0.43));
  CHECK(contains(made.json, R"("identifiable": false)"));
  CHECK(contains(made.json, R"("sd": null)"));
}

TEST_CASE("windows are held out") {
  const Case rig(log_text(5e-4));
  const api::FitResult made = rig.fit({"ball.inertia_factor"}, "2 s", 0.3);
  CAPTURE(made.text, made.json);
  // floor(0.3 (i + 1)) > floor(0.3 i) for i = 3, 6, 9
  CHECK(made.fitted.windows == 7);
  CHECK(made.fitted.held == 3);
  for (const fit::ColumnResidual& column : made.fitted.columns) {
    REQUIRE(column.held);
    CHECK(*column.held == Approx(5e-4).epsilon(0.25));
  }
  CHECK(contains(made.json, R"("hold_out_rms": {
    "x": )"));
}

TEST_CASE("several logs, each with its own table") {
  const Case rig(log_text(5e-4, 1.1, 0, 1));
  std::string other = true_rig;
  other.replace(other.find("frequency: 5.3"), 14, "frequency: 6.1");
  rig.folder().put("second.csv", log_text(5e-4, 1.1, 0, 2, other));
  const ScenarioFamily family(rig.folder() / "rig.yaml", {});
  const api::FitRequest request{family,
                                {rig.folder() / "log.csv", rig.folder() / "second.csv"},
                                {},
                                {"gimbal.motion.phi.table.scale", "ball.inertia_factor"}};
  api::Watch watch;
  const api::FitResult made = api::fit(request, false, watch);
  CAPTURE(made.text);
  CHECK(is_near(made.fitted.parameters[0], 1.1));
  CHECK(made.fitted.columns[0].rms == Approx(5e-4).epsilon(0.1));
}

TEST_CASE("a log's own scale and offset are found, where the table is right") {
  // Gravity and the angles, and hence the path, are known; the scale of the screen's counts is not.
  std::string text = "t,x,y,phi,theta\n";
  {
    std::istringstream lines(log_text(2e-4));
    std::string line;
    std::getline(lines, line);
    while (std::getline(lines, line)) {
      double t = 0, x = 0, y = 0, phi = 0, theta = 0;
      REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", &t, &x, &y, &phi, &theta) == 5);
      for (const double value : {t, 0.8 * x + 0.03, y, phi}) text += number_text(value) + ",";
      text += number_text(theta) + "\n";
    }
  }
  const Case rig(text);
  const api::FitResult made = rig.fit({"log.x.scale", "ball.inertia_factor", "log.x.offset"});
  CAPTURE(made.text, made.json);
  // The starts absorb an offset as long as the plate's curvature is not observable.
  REQUIRE(made.fitted.parameters.size() == 3);
  const fit::Parameter& scale = made.fitted.parameters[1];
  CHECK(scale.key == "log.x.scale");
  CHECK(is_near(scale, 0.8));
  CHECK(scale.sd < 0.02);
  CHECK(is_near(made.fitted.parameters[0], 0.43));
  CHECK_FALSE(contains(made.scenario, "log.x.scale:  "));
  CHECK(contains(made.scenario, "# log.x.scale: 0."));
}

TEST_CASE("a mirrored axis has a negative scale") {
  const std::string log = log_text(3e-4);
  std::string mirrored;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t x = line.find(',') + 1;
    if (line[0] != 't') line = line[x] == '-' ? line.erase(x, 1) : line.insert(x, "-");
    mirrored += line + '\n';
  }
  const Case rig(mirrored);
  const api::FitResult made = rig.fit({"log.x.scale", "ball.inertia_factor"});
  CAPTURE(made.text);
  CHECK(is_near(made.fitted.parameters[0], 0.43));
  CHECK(is_near(made.fitted.parameters[1], -1));
}

TEST_CASE("the most useful additional key is suggested") {
  const Case rig(log_text(5e-4, 1, 0.01));
  const api::FitResult made = rig.fit({"ball.inertia_factor"});
  CAPTURE(made.text);
  REQUIRE(made.fitted.suggestion);
  CHECK(made.fitted.suggestion->key == "gimbal.motion.phi.table.offset");
  CHECK(made.fitted.suggestion->share > 0.25);
  CHECK(
      contains(made.text, "note: --free gimbal.motion.phi.table.offset could make the residuals"));
  const api::FitResult right = rig.fit({"ball.inertia_factor", "gimbal.motion.phi.table.offset"});
  CHECK_FALSE(right.fitted.suggestion);
}

TEST_CASE("a sensor's delay is found") {
  std::istringstream lines(log_text(2e-4, 1, 0, 5));
  std::string line, text = "t,x,y,phi,theta\n";
  std::getline(lines, line);
  std::vector<std::array<double, 5>> rows;
  while (std::getline(lines, line)) {
    auto& row = rows.emplace_back();
    REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf,%lf", row.data(), &row[1], &row[2], &row[3],
                        &row[4]) == 5);
  }
  // Delayed by two rows of 50 ms.
  for (std::size_t i = 2; i < rows.size(); ++i) {
    for (const double value : {rows[i - 2][0], rows[i - 2][1], rows[i - 2][2], rows[i][3]}) {
      text += number_text(value) + ",";
    }
    text += number_text(rows[i][4]) + "\n";
  }
  const Case rig(text);
  const api::FitResult made = rig.fit({"log.delay", "ball.inertia_factor"});
  CAPTURE(made.text);
  CHECK(made.fitted.parameters[1].key == "log.delay");
  CHECK(made.fitted.parameters[1].unit == "s");
  CHECK(is_near(made.fitted.parameters[1], 0.1));
  CHECK(made.fitted.parameters[1].sd < 0.002);
}

TEST_CASE("outliers are reported, and Huber's loss reduces their weight") {
  // Five rows of x are 0.3 m off, as when the screen is not touched.
  std::istringstream lines(log_text(5e-4));
  std::string line, text;
  for (int row = 0; std::getline(lines, line); ++row) {
    if (row % 80 == 7) {
      const std::size_t comma = line.find(',');
      line.replace(comma + 1, line.find(',', comma + 1) - comma - 1, "0.3");
    }
    text += line + "\n";
  }
  Case rig(text);
  const std::vector<std::string> free = {"ball.inertia_factor", "gimbal.motion.phi.table.scale"};
  const api::FitResult squares = rig.fit(free);
  CAPTURE(squares.text);
  CHECK(squares.fitted.columns[0].outliers >= 5);
  CHECK(contains(squares.text, "; --loss huber gives such numbers less weight"));
  rig.loss = "huber";
  const api::FitResult huber = rig.fit(free);
  CAPTURE(huber.text);
  CHECK(huber.fitted.columns[0].outliers == 5);
  CHECK(huber.fitted.columns[0].outlier_time == Approx(0.3));
  CHECK(huber.fitted.columns[1].outliers == 0);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(huber.fitted.parameters[k].sd < squares.fitted.parameters[k].sd);
  }
  CHECK(is_near(huber.fitted.parameters[0], 0.43));
  CHECK(is_near(huber.fitted.parameters[1], 1));
  // Without outliers Huber's loss costs 5 % of the efficiency.
  const Case clean(log_text(5e-4));
  const api::FitResult best = clean.fit(free);
  CHECK(huber.fitted.parameters[0].sd < 1.3 * best.fitted.parameters[0].sd);
}

TEST_CASE("a stop request keeps the best result so far") {
  class Impatient : public api::Watch {
   public:
    void update(double, const std::string& detail) override {
      heard = detail;
      stop_ = true;
    }
    const std::atomic<bool>* stop() override { return &stop_; }
    std::string heard;

   private:
    std::atomic<bool> stop_ = false;
  } impatient;
  Case rig(log_text(5e-4, 1.1));
  rig.watch = &impatient;
  const api::FitResult made = rig.fit({"ball.inertia_factor", "gimbal.motion.phi.table.scale"});
  CAPTURE(made.text);
  CHECK(made.code == ExitCode::interrupted);
  CHECK(contains(impatient.heard, "iteration 1, rms residual "));
  CHECK(made.fitted.parameters.size() == 2);
  CHECK(contains(made.text, "note: interrupted after 1 iteration:"));
  CHECK(contains(made.scenario, "Fitted by bbsim"));
}

TEST_CASE("an interval is a profile interval") {
  // If the problem is nearly linear, its ends agree with the standard deviation.
  const Case rig(log_text(5e-4, 1.1));
  const api::FitResult made = rig.fit({"gimbal.motion.phi.table.scale"});
  const fit::Parameter& scale = made.fitted.parameters[0];
  const double t = 1.96;
  CHECK(scale.high - scale.estimate == Approx(t * scale.sd).epsilon(0.03));
  CHECK(scale.estimate - scale.low == Approx(t * scale.sd).epsilon(0.03));
  // The interval of a bounded key ends at the bound.
  const api::FitResult bounded = rig.fit({"gimbal.motion.phi.table.scale=0.5:1.1001"});
  CHECK(bounded.fitted.parameters[0].high <= 1.1001);
}

TEST_CASE("at an interval's end the growth is that of 95 %, with the other keys refitted") {
  // The inertia correlates with the sensor's scale. It may be held at its bound, which it leaves
  // again as the scale changes.
  const std::string inertia = GENERATE("ball.inertia_factor", "ball.inertia_factor=0.3:0.38");
  CAPTURE(inertia);
  const Case rig(log_text(4e-3));
  const fit::Fitted best = rig.fit({"log.x.scale", "log.y.scale", inertia}).fitted;
  const fit::Parameter& scale = best.parameters[1];
  REQUIRE(scale.key == "log.x.scale");
  CHECK(best.parameters[0].at_bound == (inertia != "ball.inertia_factor"));
  const double degrees = static_cast<double>(best.numbers - 4 * best.windows - 3);
  for (const double end : {scale.low, scale.high}) {
    const std::string held =
        "log.x.scale=" + number_text(end - 1e-7) + ":" + number_text(end + 1e-7);
    const fit::Fitted there = rig.fit({held, "log.y.scale", inertia}).fitted;
    double growth = 0;  // relative to the variance of a residual
    for (std::size_t c = 0; c < 2; ++c) {
      const double ratio = there.columns[c].rms / best.columns[c].rms;
      growth += degrees / 2 * (ratio * ratio - 1);
    }
    CAPTURE(scale.estimate, scale.sd, end);
    // Ends are found to a twentieth of the half-width, and the growth is its square.
    CHECK(growth == Approx(std::pow(fit::student_95(degrees), 2)).epsilon(0.1));
  }
}

TEST_CASE("several starts find what one start misses") {
  // The minimum nearest to a delay of 0.9 s is another period of the motion.
  const std::string late = R"(
ball: {radius: 1 cm, inertia_factor: 0.43}
gimbal:
  motion:
    phi: {table: {file: log.csv, time: t, value: phi}}
    theta: {table: {file: log.csv, time: t, value: theta, delay: 0.9}}
time: {end: 10, step: 50 ms}
)";
  const Case one(log_text(5e-4), late);
  Case several(log_text(5e-4), late);
  several.starts = 12;
  const std::vector<std::string> free = {"gimbal.motion.theta.table.delay=-1:1"};
  const api::FitResult alone = one.fit(free), made = several.fit(free);
  CAPTURE(alone.text, made.text);
  CHECK(std::abs(alone.fitted.parameters[0].estimate) > 0.1);
  CHECK(made.fitted.parameters[0].estimate == Approx(0).margin(2e-3));
}

TEST_CASE("a unit on the upper bound alone applies to both bounds") {
  const Case rig(log_text(0));
  const ScenarioFamily family(rig.folder() / "rig.yaml", {});
  const auto bounds = [&](const std::string& range) {
    const fit::FreeKey key = fit::read_free_key("gimbal.motion.phi.table.delay=" + range, family);
    return std::array{key.lower, key.upper};
  };
  CHECK(bounds("-100:100 ms") == std::array{-0.1, 0.1});
  CHECK(bounds("5ms:0.06 s") == std::array{0.005, 0.06});
  CHECK(bounds("0.005:0.06") == std::array{0.005, 0.06});
  CHECK(bounds("5 ms:0.06") == std::array{0.005, 0.06});
}

TEST_CASE("a key at its bound stays there") {
  const Case rig(log_text(5e-4));
  const api::FitResult made = rig.fit({"ball.inertia_factor=0.3:0.41"});
  CHECK(made.fitted.parameters[0].estimate == 0.41);
  CHECK(made.fitted.parameters[0].at_bound);
}

TEST_CASE("input that a fit cannot use is refused") {
  const Case rig(log_text(5e-4));
  const auto refused = [&](const std::vector<std::string>& free, const std::string& window = "",
                           double hold_out = 0) {
    return message_of<InputError>([&] { static_cast<void>(rig.fit(free, window, hold_out)); });
  };
  CHECK(contains(refused({"ball.inertia_facter"}), "did you mean ball.inertia_factor?"));
  CHECK(contains(refused({"ball.position.0"}), "each window's start is fitted anyway"));
  CHECK(contains(refused({"ball.mass"}), "ball.mass: has no effect on x, y"));
  CHECK(contains(refused({"ball.inertia_factor=2"}), "found \"2\"; allowed: FROM:TO"));
  CHECK(contains(refused({"ball.inertia_factor=0.5:0.3"}), "allowed: FROM:TO with FROM below TO"));
  CHECK(contains(refused({"ball.radius", "ball.radius"}), "ball.radius is given twice"));
  CHECK(contains(refused({"ball.radius"}, "-1"), "--window: found \"-1\""));
  CHECK(contains(refused({"ball.radius"}, "", 1), "--hold-out: found 1"));
  CHECK(contains(
      refused({"log.phi.scale"}),
      "log.phi.scale: allowed for a log: log.delay, log.x.scale, log.x.offset, log.y.scale"));
  CHECK(contains(refused({"log.delay=-1:1"}), "allowed: values from 0"));
  Case other(log_text(5e-4));
  other.loss = "cauchy";
  CHECK(contains(message_of<InputError>([&] { static_cast<void>(other.fit({"ball.radius"})); }),
                 "--loss: found \"cauchy\"; allowed: squares or huber"));
  CHECK(contains(refused({"ball.radius"}, "60 ms"), "have 0 numbers in 0 windows"));

  rig.folder().put("log.csv", "t,phi,theta\n0,0,0\n1,0,0\n2,0,0\n3,0,0\n10,0,0\n");
  CHECK(contains(refused({"ball.radius"}), "has no column to compare"));
}

}  // namespace bbsim_test::test_fit
