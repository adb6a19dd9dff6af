// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Sweeps of given motions and of continuous control loops, with a case in each SIMD lane.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>
#include <type_traits>
#include <variant>

#include "model/model.hpp"
#include "model/signals/signal_pair.hpp"
#include "record/rows.hpp"
#include "solve/ensemble/ensemble.hpp"
#include "sweep/runners.hpp"

namespace bbsim::sweep {
namespace {

namespace ensemble = solve::ensemble;
using ensemble::Actuation;
using Kind = scenario::Measure::Kind;

// Smaller sweeps of given motions are short anyway, and single runs match `bbsim run` bit for bit.
constexpr std::size_t least_given = 32;

// The size whose greatest value a usual measure needs; empty for values at the end and rms.
std::optional<ensemble::Size> size_of(const scenario::Measure& measure) {
  if (measure.kind != Kind::greatest) return {};
  const std::string_view name = measure.column->name;
  if (name == "tilt") return ensemble::versine;
  if (name == "tilt_rate") return ensemble::rate_squared;
  if (name == "distance") return ensemble::distance_squared;
  if (name == "tracking_error") return ensemble::error_squared;
  return {};
}

// Whether all are usual measures: any column at the end except gamma; the greatest tilt, tilt_rate
// and distance; the greatest and the rms of tracking_error. All must be of the whole run.
bool are_usual_measures(const std::vector<scenario::Measure>& measures) {
  return std::ranges::all_of(measures, [](const scenario::Measure& measure) {
    if (!measure.window.is_whole()) return false;
    if (measure.kind == Kind::end) return measure.column->needs != scenario::Needs::gamma;
    return size_of(measure) ||
           (measure.kind == Kind::rms && measure.column->name == "tracking_error");
  });
}

// The value of the column of this size.
double value_of(ensemble::Size size, double value) {
  if (size != ensemble::versine) return std::sqrt(value);
  return value < 1 ? 2 * std::asin(std::sqrt(value / 2))
                   : std::numbers::pi - 2 * std::asin(std::sqrt(std::max(0.0, 1 - value / 2)));
}

// Whether a sum of squares has lost nothing to overflow and underflow.
bool is_square(double squared) {
  return squared > 1e-280 && squared < 1e300;
}

// The reference of a loop of the paper's rig whose states are those of a lane; otherwise null.
const model::SignalPair* reference_of(const model::Model& model) {
  const model::SignalPair* reference = nullptr;
  std::visit(
      [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        using model::ClosedLoop, model::Shape;
        if constexpr (std::is_same_v<System, ClosedLoop<Shape::full, Drives::acceleration>> ||
                      std::is_same_v<System, ClosedLoop<Shape::full, Drives::angle>>) {
          reference = &system.reference();
        }
      },
      model.system);
  return reference;
}

Actuation actuation_of(const Scenario& scenario) {
  if (!scenario.controller) return Actuation::given;
  return scenario.controller->drives == Drives::angle ? Actuation::by_servo
                                                      : Actuation::by_acceleration;
}

// Converts a loop of the paper to the numbers of a lane.
void set_loop(ensemble::Case& loop, const Scenario& scenario, const model::Model& model) {
  const model::SignalView reference = reference_of(model)->view();
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < 2; ++j) {
      loop.kv[i][j] = scenario.controller->kv[i][j];
      loop.kp[i][j] = scenario.controller->kp[i][j];
    }
    loop.start[i] = reference.start[i];
    loop.rate[i] = reference.rate[i];
  }
  loop.harmonic_count = static_cast<int>(reference.harmonic_count);
  std::copy_n(reference.harmonics, reference.harmonic_count, loop.harmonics);
  if (scenario.gimbal.servo) {
    loop.omega_n = scenario.gimbal.servo->natural_frequency;
    loop.zeta = scenario.gimbal.servo->damping;
  }
  std::copy(model.initial.begin(), model.initial.end(), loop.initial);
}

// Adds a profile's terms to a case, except shared terms. Sinusoids of one frequency share a term,
// as in model::SignalPair, which takes longer to make.
struct CaseSignals {
  ensemble::Case& to;

  void add_constant(int component, double value) { to.start[component] += value; }
  void add_ramp(int component, double start, double rate) {
    to.start[component] += start;
    to.rate[component] += rate;
  }
  void add_sinusoid(int component, double amplitude, double frequency, double phase) {
    model::Harmonic* const end = to.harmonics + to.harmonic_count;
    model::Harmonic* const term = std::find_if(
        to.harmonics, end, [&](const model::Harmonic& h) { return h.frequency == frequency; });
    if (term == end) {
      term->frequency = frequency;
      ++to.harmonic_count;
    }
    term->sine[component] += amplitude * std::cos(phase);
    term->cosine[component] += amplitude * std::sin(phase);
  }
};

