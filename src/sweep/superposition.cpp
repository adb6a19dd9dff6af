// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/superposition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "record/track/gimbal_extremes.hpp"
#include "record/track/kernels/track_kernels.hpp"
#include "record/track/padded_rows.hpp"
#include "record/track/spans.hpp"
#include "solve/choose.hpp"
#include "solve/radau/radau.hpp"
#include "sweep/case_scenario.hpp"
#include "sweep/recorded_motion.hpp"
#include "sweep/verdict.hpp"

namespace bbsim::sweep {
namespace {

using Kind = scenario::Measure::Kind;

// Close to rounding errors: the solutions are computed only once.
constexpr solve::Tolerances finest{1e-13, 1e-15};

// A term in which z' = A(t) z + g b_g(t) + r b_r(t) is linear.
struct LinearPart {
  std::array<std::string_view, 2> keys;  // keys of the factor; u = r gamma' has two
  double (*factor)(const Scenario& scenario);
};
constexpr LinearPart linear_parts[] = {
    {{"ball.position.0", ""}, [](const Scenario& s) { return s.ball.position[0]; }},
    {{"ball.position.1", ""}, [](const Scenario& s) { return s.ball.position[1]; }},
    {{"ball.velocity.0", ""}, [](const Scenario& s) { return s.ball.velocity[0]; }},
    {{"ball.velocity.1", ""}, [](const Scenario& s) { return s.ball.velocity[1]; }},
    {{"ball.spin", "ball.radius"}, [](const Scenario& s) { return s.ball.radius * s.ball.spin; }},
    {{"ball.radius", ""}, [](const Scenario& s) { return s.ball.radius; }},
    {{"gravity", ""}, [](const Scenario& s) { return s.gravity; }},
};
constexpr std::size_t part_count = std::size(linear_parts), states = 5;

bool depends_on(const LinearPart& part, const std::string& key) {
  return key == part.keys[0] || key == part.keys[1];
}

bool is_superposed(const scenario::Measure& measure) {
  if (!measure.window.is_whole()) return false;
  const std::string_view name = measure.column->name;
  if (measure.kind == Kind::end) return name == "x" || name == "y";
  return measure.kind == Kind::greatest &&
         (name == "distance" || name == "tilt" || name == "tilt_rate");
}

// Greatest error of x and y between points, relative to their size. Squares are then accurate to
// 1e-10.
constexpr double shown = 1e-12;
constexpr int most_halvings = 12;

}  // namespace

// The solutions for each term with a factor of 1: x and y of all terms at the same times. The times
// are the Chebyshev points of stretches, independent of the output times. Stretches are so short
// that polynomials through these points represent the motions.
struct Superposed {
  struct Term {
    const LinearPart* part;  // null: everything that does not vary
    record::PaddedRows x, y;
  };
  std::vector<Term> terms;
  std::vector<record::Span> stretches;
  std::size_t points = 0;
  double end = 0;
  record::GimbalExtremes::Greatest gimbal;
};

namespace {

// Cuts the time into stretches on which polynomials through a given number of points represent all
// motions.
class Stretches {
 public:
  Stretches(const std::vector<RecordedMotion>& motions, std::size_t intervals)
      : motions_(&motions), points_(intervals) {}

  // Call this with one stretch after the other. No input may have a corner inside one.
  void add(double from, double to, int halvings = 0) {
    const bool is_shown = all_shown_ && are_shown(from, to);
    if (!is_shown && halvings == most_halvings) all_shown_ = false;
    if (!is_shown && all_shown_) {
      const double middle = from + (to - from) / 2;
      add(from, middle, halvings + 1);
      add(middle, to, halvings + 1);
      return;
    }
    for (std::size_t i = 0; i < points_.size(); ++i) {
      times_.push_back(i + 1 < points_.size() ? from + (to - from) * points_[i] : to);
    }
  }

  // Whether the stretches represent the motions. They do not if a motion is not finite or varies
  // too fast.
  [[nodiscard]] bool all_shown() const { return all_shown_; }
  [[nodiscard]] std::size_t intervals() const { return points_.size() - 1; }
  [[nodiscard]] const std::vector<double>& times() const { return times_; }

 private:
  // The error is relative to each motion's greatest size in the integrator's steps there, because
  // the motion itself is no more accurate.
  [[nodiscard]] bool are_shown(double from, double to) const {
    std::vector<double> x(points_.size()), y(points_.size());
    return std::all_of(motions_->begin(), motions_->end(), [&](const RecordedMotion& motion) {
      for (std::size_t i = 0; i < points_.size(); ++i) {
        const auto position = motion.at(from + (to - from) * points_[i]);
        x[i] = position[0];
        y[i] = position[1];
      }
      return points_.tail(x.data()) + points_.tail(y.data()) <= shown * motion.size(from, to);
    });
  }

