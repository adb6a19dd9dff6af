// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Detects runs that creep, without mistaking slow runs, and runs that lose rows.
#include <cmath>

#include "catch.hpp"
#include "solve/outcome.hpp"
#include "solve/pace.hpp"

namespace bbsim_test::test_pace {

using namespace bbsim::solve;

TEST_CASE("runs that creep are told from long and temporarily slow ones, within some windows") {
  struct Case {
    const char* what;
    double end;                 // s
    double (*length)(double);   // of step n
    std::size_t least, before;  // steps until it is told; 0 if it is never
  };
  const Case cases[] = {
      {"a sum of steps that converges before the end", 10,
       [](double n) { return 1e-4 * std::exp(-n / 2e4); }, 1, 400'000},
      {"one that converges slowly", 10, [](double n) { return 1e-4 / (1 + n * n / 1e6); }, 1,
       1'000'000},
      {"time stops", 10, [](double n) { return n < 10 ? 0.1 : 0.0; }, 1, 10'000'000},
      {"it would take days", 1, [](double) { return 1e-12; }, 400'001, 1'000'000},
      {"steps near the rounding of the time", 1, [](double n) { return n < 2 ? 0.5 : 1e-14; }, 1,
       100'000},
      {"a long run", 1e6, [](double) { return 0.001; }, 0, 0},
      {"a transient of short steps", 1e6, [](double n) { return n < 1e5 ? 1e-8 : 10.0; }, 0, 0},
      {"steps that shrink, but reach the end", 1, [](double n) { return 1e-3 / std::sqrt(n); }, 0,
       0}};
  for (const Case& one : cases) {
    CAPTURE(one.what);
    Pace pace(one.end);
    double time = 0;
    std::size_t told = 0;
    for (std::size_t n = 1; n <= 5'000'000 && time < one.end && told == 0; ++n) {
      time += one.length(static_cast<double>(n));
      if (pace.creeps(time)) told = n;
    }
    CHECK(told >= one.least);
    CHECK((one.before == 0 ? told == 0 : told < one.before));
  }
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

TEST_CASE("a run that ends without all its rows has failed") {
  Outcome outcome;
  outcome.ending = Ending::done;
  outcome.rows = 11;
  CHECK(with_all_rows(outcome, 11).ending == Ending::done);
  CHECK(with_all_rows(outcome, 11).reason.empty());
  const Outcome lost = with_all_rows(outcome, 12);
  CHECK(lost.ending == Ending::failed);
  CHECK_FALSE(lost.reason.empty());
  for (const Ending other : {Ending::stopped, Ending::failed, Ending::interrupted}) {
    outcome.ending = other;
    CHECK(with_all_rows(outcome, 12).ending == other);
  }
}

}  // namespace bbsim_test::test_pace
