#include "study/sweep/superposition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>

#include "solve/choose.hpp"
#include "solve/collocation/radau.hpp"
#include "study/sweep/case_scenario.hpp"
#include "study/sweep/track_meter.hpp"
#include "study/sweep/verdict.hpp"

namespace bbsim::study {
namespace {

using Kind = record::Measure::Kind;

// A few roundings: these solutions are made once.
constexpr solve::Tolerances finest{1e-13, 1e-15};

// What z' = A(t) z + g b_g(t) + r b_r(t) is linear in.
struct Part {
  std::array<std::string_view, 2> keys;  // that it depends on; u = r gamma' on two
  double (*factor)(const Scenario& scenario);
};
constexpr Part parts[] = {
    {{"ball.position.0", ""}, [](const Scenario& s) { return s.ball.position[0]; }},
    {{"ball.position.1", ""}, [](const Scenario& s) { return s.ball.position[1]; }},
    {{"ball.velocity.0", ""}, [](const Scenario& s) { return s.ball.velocity[0]; }},
    {{"ball.velocity.1", ""}, [](const Scenario& s) { return s.ball.velocity[1]; }},
    {{"ball.spin", "ball.radius"}, [](const Scenario& s) { return s.ball.radius * s.ball.spin; }},
    {{"ball.radius", ""}, [](const Scenario& s) { return s.ball.radius; }},
    {{"gravity", ""}, [](const Scenario& s) { return s.gravity; }},
};
constexpr std::size_t part_count = std::size(parts), states = 5;

bool depends_on(const Part& part, const std::string& key) {
  return key == part.keys[0] || key == part.keys[1];
}

bool is_superposed(const record::Measure& measure) {
  const std::string_view name = measure.column->name;
  if (measure.kind == Kind::end) return name == "x" || name == "y";
  return measure.kind == Kind::greatest &&
         (name == "distance" || name == "tilt" || name == "tilt_rate");
}

// Keeps x and y of a run.
class Positions : public solve::StateSink {
 public:
  Positions(std::size_t rows, std::size_t row_size, PaddedRows& x, PaddedRows& y)
      : row_size_(row_size), x_(x), y_(y) {
    x_.resize(rows);
    y_.resize(rows);
  }
  void accept(std::size_t first, std::size_t count, const double* values) override {
    for (std::size_t i = 0; i < count; ++i) {
      x_.data()[first + i] = values[i * row_size_];
      y_.data()[first + i] = values[i * row_size_ + 1];
    }
  }

 private:
  std::size_t row_size_;
  PaddedRows &x_, &y_;
};

}  // namespace

// Of each term x and y at all output times, for a factor of 1.
struct Superposed {
  struct Term {
    const Part* part;  // null: what does not vary
    PaddedRows x, y;
  };
  std::vector<Term> terms;
  std::size_t rows = 0;
  double end = 0, max_tilt = 0, max_tilt_rate = 0;
};

bool can_superpose(const SweepTask& task) {
  if (!task.series.empty()) return false;
  if (!std::all_of(task.measures.begin(), task.measures.end(), is_superposed)) return false;
  for (const Axis& axis : task.plan.axes()) {
    const auto linear = [&](const Part& part) { return depends_on(part, axis.key); };
    if (!axis.independent || std::none_of(std::begin(parts), std::end(parts), linear)) return false;
  }
  const Scenario scenario = task.family.read(task.plan.settings(0));
  if (!scenario.gimbal.motion || scenario.solver.error ||
      solve::choose_method(scenario.solver.method) != Method::radau) {
    return false;
  }
  // A small sweep would spend more on the solutions than on its cases.
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
        if constexpr (std::decay_t<decltype(system)>::linear) motion = system.motion();
      },
      model.system);

  // The factors of all parts, of which those that vary are terms of their own.
  std::array<double, part_count> fixed{};
  auto solutions = std::make_shared<Superposed>();
  solutions->terms.push_back({nullptr, {}, {}});
  for (std::size_t p = 0; p < part_count; ++p) {
    const auto& axes = task.plan.axes();
    if (std::any_of(axes.begin(), axes.end(),
                    [&](const Axis& axis) { return depends_on(parts[p], axis.key); })) {
      solutions->terms.push_back({&parts[p], {}, {}});
    } else {
      fixed[p] = parts[p].factor(scenario);
    }
  }

  solutions->rows = grid.size();
  solutions->end = grid.end();
  TrackMeter gimbal({*record::find_measure("max_tilt"), *record::find_measure("max_tilt_rate")});
  const model::BallConstants constants = model::constants_of(scenario);
  for (Superposed::Term& term : solutions->terms) {
    std::array<double, part_count> factors = fixed;
    if (term.part != nullptr) {
      factors = {};
      factors[static_cast<std::size_t>(term.part - parts)] = 1;
    }
    model.system = model::OpenLoop<model::Shape::full>(factors[5], factors[6], motion);
    model.initial.assign(factors.begin(), factors.begin() + states);
    solve::collocation::RadauStepper stepper(model, solve::collocation::choose_kernels(),
                                             solve::collocation::choose_stages(finest.rtol), finest,
                                             grid.end());
    Positions positions(grid.size(), model.row_size(), term.x, term.y);
    const solve::Outcome outcome = solve::run_through(stepper, model, grid, positions, {});
    if (outcome.ending != solve::Ending::done) return nullptr;
    term.x.pad(grid.size());
    term.y.pad(grid.size());
  }
  // The tilt is that of the motion, whatever the ball does.
  std::vector<double> still(model.row_size() * grid.size(), 0.0);
  std::array<double, 2> tilt{};
  gimbal.begin(model, constants, grid, false);
  gimbal.accept(0, grid.size(), still.data());
  gimbal.finish(tilt.data());
  solutions->max_tilt = tilt[0];
  solutions->max_tilt_rate = tilt[1];
  return solutions;
}

