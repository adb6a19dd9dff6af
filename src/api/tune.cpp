// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "api/tune.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <thread>
#include <utility>

#include "api/fit_text.hpp"
#include "api/tune_text.hpp"
#include "base/number_text.hpp"
#include "base/quoted.hpp"
#include "base/short_number.hpp"
#include "base/text.hpp"
#include "fit/free_key.hpp"
#include "scenario/edit_text.hpp"
#include "scenario/measures.hpp"
#include "scenario/variation.hpp"
#include "sweep/sweep.hpp"
#include "tune/worst_case.hpp"

namespace bbsim::api {
namespace {

using scenario::Expectation;
using tune::CaseScore;

constexpr double unlimited = std::numeric_limits<double>::infinity();

// A free number, and the keys that take it, each times a factor.
struct FreeNumber {
  struct Key {
    std::string name, unit;
    double factor;
  };
  std::vector<Key> keys;
  double from = 0, to = 1, start = 0;

  // Ranges of positive numbers over more than a decade are searched by logarithm.
  [[nodiscard]] bool logarithmic() const { return from > 0 && to > 10 * from; }
  // Number at a place from 0 to 1.
  [[nodiscard]] double at(double place) const {
    if (place <= 0) return from;
    if (place >= 1) return to;
    return logarithmic() ? from * std::pow(to / from, place) : from + place * (to - from);
  }
  [[nodiscard]] double place_of(double number) const {
    return logarithmic() ? std::log(number / from) / std::log(to / from)
                         : (number - from) / (to - from);
  }
};

FreeNumber read_free(const std::string& text, const ScenarioFamily& family) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) {
    throw InputError("--free: " + shown(trimmed(text)) +
                     ": found no range; allowed: KEY=FROM:TO, such as "
                     "controller.gravity_compensation.kp=1:20");
  }
  const auto tied = scenario::tied_keys({text.substr(0, equals), text.substr(equals + 1)});
  if (tied.front().factor != 1) {
    throw InputError("--free: " + shown(trimmed(text)) +
                     ": found a factor before the first key; allowed: KEY,FACTOR*KEY=FROM:TO");
  }
  const fit::FreeKey first = fit::read_free_key(tied.front().path + text.substr(equals), family);
  FreeNumber number{{}, first.lower, first.upper, first.start};
  for (const scenario::TiedKey& key : tied) {
    const std::string unit =
        &key == &tied.front() ? first.unit : fit::read_free_key(key.path, family).unit;
    number.keys.push_back({key.path, unit, key.factor});
  }
  return number;
}

std::vector<FreeNumber> read_all_free(const TuneRequest& request) {
  std::vector<FreeNumber> free;
  std::vector<std::string> names;
  std::vector<ScenarioFamily::Setting> settings;
  for (const std::string& text : request.free) {
    free.push_back(read_free(text, request.family));
    for (const FreeNumber::Key& key : free.back().keys) {
      if (std::ranges::find(names, key.name) != names.end()) {
        throw InputError("--free: " + shown(key.name) + " is given twice");
      }
      names.push_back(key.name);
      settings.push_back({key.name, number_text(key.factor * free.back().start)});
    }
  }
  static_cast<void>(request.family.read(settings));
  return free;
}

// Rigs drawn from `--vary`.
std::optional<sweep::SweepPlan> rigs_of(const TuneRequest& request,
                                        const std::vector<FreeNumber>& free,
                                        std::optional<double> samples, double seed) {
  Sweep sweep;
  sweep.seed = seed;
  bool draws = false;
  for (const std::string& text : request.vary) {
    sweep.vary.push_back(scenario::split_variation(text));
    draws = draws || scenario::parse_variation(sweep.vary.back()).random();
    for (const scenario::TiedKey& key : scenario::tied_keys(sweep.vary.back())) {
      for (const FreeNumber& number : free) {
        if (std::ranges::find(number.keys, key.path, &FreeNumber::Key::name) == number.keys.end()) {
          continue;
        }
        throw InputError("--vary: " + shown(key.path) +
                         ": found among the free keys, too; allowed: one of the two");
      }
    }
  }
  const auto refuse = [](const std::string& option) {
    throw InputError(option + ": found, but no value is drawn; allowed: with --vary " +
                     "KEY=normal:MEAN:SD or uniform:FROM:TO");
  };
  if (!draws && request.samples) refuse("--samples");
  if (!draws && request.hold_out) refuse("--hold-out");
  if (sweep.vary.empty()) return {};
  sweep.samples = samples;
  return sweep::SweepPlan(request.family, sweep);
}

