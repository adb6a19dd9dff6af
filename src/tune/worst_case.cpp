// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "tune/worst_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "tune/cobyla.hpp"

namespace bbsim::tune {
namespace {

// The number of cases that run together.
constexpr std::size_t group = 8;
// The numbers of cases in a search. With up to first_cases cases, each search runs all of them.
constexpr std::size_t first_cases = 2 * group, most_cases = 4 * group;
// Limits on rounds. Evaluations of a scan and of a search, in multiples of the number of
// parameters plus 1.
constexpr std::size_t most_rounds = 8, most_stalled = 2;
constexpr std::size_t scanned = 8, first_search = 16, later_search = 8;
constexpr double first_step = 0.15, later_step = 0.04;
// Tightens the requirements, because a search may end on either side of them.
constexpr double margin = 1e-3;

// Number `i` of the van der Corput sequence.
double reversed(std::size_t i, std::size_t base) {
  double result = 0, digit = 1;
  for (; i > 0; i /= base) {
    digit /= static_cast<double>(base);
    result += digit * static_cast<double>(i % base);
  }
  return result;
}

// Point `i`, from 1, of a sequence that fills the unit cube evenly: Halton's in the first ten
// dimensions, multiples of irrational numbers in the others.
Point spread(std::size_t i, std::size_t size) {
  constexpr std::array<std::size_t, 10> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29};
  Point point(size);
  for (std::size_t k = 0; k < size; ++k) {
    if (k < primes.size()) {
      point[k] = reversed(i, primes[k]);
      continue;
    }
    double whole = 0;
    point[k] = std::modf(static_cast<double>(i) * std::sqrt(static_cast<double>(k) + 0.5), &whole);
  }
  return point;
}

class Search {
 public:
  explicit Search(const Problem& problem)
      : problem_(problem), all_(problem.cases), size_(problem.start.size() + 1) {
    std::iota(all_.begin(), all_.end(), std::size_t{0});
  }

  Found run() {
    found_.interrupted = !search();
    return std::move(found_);
  }

 private:
  struct Candidate {
    Point point;
    Merit merit;
  };

  // Returns false if interrupted.
  bool search() {
    if (!try_in_all(problem_.start)) return false;
    found_.at_start = found_.scores;
    choose_cases();
    std::vector<Candidate> starts;
    if (!scan(starts)) return false;
    std::optional<Candidate> best;
    for (const Candidate& start : starts) {
      if (!go_down(start.point, first_step, first_search * size_, best)) return false;
    }
    for (std::size_t round = 0, stalled = 0;; ++round) {
      const Merit expected = best->merit, before = found_.merit;
      if (!try_in_all(best->point)) return false;
      const bool others_are_worse = is_worse(last_, expected);
      stalled = has_come_down(before, found_.merit) ? stalled + 1 : 0;
      const bool settled = !others_are_worse && expected_ && has_come_down(*expected_, expected);
      if (round == most_rounds || settled || stalled == most_stalled) return true;
      if (others_are_worse) add_cases();
      expected_ = others_are_worse ? std::nullopt : std::optional(expected);
      best.reset();
      if (!go_down(found_.best, later_step, later_search * size_, best)) return false;
    }
  }

  // Whether a round gained almost nothing.
  static bool has_come_down(const Merit& before, const Merit& now) {
    constexpr double little = 1e-3;
    return now.unsettled >= (1 - little) * before.unsettled &&
           now.excess >= (1 - little) * before.excess &&
           before.objective - now.objective <= little * std::abs(now.objective);
  }

  // Worse by more than rounding, which depends on the cases that run together.
  static bool is_worse(const Merit& in_all, const Merit& expected) {
    constexpr double rounding = 1e-6;
    if (expected.unsettled > 0 || in_all.unsettled > 0)
      return in_all.unsettled > expected.unsettled;
    return in_all.excess > expected.excess + rounding ||
           in_all.objective > expected.objective + rounding * std::abs(expected.objective);
  }