namespace {

class SuperpositionRunner : public CaseRunner {
 public:
  SuperpositionRunner(const SweepTask& task, std::shared_ptr<const Superposed> solutions)
      : task_(task),
        scenario_(task),
        solutions_(std::move(solutions)),
        kernels_(choose_sweep_kernels()),
        factors_(solutions_->terms.size()) {
    for (const Superposed::Term& term : solutions_->terms) {
      x_.push_back(term.x.data());
      y_.push_back(term.y.data());
    }
    for (const record::Measure& measure : task.measures) {
      far_ = far_ || measure.column->name == "distance";
    }
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
    const Superposition motion{solutions_->rows, factors_.size(), x_.data(), y_.data()};
    const double distance = far_ ? farthest(motion) : 0;
    status = {};
    numbers[0] = solutions_->end;
    for (std::size_t m = 0; m < task_.measures.size(); ++m) {
      const record::Measure& measure = task_.measures[m];
      const std::string_view name = measure.column->name;
      numbers[1 + m] = name == "distance"    ? distance
                       : name == "tilt"      ? solutions_->max_tilt
                       : name == "tilt_rate" ? solutions_->max_tilt_rate
                                             : last(name == "x" ? x_ : y_);
    }
    judge(task_, scenario, numbers + 1, status);
  }

  [[nodiscard]] double farthest(const Superposition& motion) const {
    const double squared = kernels_.farthest(motion, factors_.data());
    if (is_square(squared)) return std::sqrt(squared);
    double greatest = 0;  // one by one, without an overflow on the way
    for (std::size_t i = 0; i < motion.rows; ++i) {
      greatest = std::max(greatest, std::hypot(at(x_, i), at(y_, i)));
    }
    return greatest;
  }

  [[nodiscard]] double last(const std::vector<const double*>& terms) const {
    return at(terms, solutions_->rows - 1);
  }

  [[nodiscard]] double at(const std::vector<const double*>& terms, std::size_t row) const {
    double sum = 0;
    for (std::size_t k = 0; k < terms.size(); ++k) sum += factors_[k] * terms[k][row];
    return sum;
  }

  const SweepTask& task_;
  CaseScenario scenario_;
  std::shared_ptr<const Superposed> solutions_;
  const SweepKernels& kernels_;
  std::vector<const double*> x_, y_;  // of each term
  std::vector<double> factors_;
  bool far_ = false;
};

}  // namespace

std::unique_ptr<CaseRunner> superposition_runner(const SweepTask& task,
                                                 std::shared_ptr<const Superposed> solutions) {
  return std::make_unique<SuperpositionRunner>(task, std::move(solutions));
}

}  // namespace bbsim::study
