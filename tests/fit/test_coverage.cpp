// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <cstddef>
#include <string>
#include <vector>

#include "api/fit.hpp"
#include "catch.hpp"
#include "rig.hpp"

namespace bbsim_test::test_coverage {

using namespace bbsim;

namespace {

fit::Fitted fitted_to(const std::string& log, const std::string& scenario,
                      const std::vector<std::string>& free) {
  const Folder folder;
  folder.put("log.csv", log);
  folder.put("rig.yaml", scenario);
  const ScenarioFamily family(folder / "rig.yaml", {});
  const api::FitRequest request{family, {folder / "log.csv"}, {}, free};
  api::Watch watch;
  return api::fit(request, false, watch).fitted;
}

}  // namespace

TEST_CASE("over 500 logs, the 95 % intervals contain the truth as often as they should", "[slow]") {
  const std::vector<std::string> free = {"ball.inertia_factor", "gimbal.motion.phi.table.scale",
                                         "gimbal.motion.phi.table.offset"};
  const double truth[] = {0.43, 1.1, 0.01};
  std::size_t holds[3] = {}, white = 0;
  constexpr unsigned logs = 500;
  for (unsigned seed = 1; seed <= logs; ++seed) {
    const fit::Fitted made = fitted_to(log_text(5e-4, 1.1, 0.01, seed), assumed_rig, free);
    for (std::size_t k = 0; k < 3; ++k) {
      const fit::Parameter& one = made.parameters[k];
      if (one.low <= truth[k] && truth[k] <= one.high) ++holds[k];
    }
    if (made.white) ++white;
  }
  // The binomial distribution of 500 trials at 0.95: 99.9 % of it is from 458 to 489.
  for (std::size_t k = 0; k < 3; ++k) {
    CAPTURE(free[k]);
    CHECK(holds[k] >= 458);
    CHECK(holds[k] <= 489);
  }
  // A correct model passes the residual test, one-sided at three standard deviations.
  CHECK(white >= 490);
}

TEST_CASE("residuals of a wrong model are not white") {
  // Rolling losses slow the ball in the log but not in the scenario, and no free key can imitate
  // them.
  std::string slowed = true_rig;
  slowed.replace(slowed.find("inertia_factor: 0.43"), 20,
                 "inertia_factor: 0.43, mass: 3 g, losses: {viscous: 2e-7}");
  const fit::Fitted wrong = fitted_to(log_text(2e-4, 1, 0, 1, slowed), assumed_rig,
                                      {"ball.inertia_factor", "gimbal.motion.phi.table.offset"});
  CHECK_FALSE(wrong.white);
}

}  // namespace bbsim_test::test_coverage