  bool evaluate(const std::vector<Point>& points, const std::vector<std::size_t>& cases) {
    if (!problem_.evaluate(points, cases, scores_)) return false;
    found_.tried += points.size();
    const double planned =
        static_cast<double>(size_ * (scanned + 2 * first_search + 3 * later_search));
    const double done = static_cast<double>(found_.tried) / planned;
    problem_.progress(done / (0.2 + done), found_.merit.objective);
    return true;
  }

  // Tries a point in all cases and remembers the best point.
  bool try_in_all(const Point& point) {
    if (!evaluate({point}, all_)) return false;
    last_ = merit_of(scores_, problem_.share);
    last_scores_ = scores_;
    if (!found_.best.empty() && !last_.better_than(found_.merit)) return true;
    found_.best = point;
    found_.merit = last_;
    found_.scores = scores_;
    return true;
  }

  // Chooses the cases for the searches: the worst ones, and a spread over all cases.
  void choose_cases() {
    cases_ = all_;
    if (all_.size() <= first_cases || problem_.share < 1) return;
    cases_.clear();
    add_worst(found_.scores, all_, group);
    for (std::size_t i = 0; cases_.size() < first_cases; ++i) {
      add(i * all_.size() / first_cases);
      if (i >= first_cases) add(i - first_cases);
    }
    std::ranges::sort(cases_);
  }

  // Adds the worst of all cases and drops the mildest of the previous ones.
  void add_cases() {
    const std::vector<std::size_t> before = std::exchange(cases_, {});
    add_worst(last_scores_, all_, group);
    add_worst(last_scores_, before, std::min(before.size() + group, most_cases) - cases_.size());
    add_worst(last_scores_, all_, std::min(before.size() + group, most_cases) - cases_.size());
    std::ranges::sort(cases_);
  }

  void add(std::size_t one) {
    if (one < all_.size() && std::ranges::find(cases_, one) == cases_.end()) cases_.push_back(one);
  }

