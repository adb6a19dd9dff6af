#include "study/simpler.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <variant>

#include "base/error.hpp"
#include "model/model.hpp"
#include "model/simpler.hpp"
#include "solve/integrate.hpp"
#include "solve/output_grid.hpp"
#include "solve/sundials.hpp"

namespace bbsim::study {
namespace {

using solve::Trajectory;
namespace sundials = solve::sundials;
using sundials::check;

constexpr solve::Tolerances tolerances{1e-9, 1e-11};
// CVODE's own limit is 500 steps between output times, too few for a fast servo.
constexpr long most_steps = 1'000'000;

// z' = f(t, z), its type forgotten: one integrator for every simpler model.
using Derivative = std::function<void(double t, const double* z, double* dz)>;

template <class Equation>
Derivative simpler_derivative(const model::Model& model) {
  return std::visit(
      [](const auto& system) -> Derivative {
        if constexpr (requires { system.template with_equation<Equation>(); }) {
          return [simpler = system.template with_equation<Equation>()](
                     double t, const double* z, double* dz) { simpler.derivative(t, z, dz); };
        } else {
          throw InputError("verify: simpler models are compared over scenes without switches");
        }
      },
      model.system);
}

int call(sunrealtype t, N_Vector z, N_Vector dz, void* user_data) {
  const auto& derivative = *static_cast<const Derivative*>(user_data);
  double* const rate = N_VGetArrayPointer(dz);
  derivative(t, N_VGetArrayPointer(z), rate);
  const bool finite =
      std::all_of(rate, rate + N_VGetLength(dz), [](double value) { return std::isfinite(value); });
  return finite ? 0 : 1;  // 1: try a smaller step
}

// Rows at the output times, by BDF with CVODE's difference quotients for the Jacobian; as many as
// the solution reaches.
Trajectory integrate_simpler(Derivative derivative, const model::Model& model,
                             const solve::OutputGrid& grid, const solve::Watch& watch) {
  const std::size_t n = model.size();
  Trajectory rows(n);
  const auto context = sundials::make_context();
  const auto state = sundials::make_vector(n, context.get());
  const auto matrix = sundials::DenseMatrix(sundials::created(
      SUNDenseMatrix(static_cast<sunindextype>(n), static_cast<sunindextype>(n), context.get())));
  const auto linear = sundials::LinearSolver(
      sundials::created(SUNLinSol_Dense(state.get(), matrix.get(), context.get())));
  const auto cvode = sundials::CvodeMemory(sundials::created(CVodeCreate(CV_BDF, context.get())));
  std::copy(model.initial.begin(), model.initial.end(), sundials::data(state));
  sundials::silence(cvode.get());
  check(CVodeInit(cvode.get(), call, 0.0, state.get()), "CVodeInit");
  check(CVodeSStolerances(cvode.get(), tolerances.rtol, tolerances.atol), "CVodeSStolerances");
  check(CVodeSetUserData(cvode.get(), &derivative), "CVodeSetUserData");
  check(CVodeSetLinearSolver(cvode.get(), linear.get(), matrix.get()), "CVodeSetLinearSolver");
  check(CVodeSetMaxNumSteps(cvode.get(), most_steps), "CVodeSetMaxNumSteps");

  rows.accept(0, 1, sundials::data(state));
  std::size_t stop = 0;
  const auto set_stop = [&] {  // never stepped over
    const double time = stop < model.stops.size() ? model.stops[stop] : grid.end();
    check(CVodeSetStopTime(cvode.get(), time), "CVodeSetStopTime");
  };
  set_stop();
  for (std::size_t i = 1; i < grid.size(); ++i) {
    for (double t = 0; t < grid[i];) {
      const bool stops = stop < model.stops.size() && model.stops[stop] <= grid[i];
      const double target = stops ? model.stops[stop] : grid[i];
      const int flag = CVode(cvode.get(), target, state.get(), &t, CV_NORMAL);
      if (flag < 0) return rows;
      if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) return rows;
      if (stops) {  // where derivatives jump, the method starts again
        check(CVodeReInit(cvode.get(), t, state.get()), "CVodeReInit");
        ++stop;
        set_stop();
      }
    }
    rows.accept(i, 1, sundials::data(state));
  }
  return rows;
}

struct Position {
  double x, y;
};

Position position(const model::Model& model, double t, const double* row) {
  const model::BallMotion ball = model.sample(t, row).ball;
  return {ball.x, ball.y};
}

SimplerModel compare(std::string name, std::string equation, const Trajectory& full,
                     const Trajectory& simpler, const model::Model& model,
                     const solve::OutputGrid& grid) {
  SimplerModel result{std::move(name), std::move(equation)};
  const std::size_t rows = std::min(full.rows(), simpler.rows());
  for (std::size_t i = 0; i < rows; ++i) {
    const Position a = position(model, grid[i], full.row(i));
    const Position b = position(model, grid[i], simpler.row(i));
    const double dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y);
    if (dx > result.dx) std::tie(result.dx, result.at_dx) = std::pair(dx, grid[i]);
    if (dy > result.dy) std::tie(result.dy, result.at_dy) = std::pair(dy, grid[i]);
    result.reached = grid[i];
  }
  return result;
}

}  // namespace

FullModelStudy compare_simpler(const Scenario& scenario, const solve::Watch& watch) {
  const model::Model model = model::assemble(scenario, false);
  if (model.hybrid() || model.rig || !model::is_the_papers(scenario)) {
    throw InputError(scenario.source.file +
                     ": simpler models are compared over scenes of the paper's gimbal and ball, of "
                     "prescribed motion or under pd, without events and limits; run `bbsim verify` "
                     "without a scenario");
  }
  const solve::OutputGrid grid(scenario.time);
  Trajectory full(model.size());
  const solve::Outcome outcome =
      solve::integrate(model, Method::automatic, tolerances, grid, full, watch);
  FullModelStudy study;
  study.reached = outcome.reached;
  const auto add = [&](std::string name, std::string equation, Derivative derivative) {
    const Trajectory rows = integrate_simpler(std::move(derivative), model, grid, watch);
    study.simpler.push_back(compare(std::move(name), std::move(equation), full, rows, model, grid));
  };
  add("slope only", "x'' = (5/7) g sin phi, y'' = -(5/7) g cos phi sin theta",
      simpler_derivative<model::SlopeOnly>(model));
  add("ball and plate",
      "x'' = (5/7)(g sin phi + x phi'^2 + y phi' theta'), "
      "y'' = (5/7)(-g sin theta + y theta'^2 + x phi' theta')",
      simpler_derivative<model::BallAndPlate>(model));
  study.interrupted = watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed);
  return study;
}

}  // namespace bbsim::study