  const std::vector<RecordedMotion>* motions_;
  ChebyshevPoints points_;
  std::vector<double> times_;
  bool all_shown_ = true;
};

// The division into stretches with the fewest points; empty if none represents all motions. High
// degrees need fewer points, unless the inputs have many corners.
std::optional<Stretches> fewest_points(const std::vector<RecordedMotion>& motions,
                                       const model::Model& model, double end) {
  std::optional<Stretches> fewest;
  for (const std::size_t intervals : {15, 7}) {
    Stretches tried(motions, intervals);
    double from = 0;
    for (const double stop : model.stops) {
      tried.add(from, stop);
      from = stop;
    }
    tried.add(from, end);
    if (!tried.all_shown()) continue;
    if (!fewest || tried.times().size() < fewest->times().size()) fewest = std::move(tried);
  }
  return fewest;
}

// Evaluates x and y of all terms at these points.
void fill(Superposed& solutions, const std::vector<RecordedMotion>& motions,
          const Stretches& stretches) {
  const std::vector<double>& times = stretches.times();
  solutions.points = times.size();
  for (std::size_t first = 0; first < times.size(); first += stretches.intervals() + 1) {
    solutions.stretches.push_back({first, stretches.intervals()});
  }
  for (std::size_t k = 0; k < motions.size(); ++k) {
    Superposed::Term& term = solutions.terms[k];
    term.x.resize(times.size());
    term.y.resize(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      const auto position = motions[k].at(times[i]);
      term.x.data()[i] = position[0];
      term.y.data()[i] = position[1];
    }
    term.x.pad(times.size());
    term.y.pad(times.size());
  }
}

}  // namespace

bool can_superpose(const SweepTask& task) {
  if (!task.series.empty()) return false;
  if (!std::all_of(task.measures.begin(), task.measures.end(), is_superposed)) return false;
  for (const PlanAxis& axis : task.plan.axes()) {
    const auto linear = [&](const LinearPart& part) { return depends_on(part, axis.key); };
    if (!axis.independent || std::none_of(std::begin(linear_parts), std::end(linear_parts), linear))
      return false;
  }
  const Scenario scenario = task.family.read(task.plan.settings(0));
  if (!scenario.gimbal.motion || scenario.solver.error ||
      solve::choose_method(scenario.solver.method) != Method::radau) {
    return false;
  }
  // In a smaller sweep, the solutions would cost more than the cases.
  constexpr std::size_t worth_it = 32;
  const model::Model model = model::assemble(scenario, false);
  using General = model::OpenLoop<model::Shape::full, model::SignalPair, model::GeneralRolling>;
  return task.plan.cases() >= worth_it && !model.hybrid() &&
         !std::holds_alternative<General>(model.system);
}

std::shared_ptr<const Superposed> solve_superposed(const SweepTask& task) {
  const Scenario scenario = task.family.read(task.plan.settings(0));
  const solve::OutputGrid grid(scenario.time);
  model::Model model = model::assemble(scenario, false);
  model::SignalPair motion;
  std::visit(
      [&](const auto& system) {
        if constexpr (std::decay_t<decltype(system)>::open_loop) motion = system.motion();
      },
      model.system);

  // Parts that vary become terms; the others have fixed factors in the first term.
  std::array<double, part_count> fixed{};
  auto solutions = std::make_shared<Superposed>();
  solutions->terms.push_back({nullptr, {}, {}});
  for (std::size_t p = 0; p < part_count; ++p) {
    const auto& axes = task.plan.axes();
    if (std::any_of(axes.begin(), axes.end(),
                    [&](const PlanAxis& axis) { return depends_on(linear_parts[p], axis.key); })) {
      solutions->terms.push_back({&linear_parts[p], {}, {}});
    } else {
      fixed[p] = linear_parts[p].factor(scenario);
    }
  }

  solutions->end = grid.end();
  std::vector<RecordedMotion> motions;
  for (const Superposed::Term& term : solutions->terms) {
    std::array<double, part_count> factors = fixed;
    if (term.part != nullptr) {
      factors = {};
      factors[static_cast<std::size_t>(term.part - linear_parts)] = 1;
    }
    model.system = model::OpenLoop<model::Shape::full>(factors[5], factors[6], motion);
    model.initial.assign(factors.begin(), factors.begin() + states);
    const int stages = solve::radau::choose_stages(model, finest.rtol);
    solve::radau::RadauStepper stepper(model, solve::radau::choose_kernels(), stages, finest,
                                       grid.end());
    // Accelerations are polynomials through the stages, so positions have two degrees more.
    RecordedMotion& recorded =
        motions.emplace_back(static_cast<std::size_t>(stages) + 1, model.row_size());
    const solve::Outcome outcome = solve::run_through(stepper, model, grid, recorded, {});
    if (outcome.ending != solve::Ending::done) return nullptr;
  }
  const std::optional<Stretches> stretches = fewest_points(motions, model, grid.end());
  if (!stretches) return nullptr;
  fill(*solutions, motions, *stretches);
  // The tilt depends only on the motion of the gimbal.
  solutions->gimbal = record::GimbalExtremes().of(motion, grid.end());
  return solutions;
}

namespace {

class SuperpositionRunner : public CaseRunner {
 public:
  SuperpositionRunner(const SweepTask& task, std::shared_ptr<const Superposed> solutions)
      : task_(task),
        scenario_(task),
        solutions_(std::move(solutions)),
        kernels_(record::choose_track_kernels()),
        factors_(solutions_->terms.size()) {
    squares_.resize(solutions_->points);
    for (const Superposed::Term& term : solutions_->terms) {
      x_.push_back(term.x.data());
      y_.push_back(term.y.data());
    }
    for (const scenario::Measure& measure : task.measures) take_.push_back(take_of(measure));
  }