// Measures to minimize and to constrain, each once.
struct Goals {
  std::vector<scenario::Measure> measures;  // the first is minimized
  std::vector<Expectation> requirements;
  std::vector<std::size_t> of;  // index of each requirement's measure

  std::size_t place_of(const scenario::Measure& measure) {
    const auto same = [&](const scenario::Measure& other) {
      return other.name == measure.name && other.window_text == measure.window_text;
    };
    const auto found = std::ranges::find_if(measures, same);
    if (found != measures.end()) return static_cast<std::size_t>(found - measures.begin());
    measures.push_back(measure);
    return measures.size() - 1;
  }
};

Goals goals_of(const TuneRequest& request, const Scenario& scenario) {
  Goals goals;
  goals.measures.push_back(scenario::measure_named("--minimize", request.minimize, scenario));
  for (const std::string& text : request.require) {
    goals.requirements.push_back(scenario::read_expectation("--require", text, scenario));
    goals.of.push_back(goals.place_of(goals.requirements.back().measure));
  }
  return goals;
}

bool is_upper_bound(const Expectation& requirement) {
  return requirement.relation == Expectation::Relation::below ||
         requirement.relation == Expectation::Relation::at_most;
}

// A margin that no change of gain or delay uses up is infinite, and exceeds any bound.
bool is_endless_margin(const Expectation& requirement, double measured) {
  return requirement.measure.kind == scenario::Measure::Kind::loop && measured == unlimited &&
         !is_upper_bound(requirement);
}

// Amount by which a value misses a requirement, relative to its bound; 0 or less if it holds.
double excess_of(const Expectation& requirement, double measured) {
  if (is_endless_margin(requirement, measured)) return -1;
  if (!std::isfinite(measured)) return unlimited;
  const double scale = requirement.value != 0 ? std::abs(requirement.value) : 1;
  const double over =
      (is_upper_bound(requirement) ? measured - requirement.value : requirement.value - measured) /
      scale;
  if (requirement.holds(measured)) return std::min(over, 0.0);
  return std::max(over, std::numeric_limits<double>::min());
}

// Leaves out slips that are only noted, unless a key or a measure refers to them: they change no
// measure, but take a rig out of the lanes of a sweep.
std::vector<ScenarioFamily::Setting> without_notes(const TuneRequest& request,
                                                   const std::vector<FreeNumber>& free,
                                                   const Goals& goals) {
  const Scenario scenario = request.family.read({});
  const std::string section = "events.slip";
  const auto& slip = scenario.events.slip;
  if (!slip || slip->action != OnEvent::note || slip->sliding) return {};
  for (const std::string& varied : request.vary) {
    if (varied.starts_with(section)) return {};
  }
  for (const FreeNumber& number : free) {
    for (const FreeNumber::Key& key : number.keys) {
      if (key.name.starts_with(section)) return {};
    }
  }
  std::vector<ScenarioFamily::Setting> settings = {{section, "null"}};
  const Scenario without = request.family.read(settings);
  const auto is_missing = [&](const scenario::Measure& measure) {
    return bool(scenario::missing(measure, without));
  };
  if (std::ranges::any_of(goals.measures, is_missing)) return {};
  return settings;
}

// Runs rigs at points of the search.
class Rigs {
 public:
  Rigs(const TuneRequest& request, const std::vector<FreeNumber>& free, const Goals& goals,
       double end, Watch& watch)
      : request_(request),
        free_(free),
        goals_(goals),
        end_(end),
        watch_(watch),
        always_(without_notes(request, free, goals)) {
    for (const FreeNumber& number : free_) {
      for (const FreeNumber::Key& key : number.keys) keys_.push_back(key.name);
    }
  }

  // Returns false if interrupted.
  bool run(const sweep::SweepPlan* rigs, const std::vector<tune::Point>& points,
           const std::vector<std::size_t>& cases, std::vector<CaseScore>& scores,
           const std::function<void(double)>& progress = {}) {
    std::vector<sweep::SweepPlan::Listed> listed;
    for (const tune::Point& point : points) {
      const std::vector<double> numbers = numbers_at(point);
      for (const std::size_t one : cases) listed.push_back({one, numbers});
    }
    scores.clear();
    try {
      const sweep::SweepPlan plan(request_.family, rigs, keys_, listed, always_);
      sweep::SweepTask task{request_.family, plan, goals_.measures};
      task.report = [this](std::string_view line) { watch_.controller_says(line); };
      const std::size_t processors = std::max(1U, std::thread::hardware_concurrency());
      return sweep::run_sweep(
          sweep::choose_engine(task), {0, listed.size()},
          request_.threads > 0 ? request_.threads : processors, stop(), [](sweep::CaseResults&) {},
          [&](const sweep::CaseResults& results) {
            for (std::size_t i = 0; i < results.count; ++i) scores.push_back(score(results, i));
            if (progress) {
              progress(static_cast<double>(scores.size()) / static_cast<double>(listed.size()));
            }
          });
    } catch (const InputError& error) {  // the first rig has no such scenario
      reason_ = error.what();
      scores.assign(listed.size(), lost(1));
      return !stop().load(std::memory_order_relaxed);
    }
  }

