// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim tune, from the command line to files and exit codes.
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_tune {

using Catch::Matchers::Contains;

namespace {

// Arguments that tune one gain of a short run, plus `more`.
std::vector<std::string> tune(const std::vector<std::string>& more) {
  std::vector<std::string> words{"tune",   config("rig.yaml"),
                                 "--set",  "time.end=3",
                                 "--free", "controller.gravity_compensation.kv=4:8",
                                 "-q"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST_CASE("tune writes a scenario that runs, and JSON") {
  const Folder folder;
  const Result result =
      bbsim(tune({"--minimize", "rms_tracking_error", "-o", "tuned.yaml", "--json", "tuned.json"}),
            folder.path());
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK_THAT(result.out, Contains("controller.gravity_compensation.kv") &&
                             Contains("rms_tracking_error") && Contains("on one rig; "));
  const auto json = nlohmann::json::parse(folder.read("tuned.json"));
  REQUIRE(json["parameters"].size() == 1);
  const double kv = json["parameters"][0]["value"];
  CHECK(kv >= 4);
  CHECK(kv <= 8);
  CHECK(json["requirements"].empty());
  CHECK(json["hold_out"]["cases"] == 0);

  // A run of the tuned scenario has the measure that tune reports.
  const Result run = bbsim({"run", "tuned.yaml", "-q", "-o", "run.csv", "--summary", "run.json",
                            "--measure", "rms_tracking_error"},
                           folder.path());
  INFO(run.err);
  REQUIRE(run.exit_code == 0);
  const std::string value = run.out.substr(run.out.rfind(',') + 1);
  CHECK(std::stod(value) == Approx(json["objective"].get<double>()).epsilon(1e-6));
}

TEST_CASE("tune gives exit code 1 if a requirement cannot be met, and writes the best result") {
  const Folder folder;
  const Result result = bbsim(
      tune({"--minimize", "rms_tracking_error", "--require", "max_tilt < 0.1 deg", "--json", "-"}),
      folder.path());
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.err, Contains("tune: found no values with max_tilt < 0.1 deg; the best has "));
  CHECK(nlohmann::json::parse(result.out)["requirements"][0]["holds"] == false);
}

TEST_CASE("tune refuses invalid input with exit code 2") {
  const auto refused = [](const std::vector<std::string>& words) {
    const Result result = bbsim(words);
    CHECK(result.exit_code == 2);
    CHECK(result.out.empty());
    return result.err;
  };
  CHECK_THAT(refused(tune({})), Contains("--minimize"));
  CHECK_THAT(refused({"tune", config("rig.yaml"), "--minimize", "max_tilt"}), Contains("--free"));
  CHECK_THAT(refused(tune({"--minimize", "max_tilt", "--samples", "3"})),
             Contains("--samples: found, but no value is drawn"));
  CHECK_THAT(refused(tune({"--minimize", "max_tilt", "--samples", "0.5"})), Contains("--samples"));
  CHECK_THAT(refused(tune({"--minimize", "max_tilt", "-o", config("rig.yaml")})),
             Contains("the scenario"));
}

}  // namespace bbsim_test::test_tune
