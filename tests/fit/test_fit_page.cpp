// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "api/fit_report.hpp"
#include "catch.hpp"
#include "replay/read_page.hpp"
#include "rig.hpp"

namespace bbsim_test::test_fit_page {

using namespace bbsim;

namespace {

// A log in which every fifth row lacks x.
std::string with_gaps(const std::string& log) {
  std::string text;
  std::size_t row = 0;
  for (std::size_t from = 0; from < log.size(); ++row) {
    const std::size_t end = log.find('\n', from), comma = log.find(',', from);
    const bool lacks = row > 0 && row % 5 == 0;
    text += lacks ? log.substr(from, comma + 1 - from) +
                        log.substr(log.find(',', comma + 1), end - log.find(',', comma + 1) + 1)
                  : log.substr(from, end + 1 - from);
    from = end + 1;
  }
  return text;
}

class Shown {
 public:
  explicit Shown(std::size_t logs) {
    folder_.put("log.csv", with_gaps(log_text(5e-4)));
    folder_.put("other.csv", log_text(5e-4, 1, 0, 2));
    folder_.put("rig.yaml", assumed_rig);
    family_.emplace(folder_ / "rig.yaml", std::vector<std::string>{});
    for (const char* const name : {"log.csv", "other.csv"}) {
      if (files_.size() < logs) files_.push_back(folder_ / name);
    }
  }

  api::FitRequest request(bool with_series) const {
    api::FitRequest made{*family_, files_, {}, {"ball.inertia_factor"}, "2 s"};
    made.hold_out = 0.3;
    made.with_series = with_series;
    return made;
  }

  fit::Fitted fit(bool with_series = true) const {
    api::Watch watch;
    return api::fit(request(with_series), false, watch).fitted;
  }

 private:
  Folder folder_;
  std::optional<ScenarioFamily> family_;
  std::vector<std::string> files_;
};

}  // namespace

TEST_CASE("the series of a fit are those behind its residuals") {
  const Shown rig(1);
  const fit::Fitted made = rig.fit();
  REQUIRE(made.series.size() == made.windows + made.held);
  for (std::size_t c = 0; c < made.columns.size(); ++c) {
    CAPTURE(made.columns[c].column);
    double squares[2] = {0, 0}, counts[2] = {0, 0};
    for (const fit::WindowSeries& window : made.series) {
      REQUIRE(window.times.size() == window.measured[c].size());
      REQUIRE(window.times.size() == window.modelled[c].size());
      CHECK(window.times.front() == window.begin);
      for (std::size_t i = 0; i < window.times.size(); ++i) {
        // The model has values even if the log has none.
        REQUIRE(std::isfinite(window.modelled[c][i]));
        if (std::isnan(window.measured[c][i])) continue;
        squares[window.held ? 1 : 0] += std::pow(window.modelled[c][i] - window.measured[c][i], 2);
        counts[window.held ? 1 : 0] += 1;
      }
    }
    // Row 0 is at t = 0; of 401 rows 80 lack x.
    CHECK(counts[0] + counts[1] == (c == 0 ? 321 : 401));
    // The starts are converged to a relative 1e-12 of the sum of squares.
    CHECK(std::sqrt(squares[0] / counts[0]) == Approx(made.columns[c].rms).epsilon(1e-6));
    REQUIRE(made.columns[c].held);
    CHECK(std::sqrt(squares[1] / counts[1]) == Approx(*made.columns[c].held).epsilon(1e-6));
  }
  CHECK(rig.fit(false).series.empty());
}

TEST_CASE("the page of a fit has its tables and the numbers of each log") {
  const Shown rig(2);
  const api::FitRequest request = rig.request(true);
  const fit::Fitted made = rig.fit();
  const std::string page = api::fit_page(request, made, bbsim_test::small_template);
  const nlohmann::json json = bbsim_test::data_of(page);
  CHECK(json["place"] == nlohmann::json::array({"x", "y"}));
  CHECK(json["radius"].get<double>() == Approx(0.01));
  CHECK(json["parameters"]["head"][2] == "estimate");
  CHECK(json["parameters"]["rows"][0][0] == "ball.inertia_factor");
  const std::string estimate = json["parameters"]["rows"][0][2];
  CHECK(std::stod(estimate) ==
        Approx(made.parameters[0].estimate).margin(0.1 * made.parameters[0].sd));
  CHECK(json["residuals"]["rows"].size() == 2);
  CHECK(json["remarks"][0].get<std::string>().find("; 2 logs") != std::string::npos);
  REQUIRE(json["runs"].size() == 2);
  std::size_t held = 0;
  for (std::size_t log = 0; log < 2; ++log) {
    const nlohmann::json& run = json["runs"][log];
    CHECK(run["name"] == request.logs[log]);
    CHECK(run["rows"] == 401);
    CHECK(run["every"] == 1);
    const auto times = bbsim_test::numbers_of<double>(run["time"]);
    // One extra row separates adjacent windows.
    REQUIRE(run["windows"].size() == 10);
    REQUIRE(times.size() == 401 + 9);
    REQUIRE(run["columns"].size() == 6);
    const auto measured = bbsim_test::numbers_of<float>(run["columns"][3]["data"]);
    const auto modelled = bbsim_test::numbers_of<float>(run["columns"][4]["data"]);
    const auto residual = bbsim_test::numbers_of<float>(run["columns"][5]["data"]);
    CHECK(run["columns"][3]["name"] == "y");
    for (std::size_t w = 0; w < 10; ++w) {
      const std::size_t first = run["windows"][w]["first"], last = run["windows"][w]["last"];
      held += run["windows"][w]["held"].get<bool>() ? 1 : 0;
      CHECK(times[first] == Approx(2.0 * static_cast<double>(w)).margin(1e-9));
      for (std::size_t row = first; row <= last; ++row) {
        if (row > 0) REQUIRE(times[row] > times[row - 1]);
        // Both are rounded to float, by at most a relative 2^-24.
        const double rounding = 6e-8 * (std::abs(modelled[row]) + std::abs(measured[row]));
        REQUIRE(residual[row] == Approx(modelled[row] - measured[row]).margin(rounding));
      }
      if (w == 9) continue;
      CHECK(std::isnan(measured[last + 1]));
      CHECK(std::isnan(modelled[last + 1]));
    }
  }
  CHECK(held == made.held);
}

TEST_CASE("the page of a single-axis fit has no top view") {
  const Shown rig(1);
  api::FitRequest request = rig.request(true);
  request.choice.maps = {"x=x"};
  api::Watch watch;
  const fit::Fitted made = api::fit(request, false, watch).fitted;
  const nlohmann::json json =
      bbsim_test::data_of(api::fit_page(request, made, bbsim_test::small_template));
  CHECK(json["place"].is_null());
  CHECK(json["columns"].size() == 1);
}

}  // namespace bbsim_test::test_fit_page
