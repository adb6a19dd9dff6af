// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Detects runs that creep, without mistaking slow runs, and runs that lose rows.
#include <cmath>

#include "catch.hpp"
#include "solve/outcome.hpp"
#include "solve/pace.hpp"

namespace bbsim_test::test_pace {

using namespace bbsim::solve;

namespace {

// Number of steps until a run to `end` is found to creep, if step n has length `length(n)`; 0 if it
// is not within `most` steps.
template <class Length>
std::size_t steps_until_told(double end, std::size_t most, Length length) {
  Pace pace(end);
  double time = 0;
  for (std::size_t n = 1; n <= most && time < end; ++n) {
    time += length(static_cast<double>(n));
    if (pace.creeps(time)) return n;
  }
  return 0;
}

}  // namespace

TEST_CASE("ever shorter steps far from the end are detected within some windows") {
  // Their sum converges before the end.
  const auto told = [](auto length) { return steps_until_told(10, 10'000'000, length); };
  const std::size_t soon = told([](double n) { return 1e-4 * std::exp(-n / 2e4); });
  CHECK(soon > 0);
  CHECK(soon < 400'000);
  const std::size_t later = told([](double n) { return 1e-4 / (1 + n * n / 1e6); });
  CHECK(later > 0);
  CHECK(later < 1'000'000);
  // Time stops.
  CHECK(steps_until_told(10, 10'000'000, [](double n) { return n < 10 ? 0.1 : 0.0; }) > 0);
}

TEST_CASE("short steps that would take days are detected within a million") {
  const std::size_t told = steps_until_told(1, 10'000'000, [](double) { return 1e-12; });
  CHECK(told > 400'000);
  CHECK(told < 1'000'000);
}

TEST_CASE("steps near the rounding of the time are abandoned within a hundred thousand") {
  const std::size_t told =
      steps_until_told(1, 10'000'000, [](double n) { return n < 2 ? 0.5 : 1e-14; });
  CHECK(told > 0);
  CHECK(told < 100'000);
}

TEST_CASE("a nearby event is waited for, but not forever") {
  const auto steps = [](auto event) {
    Pace pace(1);
    std::size_t n = 1;
    while (!pace.creeps(1e-12 * static_cast<double>(n),
                        [&] { return event(1e-12 * static_cast<double>(n)); }))
      ++n;
    return n;
  };
  const std::size_t alone = steps([](double) { return 0.5; });
  // A run may take 700,000 steps to an event.
  CHECK(steps([](double time) { return time < 7e-7 ? 7e-7 : 0.5; }) >= 700'000);
  CHECK(alone < 700'000);
  // A receding event is not waited for.
  const std::size_t receding = steps([](double time) { return time + 1e-9; });
  CHECK(receding > alone);
  CHECK(receding < 2'000'000);
}

TEST_CASE("long or temporarily slow runs are not stopped") {
  CHECK(steps_until_told(1e6, 5'000'000, [](double) { return 0.001; }) == 0);
  // A transient of a hundred thousand short steps, then longer ones.
  CHECK(steps_until_told(1e6, 5'000'000, [](double n) { return n < 1e5 ? 1e-8 : 10.0; }) == 0);
  // Steps that shrink, but still reach the end.
  CHECK(steps_until_told(1, 5'000'000, [](double n) { return 1e-3 / std::sqrt(n); }) == 0);
}

TEST_CASE("the reason of a creeping run has numbers") {
  Pace pace(1);
  for (std::size_t n = 0; n < 3'000'000 && !pace.creeps(1e-12 * static_cast<double>(n)); ++n) {
  }
  CHECK_THAT(pace.reason(),
             Catch::Matchers::Contains("the last 4096 of them advanced it by 4.1e-09 s"));
}

TEST_CASE("a run that ends without all its rows has failed") {
  Outcome outcome;
  outcome.ending = Ending::done;
  outcome.rows = 11;
  CHECK(with_all_rows(outcome, 11).ending == Ending::done);
  CHECK(with_all_rows(outcome, 11).reason.empty());
  const Outcome lost = with_all_rows(outcome, 12);
  CHECK(lost.ending == Ending::failed);
  CHECK_THAT(lost.reason, Catch::Matchers::Contains("11 of 12"));
  for (const Ending other : {Ending::stopped, Ending::failed, Ending::interrupted}) {
    outcome.ending = other;
    CHECK(with_all_rows(outcome, 12).ending == other);
  }
}

}  // namespace bbsim_test::test_pace