// A sinusoid of both angles takes all of its values in one period, and in half of one if the plate
// is level on average. No other motion repeats.
double repeats_after(const ensemble::Case& lane) {
  if (lane.rate[0] != 0 || lane.rate[1] != 0 || lane.harmonic_count != 1) {
    return std::numeric_limits<double>::infinity();
  }
  const bool level = lane.start[0] == 0 && lane.start[1] == 0;
  return (level ? 1 : 2) * std::numbers::pi / std::abs(lane.harmonics[0].frequency);
}

// Converts a given motion to the numbers of a lane.
void set_given(ensemble::Case& lane, const Scenario& scenario, bool has_shared_terms) {
  const Ball& ball = scenario.ball;
  const double initial[] = {ball.position[0], ball.position[1], ball.velocity[0], ball.velocity[1],
                            ball.radius * ball.spin};
  std::copy(std::begin(initial), std::end(initial), lane.initial);
  const Gimbal& gimbal = scenario.gimbal;
  CaseSignals signals{lane};
  const auto is_shared = [](const auto&) {};
  model::add_profile(gimbal.motion->phi, 0, signals, is_shared);
  model::add_profile(gimbal.motion->theta, 1, signals, is_shared);
  signals.add_constant(0, gimbal.mounting.phi_offset);
  signals.add_constant(1, gimbal.mounting.theta_offset);
  if (!has_shared_terms) lane.repeats_after = repeats_after(lane);
}

std::size_t sinusoids(const Profile& profile) {
  return static_cast<std::size_t>(std::count_if(
      profile.begin(), profile.end(),
      [](const ProfileTerm& term) { return std::holds_alternative<Sinusoid>(term); }));
}

model::Model model_of(const Scenario& scenario) {
  return model::assemble(scenario, false, model::Form::full);
}

// Number of cases in one call of the lanes. Some lanes are empty while the last cases finish; this
// costs little among so many cases.
constexpr std::size_t in_turn = 1024;

// Whether lanes have the column without a model.
bool is_place(const scenario::Column* column) {
  return column->name == "x" || column->name == "y";
}

class EnsembleRunner : public LaneRunner, private ensemble::Study {
 public:
  EnsembleRunner(const SweepTask& task, const Scenario& first)
      : scenario_(task),
        series_(task.series),
        timed_(timed_rows(task, first)),
        grid_(timed_ ? timed_->grid : solve::OutputGrid(first.time)),
        given_(actuation_of(first) == Actuation::given),
        motion_(given_ ? model::given_motion(first) : model::SignalPair()),
        lanes_({actuation_of(first), grid_, !given_ || !series_.empty(),
                given_ ? model_of(first).stops : std::vector<double>(), motion_.view().shared},
               ensemble::choose_nodes(actuation_of(first), first.solver.rtol,
                                      motion_.highest_frequency() * first.time.end),
               {first.solver.rtol, first.solver.atol}),
        end_(scenario::end_columns(task.measures)),
        ends_at_places_(std::ranges::all_of(end_.columns(), is_place)),
        needs_model_(!given_ || !ends_at_places_) {
    for (const scenario::Measure& measure : task.measures) {
      wanted_.push_back({measure.kind == Kind::end, measure.column->name == "y", size_of(measure)});
    }
  }

  void run(std::span<GroupCase> cases, const std::atomic<bool>& stop) override {
    cases_ = cases;
    begun_ = 0;
    models_.clear();
    if (needs_model_) models_.resize(cases.size());
    lanes_.carry(*this, stop);
  }

 private:
  struct Scene {
    model::Model model;
    model::BallConstants constants;
  };

  std::optional<std::size_t> begin(ensemble::Case& lane) override {
    if (begun_ == cases_.size()) return {};
    const GroupCase& from = cases_[begun_];
    const Scenario& scenario = scenario_.at(from.number, from.values);
    lane = {};
    lane.radius = scenario.ball.radius;
    lane.gravity = scenario.gravity;
    if (needs_model_)
      models_[begun_].emplace(Scene{model_of(scenario), model::constants_of(scenario)});
    if (given_) {
      set_given(lane, scenario, motion_.view().shared.any());
    } else {
      set_loop(lane, scenario, models_[begun_]->model);
    }
    return begun_++;
  }