  [[nodiscard]] std::vector<double> numbers_at(const tune::Point& point) const {
    std::vector<double> numbers;
    for (std::size_t i = 0; i < free_.size(); ++i) {
      for (const FreeNumber::Key& key : free_[i].keys) {
        numbers.push_back(key.factor * free_[i].at(point[i]));
      }
    }
    return numbers;
  }

  // Latest reason why a case failed or gave no value.
  [[nodiscard]] const std::string& reason() const { return reason_; }

 private:
  [[nodiscard]] const std::atomic<bool>& stop() const {
    static constexpr std::atomic<bool> never{false};
    const std::atomic<bool>* const stop = watch_.stop();
    return stop != nullptr ? *stop : never;
  }

  [[nodiscard]] CaseScore lost(double missed) const {
    return {unlimited, std::vector<double>(goals_.requirements.size(), unlimited), missed,
            std::vector<double>(goals_.measures.size(), std::nan(""))};
  }

  CaseScore score(const sweep::CaseResults& results, std::size_t i) {
    const double* const numbers = &results.numbers[i * (1 + goals_.measures.size())];
    const sweep::CaseStatus& status = results.status[i];
    if (status.word != "done") {
      reason_ = status.word + ": " + status.reason;
      const double left = 1 - numbers[0] / end_;
      return lost(std::isfinite(left) ? std::clamp(left, 0.0, 1.0) : 1.0);
    }
    if (!status.reason.empty()) reason_ = status.reason;
    CaseScore made;
    made.numbers.assign(numbers + 1, numbers + 1 + goals_.measures.size());
    made.objective = std::isfinite(made.numbers[0]) ? made.numbers[0] : unlimited;
    for (std::size_t r = 0; r < goals_.requirements.size(); ++r) {
      made.excess.push_back(excess_of(goals_.requirements[r], made.numbers[goals_.of[r]]));
    }
    return made;
  }

  const TuneRequest& request_;
  const std::vector<FreeNumber>& free_;
  const Goals& goals_;
  const double end_;
  Watch& watch_;
  std::vector<ScenarioFamily::Setting> always_;
  std::vector<std::string> keys_;
  std::string reason_;
};

// Value on the worst rig that counts: the greatest, or the least if it should be large.
double worst_of(const Expectation& requirement, std::size_t measure,
                const std::vector<CaseScore>& scores, double share) {
  const double sign = is_upper_bound(requirement) ? 1 : -1;
  std::vector<double> values;
  for (const CaseScore& score : scores) {
    const double value = score.numbers[measure];
    const bool counts = std::isfinite(value) || is_endless_margin(requirement, value);
    values.push_back(counts ? sign * value : unlimited);
  }
  return sign * tune::quantile_of(std::move(values), share);
}

Tuned summed_up(const TuneRequest& request, const std::vector<FreeNumber>& free, const Goals& goals,
                const tune::Found& found) {
  Tuned tuned;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const FreeNumber& number = free[i];
    for (const FreeNumber::Key& key : number.keys) {
      const auto times = [&](double value) { return key.factor * value; };
      tuned.parameters.push_back({key.name, key.unit, times(number.start),
                                  times(number.at(found.best[i])), times(number.from),
                                  times(number.to)});
    }
  }
  tuned.minimized = goals.measures.front();
  tuned.before = tune::merit_of(found.at_start, request.quantile).objective;
  tuned.objective = found.merit.objective;
  for (std::size_t r = 0; r < goals.requirements.size(); ++r) {
    const Expectation& wanted = goals.requirements[r];
    const double value = worst_of(wanted, goals.of[r], found.scores, request.quantile);
    tuned.requirements.push_back(
        {wanted, worst_of(wanted, goals.of[r], found.at_start, request.quantile), value,
         (std::isfinite(value) || is_endless_margin(wanted, value)) && wanted.holds(value)});
  }
  tuned.rigs = found.scores.size();
  tuned.tried = found.tried;
  return tuned;
}

bool all_holds(const CaseScore& score) {
  return std::isfinite(score.objective) &&
         std::ranges::all_of(score.excess, [](double excess) { return excess <= 0; });
}

