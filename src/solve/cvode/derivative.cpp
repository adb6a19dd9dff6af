// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/cvode/derivative.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solve/cvode/sundials.hpp"

namespace bbsim::solve {

using sundials::check;

namespace {

// CVODE's default limit is 500 steps between output times, too few for a fast servo.
constexpr long most_steps = 1'000'000;

int call(sunrealtype t, N_Vector z, N_Vector dz, void* user_data) {
  const auto& derivative = *static_cast<const Derivative*>(user_data);
  double* const rate = N_VGetArrayPointer(dz);
  derivative(t, N_VGetArrayPointer(z), rate);
  const bool finite =
      std::all_of(rate, rate + N_VGetLength(dz), [](double value) { return std::isfinite(value); });
  return finite ? 0 : 1;  // 1: try a smaller step
}

}  // namespace

Trajectory integrate_by_bdf(Derivative derivative, const model::Model& model, Tolerances tolerances,
                            const OutputGrid& grid, const Watch& watch) {
  const std::vector<double>& initial = model.initial;
  const std::vector<double>& stops = model.stops;
  const std::size_t n = initial.size();
  Trajectory rows(n);
  const auto context = sundials::make_context();
  const auto state = sundials::make_vector(n, context.get());
  const auto matrix = sundials::DenseMatrix(sundials::created(
      SUNDenseMatrix(static_cast<sunindextype>(n), static_cast<sunindextype>(n), context.get())));
  const auto linear = sundials::LinearSolver(
      sundials::created(SUNLinSol_Dense(state.get(), matrix.get(), context.get())));
  const auto cvode = sundials::CvodeMemory(sundials::created(CVodeCreate(CV_BDF, context.get())));
  std::copy(initial.begin(), initial.end(), sundials::data(state));
  sundials::silence(cvode.get());
  check(CVodeInit(cvode.get(), call, 0.0, state.get()), "CVodeInit");
  check(CVodeSStolerances(cvode.get(), tolerances.rtol, tolerances.atol), "CVodeSStolerances");
  check(CVodeSetUserData(cvode.get(), &derivative), "CVodeSetUserData");
  check(CVodeSetLinearSolver(cvode.get(), linear.get(), matrix.get()), "CVodeSetLinearSolver");
  check(CVodeSetMaxNumSteps(cvode.get(), most_steps), "CVodeSetMaxNumSteps");

  rows.accept(0, 1, sundials::data(state));
  std::size_t stop = 0;
  double before = 0;           // the stop, or just before it if the input jumps there
  const auto set_stop = [&] {  // CVODE never steps over it
    const double time = stop < stops.size() ? stops[stop] : grid.end();
    before = model.jumps_at(time) ? model.just_before(time) : time;
    check(CVodeSetStopTime(cvode.get(), before), "CVodeSetStopTime");
  };
  set_stop();
  for (std::size_t i = 1; i < grid.size(); ++i) {
    for (double t = 0; t < grid[i];) {
      const bool jumps = stop < stops.size() && before <= grid[i];
      const int flag = CVode(cvode.get(), jumps ? before : grid[i], state.get(), &t, CV_NORMAL);
      if (flag < 0) return rows;
      if (watch.stop != nullptr && watch.stop->load(std::memory_order_relaxed)) return rows;
      if (jumps) {  // restart the method, because the input or a derivative jumps
        t = stops[stop];
        check(CVodeReInit(cvode.get(), t, state.get()), "CVodeReInit");
        ++stop;
        set_stop();
      }
    }
    rows.accept(i, 1, sundials::data(state));
  }
  return rows;
}

}  // namespace bbsim::solve
