// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// An endless run is ended with a reason after bounded work; an event on the way still stops it.
#include "solve/hard_cases.hpp"

namespace bbsim_test::test_creep {

using namespace bbsim;

TEST_CASE("a run that creeps ends with its reason, with every method") {
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

TEST_CASE("an event that occurs before creeping is detected stops the run") {
  const Method method = GENERATE(Method::automatic, Method::bdf, Method::adams);
  CAPTURE(name_of(method));
  // The event is reached with steps of 1e-12 s.
  const Run run = run_in_memory(hard_case("creep", {"events.tilt={limit: 1.1e-4, action: stop}"}),
                                method, {1e-8, 1e-10});
  REQUIRE(run.outcome.ending == solve::Ending::stopped);
  CHECK(run.outcome.occurrences.back().name == "tilt");
}

}  // namespace bbsim_test::test_creep
