// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A run that would never end is ended, with its reason, in bounded work; one that an event stops on
// the way there is stopped.
#include "solve/hard_cases.hpp"

using namespace bbsim;
using namespace bbsim_test;

TEST_CASE("a run that creeps ends with its reason, by every method") {
  const Method method = GENERATE(Method::automatic, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  const Run run = run_in_memory(hard_case("creep"), method, {1e-8, 1e-10});
  CHECK(run.outcome.ending == solve::Ending::failed);
  CHECK_THAT(run.outcome.reason,
             Catch::Matchers::Contains("so short that the run would never end"));
  CHECK(run.outcome.reached > 1.6e-5);
  CHECK(run.outcome.reached < 1.8e-5);
  CHECK(run.outcome.last_state.size() == 9);
  CHECK(run.outcome.statistics.steps < 300'000);
}

TEST_CASE("an event that comes before creeping has lasted stops the run") {
  const Method method = GENERATE(Method::automatic, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  // Reached among steps of 1e-12 s.
  const Run run = run_in_memory(hard_case("creep", {"events.tilt={limit: 1.1e-4, action: stop}"}),
                                method, {1e-8, 1e-10});
  REQUIRE(run.outcome.ending == solve::Ending::stopped);
  CHECK(run.outcome.occurrences.back().name == "tilt");
}
