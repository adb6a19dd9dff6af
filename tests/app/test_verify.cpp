// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim verify.
#include <string>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_verify {

namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("verify needs no files, and all its checks pass") {
  const Folder folder;
  const Result result = bbsim({"verify"}, folder.path());
  CAPTURE(result.out, result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(contains(result.out, "checks hold"));
  CHECK(contains(result.out, "fixed incline: closed form (M1)"));
  CHECK(contains(result.out, "Fig. 2(b): quad-precision reference"));
  CHECK_FALSE(contains(result.out, "FAILS"));
  CHECK(contains(result.out, "adds in fig2a"));
  CHECK(contains(result.out, "adds in fig2b"));
  CHECK(folder.files().empty());
}

TEST_CASE("verify compares simpler models over a scenario as far as they apply") {
  const Result result = bbsim({"verify", config("fig2b-literal.yaml"), "--set", "time.end=2"});
  CHECK(result.exit_code == 0);
  CHECK(contains(result.out, "adds in " + config("fig2b-literal.yaml")));
  CHECK(contains(result.out, "s of 2 s"));
}

TEST_CASE("verify refuses a faulty scenario before it checks anything") {
  const Result missing = bbsim({"verify", "nowhere.yaml"});
  CHECK(missing.exit_code == 2);
  CHECK(missing.out.empty());
  CHECK(contains(missing.err, "nowhere.yaml"));
  const Result wrong = bbsim({"verify", "--set", "ball.radius=-1"});
  CHECK(wrong.exit_code == 2);
  CHECK(wrong.out.empty());
  CHECK(contains(wrong.err, "ball.radius"));
  const Result rig = bbsim({"verify", config("rig.yaml")});
  CHECK(rig.exit_code == 2);
  CHECK(rig.out.empty());
  CHECK(contains(rig.err, "simpler models are compared over"));
}

}  // namespace bbsim_test::test_verify
