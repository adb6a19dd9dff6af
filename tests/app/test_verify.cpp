// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim verify and bbsim accuracy.
#include <string>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_verify {

TEST_CASE("verify needs no files, and all its checks pass") {
  const Folder folder;
  const Result result =
      expect(0, "verify", folder, {},
             {"checks hold", "fixed incline: closed form (M1)",
              "Fig. 2(b): quad-precision reference", "adds in fig2a", "adds in fig2b", "!FAILS"});
  CHECK(result.err.empty());
  CHECK(folder.files().empty());
}

TEST_CASE("verify compares simpler models over a scenario as far as they apply") {
  expect(0, call("verify @fig2b-literal.yaml --set time.end=2"), {},
         {"adds in " + config("fig2b-literal.yaml"), "s of 2 s"});
}

TEST_CASE("accuracy prints a table and writes it as CSV") {
  const Folder folder;
  expect(0,
         "accuracy %tests/data/scenarios/fig2a.yaml --methods radau,adams --rtol 1e-5:1e-7 --csv "
         "a.csv -q",
         folder, {}, {"radau", "error within"});
  const auto csv = lines(folder.read("a.csv"));
  CHECK(csv.size() == 1 + 6);  // two methods, three tolerances
  CHECK(csv[0] ==
        "method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status");
  CHECK(count(folder.read("a.csv"), ",done\n") == 6);
}

TEST_CASE("verify and accuracy refuse faulty input before they check anything") {
  const auto [line, told] = GENERATE(table<std::string, std::string>(
      {{"verify nowhere.yaml", "nowhere.yaml"},
       {"verify --set ball.radius=-1", "ball.radius"},
       {"verify @rig.yaml", "simpler models are compared over"},
       {"accuracy @fig2a.yaml --methods euler", "euler; allowed, separated by commas: auto radau"},
       {"accuracy @fig2a.yaml --rtol coarse", "coarse"}}));
  CHECK(expect(2, call(line), {told}).out.empty());
}

}  // namespace bbsim_test::test_verify