  // Adds up to `count` of `cases`: the worst by the objective and by each requirement, in turn.
  void add_worst(const std::vector<CaseScore>& scores, const std::vector<std::size_t>& cases,
                 std::size_t count) {
    std::vector<std::vector<std::size_t>> orders;
    const auto add_order = [&](const auto& value) {
      std::vector<std::size_t> order = cases;
      std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return std::pair(value(scores[a]), scores[a].missed) >
               std::pair(value(scores[b]), scores[b].missed);
      });
      orders.push_back(std::move(order));
    };
    add_order([](const CaseScore& score) { return score.objective; });
    for (std::size_t r = 0; r < problem_.requirements; ++r) {
      add_order([r](const CaseScore& score) { return score.excess[r]; });
    }
    const std::size_t wanted = std::min(all_.size(), cases_.size() + count);
    for (std::size_t i = 0; i < cases.size(); ++i) {
      for (const auto& order : orders) {
        if (cases_.size() < wanted) add(order[i]);
      }
    }
  }

  // Finds the starting points: the given one, and the best of the points that fill the cube.
  bool scan(std::vector<Candidate>& starts) {
    std::vector<Point> points{problem_.start};
    for (std::size_t i = 1; i <= scanned * size_; ++i) {
      points.push_back(spread(i, problem_.start.size()));
    }
    if (!evaluate(points, cases_)) return false;
    std::vector<Candidate> all;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto first = scores_.begin() + static_cast<std::ptrdiff_t>(i * cases_.size());
      const std::vector<CaseScore> its(first, first + static_cast<std::ptrdiff_t>(cases_.size()));
      all.push_back({points[i], merit_of(its, problem_.share)});
    }
    starts.push_back(all.front());
    starts.push_back(*std::min_element(
        all.begin() + 1, all.end(),
        [](const Candidate& a, const Candidate& b) { return a.merit.better_than(b.merit); }));
    return true;
  }

  // Minimizes from a point, over the chosen cases only. The maximum over the cases has kinks, which
  // linear models cannot follow. Therefore the search minimizes an additional variable, a bound on
  // the value of each case; these values are smooth.
  bool go_down(const Point& from, double step, std::size_t most, std::optional<Candidate>& best) {
    if (!evaluate({from}, cases_)) return false;
    Point at = from;
    Merit merit = merit_of(scores_, problem_.share);
    const bool settled = merit.unsettled == 0;
    const double scale = settled && merit.objective != 0 ? std::abs(merit.objective) : 1;
    const double first = settled ? merit.objective / scale : 1;
    // An infinite value counts as the largest finite one so far.
    double greatest = 1;
    const auto bounded = [&](double value) {
      return std::isfinite(value) ? std::min(value / scale, 10 * greatest) : greatest;
    };
    const auto excess = [](double value) { return std::clamp(value + margin, -1.0, 2.0); };
    const auto remember = [&] {
      if (merit.unsettled == 0) greatest = std::max(greatest, merit.objective / scale);
      if (!best || merit.better_than(best->merit)) best = Candidate{at, merit};
    };
    remember();

    bool interrupted = false;
    const std::size_t pieces = problem_.share < 1 ? 1 : cases_.size();
    Cobyla search;
    search.lower.assign(from.size(), 0);
    search.upper.assign(from.size(), 1);
    search.lower.push_back(-std::numeric_limits<double>::infinity());
    search.upper.push_back(std::numeric_limits<double>::infinity());
    search.constraints = pieces * (1 + problem_.requirements) + 1;
    search.step = step;
    search.most = most;
    search.function = [&](const Point& x, double& value, double* constraints) {
      if (!std::equal(at.begin(), at.end(), x.begin())) {  // not only the bound changed
        at.assign(x.begin(), x.end() - 1);
        interrupted = !evaluate({at}, cases_);
        if (interrupted) return false;
        merit = merit_of(scores_, problem_.share);
        remember();
      }
      value = x.back();
      if (problem_.share < 1) {  // the cases that matter depend on x
        *constraints++ = bounded(merit.objective) - value;
        for (const double one : merit.excesses) *constraints++ = excess(one);
      } else {
        for (const CaseScore& score : scores_) {
          *constraints++ = bounded(score.objective) - value;
          for (const double one : score.excess) *constraints++ = excess(one);
        }
      }
      *constraints = merit.unsettled > 0 ? merit.unsettled : -0.1;
      return true;
    };
    Point start = from;
    start.push_back(first);
    minimize(search, std::move(start));
    return !interrupted;
  }

  const Problem& problem_;
  std::vector<std::size_t> all_, cases_;
  std::size_t size_;
  Found found_;
  std::vector<CaseScore> scores_, last_scores_;
  Merit last_;
  std::optional<Merit> expected_;
};

}  // namespace

bool CaseScore::settled() const {
  return std::isfinite(objective) &&
         std::ranges::all_of(excess, [](double value) { return std::isfinite(value); });
}

bool Merit::better_than(const Merit& other) const {
  if (unsettled != other.unsettled) return unsettled < other.unsettled;
  if (excess != other.excess) return excess < other.excess;
  return objective < other.objective;
}

double quantile_of(std::vector<double> values, double share) {
  const double whole = std::ceil(share * static_cast<double>(values.size()) * (1 - 1e-12));
  const std::size_t place = std::max<std::size_t>(1, static_cast<std::size_t>(whole)) - 1;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

Merit merit_of(const std::vector<CaseScore>& scores, double share) {
  Merit merit;
  std::vector<double> values(scores.size());
  const auto quantile = [&](const auto& value) {
    std::ranges::transform(scores, values.begin(), value);
    return quantile_of(values, share);
  };
  merit.objective = quantile([](const CaseScore& score) { return score.objective; });
  bool settled = std::isfinite(merit.objective);
  for (std::size_t r = 0; r < scores.front().excess.size(); ++r) {
    merit.excesses.push_back(quantile([r](const CaseScore& score) { return score.excess[r]; }));
    merit.excess = std::max(merit.excess, merit.excesses.back());
    settled = settled && std::isfinite(merit.excesses.back());
  }
  if (settled) return merit;
  for (const CaseScore& score : scores) {
    if (!score.settled())
      merit.unsettled += (1 + score.missed) / static_cast<double>(scores.size());
  }
  // Excesses may be infinite here; do not compare them.
  merit.excess = 0;
  return merit;
}

Found minimize(const Problem& problem) {
  return Search(problem).run();
}

}  // namespace bbsim::tune