  std::size_t run(std::size_t first, std::size_t count, CaseResults& into,
                  const std::atomic<bool>& stop) override {
    if (stop.load(std::memory_order_relaxed)) return 0;
    into.first = first;
    into.resize(count, task_);
    const std::size_t axes = task_.plan.axes().size(), numbers = 1 + task_.measures.size();
    for (std::size_t i = 0; i < count; ++i) {
      task_.plan.values(first + i, &into.values[i * axes]);
      run_case(first + i, &into.values[i * axes], &into.numbers[i * numbers], into.status[i]);
    }
    return count;
  }

 private:
  void run_case(std::size_t number, const double* values, double* numbers, CaseStatus& status) {
    const Scenario& scenario = scenario_.at(number, values);
    factors_[0] = 1;
    for (std::size_t k = 1; k < factors_.size(); ++k) {
      factors_[k] = solutions_->terms[k].part->factor(scenario);
    }
    numbers[0] = solutions_->end;
    for (std::size_t m = 0; m < take_.size(); ++m) numbers[1 + m] = taken(take_[m]);
    judge_done(task_, numbers + 1, status);
  }

  enum class Take { x, y, distance, tilt, tilt_rate };
  static Take take_of(const scenario::Measure& measure) {
    const std::string_view name = measure.column->name;
    return name == "x"          ? Take::x
           : name == "y"        ? Take::y
           : name == "distance" ? Take::distance
           : name == "tilt"     ? Take::tilt
                                : Take::tilt_rate;
  }
  [[nodiscard]] double taken(Take what) {
    switch (what) {
      case Take::x:
        return last(x_);
      case Take::y:
        return last(y_);
      case Take::distance:
        return farthest();
      case Take::tilt:
        return solutions_->gimbal.tilt;
      case Take::tilt_rate:
        break;
    }
    return solutions_->gimbal.rate;
  }

  [[nodiscard]] double farthest() {
    const record::Superposition motion{solutions_->points, factors_.size(), x_.data(), y_.data()};
    double squared = kernels_.superpose(motion, factors_.data(), squares_.data());
    int exponent = 0;
    if (!record::is_square(squared)) {
      // Scales by a power of two, so that squares neither overflow nor vanish.
      double size = 0;
      for (std::size_t i = 0; i < motion.rows; ++i) {
        size = larger(size, larger(std::abs(at(x_, i)), std::abs(at(y_, i))));
      }
      if (size == 0 || !std::isfinite(size)) return size;
      std::frexp(size, &exponent);
      for (double& factor : factors_) factor = std::scalbn(factor, -exponent);
      squared = kernels_.superpose(motion, factors_.data(), squares_.data());
      for (double& factor : factors_) factor = std::scalbn(factor, exponent);
    }
    squared = search_.greatest_between(solutions_->stretches, squares_.data(),
                                       record::Spacing::close, squared);
    return std::scalbn(std::sqrt(squared), exponent);
  }

  [[nodiscard]] double last(const std::vector<const double*>& terms) const {
    return at(terms, solutions_->points - 1);
  }

  [[nodiscard]] double at(const std::vector<const double*>& terms, std::size_t row) const {
    double sum = 0;
    for (std::size_t k = 0; k < terms.size(); ++k) sum += factors_[k] * terms[k][row];
    return sum;
  }

  const SweepTask& task_;
  CaseScenario scenario_;
  std::shared_ptr<const Superposed> solutions_;
  const record::TrackKernels& kernels_;
  std::vector<Take> take_;            // for each measure
  std::vector<const double*> x_, y_;  // for each term
  std::vector<double> factors_;
  record::PaddedRows squares_;
  record::SpanSearch search_;
};

}  // namespace

std::unique_ptr<CaseRunner> superposition_runner(const SweepTask& task,
                                                 std::shared_ptr<const Superposed> solutions) {
  return std::make_unique<SuperpositionRunner>(task, std::move(solutions));
}

}  // namespace bbsim::sweep