// Which parts of the request are not met; empty if all are.
std::string shortfall(const Tuned& tuned, const std::string& reason) {
  std::string text;
  for (const Tuned::Requirement& one : tuned.requirements) {
    if (one.holds) continue;
    const std::string unit = one.expectation.measure.unit();
    text += (text.empty() ? "" : "\n") + std::string("tune: found no values with ") +
            one.expectation.text + "; the best has " + short_number(one.value) +
            (unit.empty() ? "" : " " + unit);
  }
  if (text.empty() && !std::isfinite(tuned.objective)) {
    text = "tune: found no values with a finite " + tuned.minimized.name;
  }
  if (!text.empty() && !reason.empty()) text += "\n  a rig: " + reason;
  return text;
}

}  // namespace

TuneResult tune(const TuneRequest& request, bool with_scenario, Watch& watch) {
  if (!(request.quantile > 0) || !(request.quantile <= 1)) {
    throw InputError("--quantile: found " + number_text(request.quantile) +
                     "; allowed: a share above 0 and up to 1, such as 0.95");
  }
  const ScenarioFamily& family = request.family;
  const Scenario scenario = family.read({});
  for (const std::string& remark : scenario.remarks) watch.note(remark);
  const std::vector<FreeNumber> free = read_all_free(request);
  const Goals goals = goals_of(request, scenario);
  constexpr double seed = 1, seed_of_others = 2;
  const std::optional<sweep::SweepPlan> drawn = rigs_of(request, free, request.samples, seed);
  const std::optional<sweep::SweepPlan> others =
      request.hold_out ? rigs_of(request, free, request.hold_out, seed_of_others) : std::nullopt;
  for (const auto* const plan : {&drawn, &others}) {
    if (*plan)
      static_cast<void>((*plan)->check(family, 0, (*plan)->cases(), [](double) { return true; }));
  }
  if (with_scenario) {  // fails before the work if the text cannot be written
    std::vector<ScenarioFamily::Setting> settings;
    for (const FreeNumber& number : free) {
      for (const FreeNumber::Key& key : number.keys) {
        settings.push_back({key.name, number_text(key.factor * number.start)});
      }
    }
    static_cast<void>(edited_scenario(family.source(), "", settings));
  }

  Rigs rigs(request, free, goals, scenario.time.end, watch);
  tune::Problem problem;
  for (const FreeNumber& number : free) problem.start.push_back(number.place_of(number.start));
  problem.cases = drawn ? drawn->cases() : 1;
  problem.requirements = goals.requirements.size();
  problem.share = request.quantile;
  problem.evaluate = [&](const std::vector<tune::Point>& points,
                         const std::vector<std::size_t>& cases, std::vector<CaseScore>& scores) {
    return rigs.run(drawn ? &*drawn : nullptr, points, cases, scores);
  };
  problem.progress = [&](double fraction, double objective) {
    watch.update(fraction, goals.measures.front().name + " " + rounded(objective, 3));
  };
  TuneResult made;
  watch.start(0);
  tune::Found found = tune::minimize(problem);
  if (found.best.empty()) {
    watch.end();
    made.code = ExitCode::interrupted;
    made.reason = "tune: interrupted before the first result; nothing is written";
    return made;
  }
  made.tuned = summed_up(request, free, goals, found);
  if (others && !found.interrupted) {
    std::vector<std::size_t> cases(others->cases());
    std::iota(cases.begin(), cases.end(), std::size_t{0});
    std::vector<CaseScore> scores;
    found.interrupted = !rigs.run(&*others, {found.best}, cases, scores,
                                  [&](double part) { watch.update(part, "rigs held out"); });
    if (!found.interrupted) {
      made.tuned->held_out = cases.size();
      made.tuned->share_that_holds = static_cast<double>(std::ranges::count_if(scores, all_holds)) /
                                     static_cast<double>(cases.size());
    }
  }
  watch.end();
  made.reason = shortfall(*made.tuned, rigs.reason());
  if (!made.reason.empty()) made.code = ExitCode::ended_early;
  if (found.interrupted) {
    made.code = ExitCode::interrupted;
    made.reason = "tune: interrupted after " + std::to_string(found.tried) +
                  " tries; the result is the best of them" +
                  (made.reason.empty() ? "" : "\n" + made.reason);
  }
  made.text = report_of(request, *made.tuned);
  made.json = json_of(*made.tuned);
  if (with_scenario) made.scenario = tuned_scenario(request, *made.tuned);
  return made;
}

}  // namespace bbsim::api
