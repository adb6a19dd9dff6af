// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Small logs as loggers, spreadsheets and sketches write them: logs.yaml lists them.
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "catch.hpp"
#include "results/result.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_log {

using namespace bbsim;
using Catch::Matchers::Contains;
using results::LogChoice;

namespace {

bool same(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (std::isnan(a[i]) && std::isnan(b[i])) continue;
    if (!(std::abs(a[i] - b[i]) <= 1e-8)) return false;
  }
  return true;
}

std::vector<double> numbers(const results::Result& log, const char* name) {
  const results::Column* const column = log.find(name);
  return column == nullptr ? std::vector<double>{} : column->numbers;
}

LogChoice choice_of(const YAML::Node& log) {
  using Words = std::vector<std::string>;
  return {log["map"].as<Words>(Words{}), log["header"].as<Words>(Words{}),
          log["period"].as<std::string>(""), log["time_offset"].as<std::string>(""),
          log["missing"].as<std::string>("")};
}

}  // namespace

TEST_CASE("logs of many styles are read, or refused with row and remedy") {
  const YAML::Node logs = YAML::LoadFile(BBSIM_SOURCE_DIR "/tests/results/logs.yaml");
  CHECK(logs.size() > 60);
  for (const YAML::Node& log : logs) {
    const Folder folder;
    const std::string file = folder.put("log.csv", log["log"].as<std::string>());
    CAPTURE(log["style"].as<std::string>());
    std::string said;
    try {
      const results::Result read = results::read_log(file, choice_of(log));
      CHECK_FALSE(log["refused"]);
      CHECK(same(numbers(read, "t"), {0, 0.5}));
      CHECK(same(numbers(read, "x"), log["x"].as<std::vector<double>>(std::vector{0.01, 0.02})));
      for (const std::string& note : read.notes) said += note + '\n';
      CHECK(read.notes.empty() == !log["note"]);
    } catch (const InputError& error) {
      said = error.what();
      CHECK(log["refused"]);
    }
    CHECK_THAT(said, Contains(log["refused"].as<std::string>(log["note"].as<std::string>(""))));
  }
}

}  // namespace bbsim_test::test_log
