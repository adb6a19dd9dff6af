// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim accuracy: its table, CSV output and error messages.
#include <sstream>
#include <string>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_accuracy {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("accuracy prints a table and writes it as CSV") {
  const Folder folder;
  const std::string scenario = std::string(BBSIM_SOURCE_DIR) + "/tests/data/scenarios/fig2a.yaml";
  const Result result = bbsim({"accuracy", scenario, "--methods", "radau,adams", "--rtol",
                               "1e-5:1e-7", "--csv", "a.csv", "-q"},
                              folder.path());
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "radau"));
  CHECK(contains(result.out, "error within"));
  std::istringstream csv(folder.read("a.csv"));
  std::string line;
  std::getline(csv, line);
  CHECK(line ==
        "method,rtol,atol,error_m,time_us,steps,rhs_evaluations,jacobian_evaluations,status");
  int rows = 0;
  while (std::getline(csv, line)) {
    ++rows;
    CHECK(contains(line, ",done"));
  }
  CHECK(rows == 6);  // two methods, three tolerances
}

TEST_CASE("accuracy refuses an unknown method or an invalid range") {
  const Result method = bbsim({"accuracy", config("fig2a.yaml"), "--methods", "euler"});
  CHECK(method.exit_code == 2);
  CHECK(contains(method.err, "euler"));
  CHECK(contains(method.err, "radau"));
  const Result range = bbsim({"accuracy", config("fig2a.yaml"), "--rtol", "coarse"});
  CHECK(range.exit_code == 2);
  CHECK(contains(range.err, "coarse"));
}

}  // namespace bbsim_test::test_accuracy