  void end(std::size_t number, const ensemble::Result& run) override {
    using ensemble::Ending;
    GroupCase& group_case = cases_[number];
    const bool unbounded = run.ending == Ending::unbounded;
    // The last row before infinity has only x and y, and not even these under a given motion.
    if (run.ending != Ending::given_up && (!unbounded || (ends_at_places_ && !given_)) &&
        take(number, run)) {
      if (!series_.empty()) {
        std::vector<const double*> columns;
        for (const scenario::Column* const column : series_) {
          columns.push_back(column->name == "x" ? run.x : run.y);
        }
        SeriesWriter(*group_case.series, group_case.place, timed_ ? &*timed_ : nullptr)
            .append(columns, run.rows);
      }
      group_case.is_done = true;
      if (unbounded) group_case.unbounded_at = run.reached;
    }
    if (needs_model_) models_[number].reset();
  }

  // Writes the measures. Returns false if a square overflows or vanishes.
  bool take(std::size_t number, const ensemble::Result& run) {
    const bool unbounded = run.ending == ensemble::Ending::unbounded;
    const double places[] = {unbounded ? run.x[run.rows - 1] : run.state[0],
                             unbounded ? run.y[run.rows - 1] : run.state[1]};
    if (!ends_at_places_) {
      const double t = grid_.end();
      end_.begin(models_[number]->model, models_[number]->constants);
      end_.evaluate(&t, run.state, 1);
    }
    std::size_t at_end = 0;
    for (std::size_t m = 0; m < wanted_.size(); ++m) {
      const auto& [is_end, is_y, size] = wanted_[m];
      double& result = cases_[number].measures[m];
      if (is_end) {
        result = ends_at_places_ ? places[is_y ? 1 : 0] : end_[at_end++][0];
        continue;
      }
      const double square = size ? run.greatest[*size] : lanes_.squared_errors(run);
      const bool of_plate = size == ensemble::versine || size == ensemble::rate_squared;
      if (!of_plate && !is_square(square)) return false;
      result = size ? value_of(*size, square) : std::sqrt(square / static_cast<double>(run.rows));
    }
    return true;
  }

  CaseScenario scenario_;
  const std::vector<const scenario::Column*>& series_;  // x and y
  std::optional<TimedRows> timed_;
  solve::OutputGrid grid_;
  bool given_;                // whether the gimbal's motion is given
  model::SignalPair motion_;  // its tables are those of all cases
  ensemble::Ensemble lanes_;
  struct Wanted {
    bool is_end, is_y;
    std::optional<ensemble::Size> size;
  };
  std::vector<Wanted> wanted_;  // for each measure
  record::Rows end_;            // columns at the end
  bool ends_at_places_;         // they are x and y only
  bool needs_model_;
  std::span<GroupCase> cases_;
  std::size_t begun_ = 0;
  std::vector<std::optional<Scene>> models_;  // of cases that are in a lane
};

// Conditions for any source of the gimbal's motion. All cases give the same answer.
bool meets_common_conditions(const SweepTask& task) {
  return can_share_rows(task) && are_usual_measures(task.measures) && task.plan.independent() &&
         std::ranges::all_of(task.series, is_place);
}
bool is_by_collocation(const Scenario& scenario) {
  return !scenario.solver.error && choose_method(scenario.solver.method) == Method::radau;
}

}  // namespace

bool can_use_open_lanes(const SweepTask& task) {
  if (task.plan.cases() < least_given || !meets_common_conditions(task)) return false;
  // Planar cases are run like the others.
  const Scenario scenario = task.family.read(task.plan.first_settings());
  if (!scenario.gimbal.motion || !is_by_collocation(scenario)) return false;
  const model::Model model = model_of(scenario);
  return sinusoids(scenario.gimbal.motion->phi) + sinusoids(scenario.gimbal.motion->theta) <=
             ensemble::most_harmonics &&
         model::given_motion(scenario).view().shared.highest_frequency == 0 &&  // no formulas
         !model.hybrid() &&
         std::holds_alternative<model::OpenLoop<model::Shape::full>>(model.system);
}

bool can_use_lanes(const SweepTask& task) {
  if (!meets_common_conditions(task)) return false;
  // Among others, planar cases are run with all states. A sweep of only planar cases has fewer
  // states and is run singly.
  const Scenario scenario = task.family.read(task.plan.general_settings());
  if (!scenario.controller || !is_by_collocation(scenario)) return false;
  const model::Model model = model::assemble(scenario, false);
  const model::SignalPair* const reference = reference_of(model);
  return reference != nullptr && !model.hybrid() && !reference->view().shared.any() &&
         reference->view().harmonic_count <= ensemble::most_harmonics;
}

std::size_t lane_group() {
  return ensemble::group;
}

std::unique_ptr<CaseRunner> lane_runner(const SweepTask& task) {
  const Scenario first = task.family.read(task.plan.first_settings());
  return group_runner(task, first, in_turn, std::make_unique<EnsembleRunner>(task, first));
}

}  // namespace bbsim::sweep
