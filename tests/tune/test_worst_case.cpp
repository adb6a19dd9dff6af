// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The optimizer on problems with known answers.
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "catch.hpp"
#include "tune/cobyla.hpp"
#include "tune/worst_case.hpp"

namespace bbsim_test::test_worst_case {

using namespace bbsim::tune;

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

using Score = std::function<CaseScore(const Point& x, std::size_t number)>;

Problem problem_of(Point start, std::size_t cases, std::size_t requirements, const Score& score) {
  Problem problem;
  problem.start = std::move(start);
  problem.cases = cases;
  problem.requirements = requirements;
  problem.evaluate = [score](const std::vector<Point>& points, const std::vector<std::size_t>& of,
                             std::vector<CaseScore>& scores) {
    scores.clear();
    for (const Point& point : points) {
      for (const std::size_t number : of) scores.push_back(score(point, number));
    }
    return true;
  };
  return problem;
}

double square(double x) {
  return x * x;
}

}  // namespace

TEST_CASE("COBYLA finds the minimum under a constraint") {
  // The nearest point to (1, 1) within the unit circle about 0.
  double best = unlimited;
  Point at;
  Cobyla search;
  search.lower = {0, 0};
  search.upper = {1, 1};
  search.constraints = 1;
  search.tolerance = 1e-6;
  search.most = 500;
  search.function = [&](const Point& x, double& value, double* constraints) {
    value = square(x[0] - 1) + square(x[1] - 1);
    constraints[0] = square(x[0]) + square(x[1]) - 1;
    if (constraints[0] <= 1e-9 && value < best) best = value, at = x;
    return true;
  };
  minimize(search, {0.2, 0.3});
  REQUIRE(at.size() == 2);
  CHECK(at[0] == Approx(std::sqrt(0.5)).margin(1e-4));
  CHECK(at[1] == Approx(std::sqrt(0.5)).margin(1e-4));
}

TEST_CASE("exceptions of the function pass through the library") {
  Cobyla search;
  search.lower = {0};
  search.upper = {1};
  search.function = [](const Point&, double&, double*) -> bool { throw std::length_error("here"); };
  CHECK_THROWS_AS(minimize(search, {0.5}), std::length_error);
}

TEST_CASE("the worst of several cases is minimized") {
  // Parabolas about 0.2 to 0.6: in the middle the outer two are equal.
  const Found found = minimize(problem_of({0.9}, 9, 0, [](const Point& x, std::size_t number) {
    return CaseScore{square(x[0] - 0.2 - 0.05 * static_cast<double>(number)), {}};
  }));
  REQUIRE(found.best.size() == 1);
  CHECK(found.best[0] == Approx(0.4).margin(1e-3));
  CHECK(found.merit.objective == Approx(0.04).margin(1e-3));
  CHECK(found.scores.size() == 9);
  CHECK(found.at_start[0].objective == Approx(0.49));
  CHECK_FALSE(found.interrupted);
}

TEST_CASE("requirements bound the minimum") {
  // x + y with x y of at least 1/4: 1, at (1/2, 1/2).
  const Found found = minimize(problem_of({0.9, 0.8}, 1, 1, [](const Point& x, std::size_t) {
    return CaseScore{x[0] + x[1], {0.25 - x[0] * x[1]}};
  }));
  CHECK(found.merit.excess == 0);
  CHECK(found.merit.objective == Approx(1).margin(0.01));
  CHECK(found.best[0] * found.best[1] >= 0.25);
}

TEST_CASE("a single bad case among many is found and examined") {
  std::size_t runs = 0;
  const auto score = [&runs](const Point& x, std::size_t number) {
    ++runs;
    const double bad = number == 137 ? 10 * std::max(0.0, 0.5 - x[0]) : 0;
    return CaseScore{square(x[0] - 0.1) + square(x[1] - 0.7) + bad, {}};
  };
  const Found found = minimize(problem_of({0.3, 0.3}, 200, 0, score));
  CHECK(found.best[0] == Approx(0.5).margin(5e-3));
  CHECK(found.best[1] == Approx(0.7).margin(2e-2));
  CHECK(found.scores.size() == 200);
  CHECK(runs < 100 * found.tried);  // mostly a few cases each
}

TEST_CASE("a quantile ignores the worst cases") {
  Problem problem = problem_of({0.3}, 100, 1, [](const Point& x, std::size_t number) {
    return CaseScore{number < 5 ? unlimited : x[0], {number < 5 ? 1.0 : 0.4 - x[0]}};
  });
  problem.share = 0.95;
  const Found found = minimize(problem);
  CHECK(found.merit.unsettled == 0);
  CHECK(found.merit.excess == 0);
  CHECK(found.best[0] == Approx(0.4).margin(2e-3));

  problem.share = 0.96;
  CHECK(minimize(problem).merit.unsettled > 0);
}

TEST_CASE("a search leaves a region without finite values") {
  const Found found = minimize(problem_of({0.1, 0.1}, 1, 0, [](const Point& x, std::size_t) {
    const bool lost = x[0] < 0.8;
    return CaseScore{lost ? unlimited : x[0] + square(x[1] - 0.5), {}, lost ? 0.8 - x[0] : 0};
  }));
  CHECK(found.merit.unsettled == 0);
  CHECK(found.best[0] == Approx(0.8).margin(0.02));
  CHECK(found.best[1] == Approx(0.5).margin(0.05));
}

TEST_CASE("an infeasible requirement is missed by as little as possible") {
  const Found found = minimize(problem_of({0.9}, 1, 1, [](const Point& x, std::size_t) {
    return CaseScore{x[0], {0.1 + square(x[0] - 0.3)}};
  }));
  CHECK(found.merit.excess == Approx(0.1).margin(1e-3));
  CHECK(found.best[0] == Approx(0.3).margin(0.03));
}

TEST_CASE("the same problem gives the same result") {
  const Problem problem = problem_of({0.2, 0.9, 0.4}, 40, 1, [](const Point& x, std::size_t n) {
    const double shift = std::sin(static_cast<double>(n));
    return CaseScore{square(x[0] - 0.5 - 0.1 * shift) + std::abs(x[1] - 0.3) + x[2],
                     {0.2 + 0.05 * shift - x[2]}};
  });
  const Found one = minimize(problem), other = minimize(problem);
  CHECK(one.best == other.best);
  CHECK(one.tried == other.tried);
  CHECK(one.best[2] == Approx(0.25).margin(5e-3));
}

TEST_CASE("an interrupted search returns the best so far") {
  for (const std::size_t calls : {0, 1, 5}) {
    CAPTURE(calls);
    Problem problem = problem_of({0.9}, 20, 0, [](const Point& x, std::size_t) {
      return CaseScore{square(x[0]), {}};
    });
    std::size_t called = 0;
    problem.evaluate = [&, evaluate = problem.evaluate](const auto& points, const auto& cases,
                                                        auto& scores) {
      return called++ < calls && evaluate(points, cases, scores);
    };
    const Found found = minimize(problem);
    CHECK(found.interrupted);
    CHECK(found.best.empty() == (calls == 0));
    if (calls > 0) CHECK(found.scores.size() == 20);
  }
}

TEST_CASE("a quantile is one of the values") {
  CHECK(quantile_of({3, 1, 2, 4}, 1) == 4);
  CHECK(quantile_of({3, 1, 2, 4}, 0.75) == 3);
  CHECK(quantile_of({3, 1, 2, 4}, 0.76) == 4);
  CHECK(quantile_of({3, unlimited, 2, 4}, 0.5) == 3);
  CHECK(quantile_of({7}, 0.01) == 7);
}

}  // namespace bbsim_test::test_worst_case
