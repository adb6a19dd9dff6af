// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/cvode/cvode.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>

#include "model/systems/list.hpp"
#include "solve/cvode/sundials.hpp"

namespace bbsim::solve {
namespace {

using sundials::check;
using sundials::data;

// CVODE's code for "try again with a smaller step".
constexpr int recoverable = 1;

// A type-erased system for CVODE's callbacks.
struct Equations {
  const model::System& any;
  const void* system;  // the system within `any`
  std::size_t size;
  bool coupled;
  CVRhsFn derivative;
  CVQuadRhsFn quadrature;
};

const Equations& equations_in(const void* user_data) {
  return *static_cast<const Equations*>(user_data);
}

// The C callbacks. The right-hand side neither allocates nor throws.
template <class System>
int derivative(sunrealtype t, N_Vector z, N_Vector dz, void* user_data) {
  const auto& system = *static_cast<const System*>(equations_in(user_data).system);
  double* rate = N_VGetArrayPointer(dz);
  model::derivative(system, t, N_VGetArrayPointer(z), rate);
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::all_of(rate, rate + System::size, finite) ? 0 : recoverable;
}

template <class System>
int quadrature(sunrealtype, N_Vector z, N_Vector rate, void*) {
  N_VGetArrayPointer(rate)[0] = N_VGetArrayPointer(z)[std::max(0, model::spin_index<System>)];
  return 0;
}

int jacobian(sunrealtype t, N_Vector z, N_Vector, SUNMatrix matrix, void* user_data, N_Vector,
             N_Vector, N_Vector) {
  const Equations& equations = equations_in(user_data);
  double* const target = SUNDenseMatrix_Data(matrix);
  model::jacobian(equations.any, t, N_VGetArrayPointer(z), target);
  const auto finite = [](double value) { return std::isfinite(value); };
  return std::all_of(target, target + equations.size * equations.size, finite) ? 0 : recoverable;
}

Equations equations_of(const model::Model& model) {
  return std::visit(
      [&](const auto& system) -> Equations {
        using System = std::decay_t<decltype(system)>;
        return {model.system,       &system,           System::size, model::is_coupled<System>,
                derivative<System>, quadrature<System>};
      },
      model.system);
}

Failure explain(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_ACC:
      return {Why::error_out_of_reach, "the tolerance is finer than double precision allows"};
    case CV_ERR_FAILURE:
      return {Why::singular, "the error test failed repeatedly at the smallest step"};
    case CV_CONV_FAILURE:
      return {Why::singular, "the nonlinear iteration did not converge at the smallest step"};
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
      return {Why::not_finite, "the accelerations are no longer finite"};
    case CV_LSETUP_FAIL:
    case CV_LSOLVE_FAIL:
      return {Why::singular, "the linear system is singular"};
    case CV_TOO_CLOSE:
      return {Why::singular, "the remaining time is shorter than its rounding"};
    default:
      return {Why::singular, "CVODE gave up"};
  }
}

class CvodeStepper : public Stepper {
 public:
  CvodeStepper(const model::Model& model, Method method, Tolerances tolerances)
      : model_(model),
        equations_(equations_of(model)),
        method_(method),
        context_(sundials::make_context()),
        state_(sundials::make_vector(equations_.size, context_.get())),
        at_output_(sundials::make_vector(equations_.size, context_.get())),
        cvode_(sundials::created(
            CVodeCreate(method == Method::bdf ? CV_BDF : CV_ADAMS, context_.get()))) {
    std::copy(model.initial.begin(), model.initial.end(), data(state_));
    sundials::silence(memory());
    check(CVodeInit(memory(), equations_.derivative, 0.0, state_.get()), "CVodeInit");
    check(CVodeSStolerances(memory(), tolerances.rtol, tolerances.atol), "CVodeSStolerances");
    // The callbacks only read it.
    check(CVodeSetUserData(memory(), &equations_), "CVodeSetUserData");
    if (method == Method::bdf) {
      use_newton();
    } else {
      use_fixed_point();
    }
    // Near rest the step shrinks more often than CVODE's default of seven failures allows.
    if (model.dry) check(CVodeSetMaxErrTestFails(memory(), 40), "CVodeSetMaxErrTestFails");
    if (model.gamma) integrate_spin();
  }

  void start(double t, const double* z) override {
    std::copy(z, z + equations_.size, data(state_));
    if (stepped_) {
      restart(t);
    } else if (t != 0 || !std::equal(z, z + equations_.size, model_.initial.begin())) {
      check(CVodeReInit(memory(), t, state_.get()), "CVodeReInit");
    }
    time_ = t;
  }

  // An input derivative jumps at a stop, so the method's history is useless there.
  void jump() override { restart(time_); }

  [[nodiscard]] std::optional<Failure> step(double limit) override {
    const double before = time_;
    // The last step before a jump of the input must not see the input after it.
    double to = model_.jumps_at(limit) ? model_.just_before(limit) : limit;
    if (to <= before) to = limit;
    check(CVodeSetStopTime(memory(), to), "CVodeSetStopTime");
    const int flag = CVode(memory(), to, state_.get(), &time_, CV_ONE_STEP);
    stepped_ = true;
    if (flag < 0) return explain(flag);
    if (time_ >= to) time_ = limit;
    if (step_is_rounding(time_ - before)) return step_is_lost;
    return {};
  }

  void evaluate(const double* times, std::size_t count, double* rows) override {
    const std::size_t row_size = equations_.size + (model_.gamma ? 1 : 0);
    for (std::size_t i = 0; i < count; ++i, rows += row_size) {
      check(CVodeGetDky(memory(), times[i], 0, at_output_.get()), "CVodeGetDky");
      std::copy_n(data(at_output_), equations_.size, rows);
      if (!model_.gamma) continue;
      check(CVodeGetQuadDky(memory(), times[i], 0, turned_.get()), "CVodeGetQuadDky");
      rows[equations_.size] = data(turned_)[0];
    }
  }

  [[nodiscard]] double time() const override { return time_; }

  [[nodiscard]] std::vector<double> state() const override {
    return {data(state_), data(state_) + equations_.size};
  }

  [[nodiscard]] Statistics statistics() const override {
    Statistics all = statistics_;
    add_statistics(all);
    return all;
  }

  [[nodiscard]] std::size_t detail() const override { return 3; }
  // Orders are up to 5 (Adams 12), and steps are short compared with the motion.
  [[nodiscard]] std::size_t parts() const override { return 5; }

  // The state with the largest local error estimate in CVODE's weights.
  [[nodiscard]] std::size_t worst_state() const override {
    const auto errors = sundials::make_vector(equations_.size, context_.get());
    const auto weights = sundials::make_vector(equations_.size, context_.get());
    if (CVodeGetEstLocalErrors(memory(), errors.get()) < 0) return 0;
    if (CVodeGetErrWeights(memory(), weights.get()) < 0) return 0;
    std::size_t worst = 0;
    double largest = -1;
    for (std::size_t i = 0; i < equations_.size; ++i) {
      const double weighted = std::abs(data(errors)[i] * data(weights)[i]);
      if (weighted > largest) {
        largest = weighted;
        worst = i;
      }
    }
    return worst;
  }

 private:
  [[nodiscard]] void* memory() const { return cvode_.get(); }

  void use_newton() {
    const auto n = static_cast<sunindextype>(equations_.size);
    matrix_ = sundials::DenseMatrix(sundials::created(SUNDenseMatrix(n, n, context_.get())));
    linear_ = sundials::LinearSolver(
        sundials::created(SUNLinSol_Dense(state_.get(), matrix_.get(), context_.get())));
    check(CVodeSetLinearSolver(memory(), linear_.get(), matrix_.get()), "CVodeSetLinearSolver");
    check(CVodeSetJacFn(memory(), jacobian), "CVodeSetJacFn");
    if (equations_.coupled) {
      // The direction of friction turns faster as the velocity gets smaller. Near rest an old
      // Jacobian is wrong by far, and CVODE mistakes small corrections for convergence.
      check(CVodeSetJacEvalFrequency(memory(), 1), "CVodeSetJacEvalFrequency");
      check(CVodeSetLSetupFrequency(memory(), 1), "CVodeSetLSetupFrequency");
    }
  }

  void use_fixed_point() {
    nonlinear_ = sundials::NonlinearSolver(
        sundials::created(SUNNonlinSol_FixedPoint(state_.get(), 0, context_.get())));
    check(CVodeSetNonlinearSolver(memory(), nonlinear_.get()), "CVodeSetNonlinearSolver");
  }

  void integrate_spin() {
    turned_ = sundials::make_vector(1, context_.get());
    data(turned_)[0] = 0;
    check(CVodeQuadInit(memory(), equations_.quadrature, turned_.get()), "CVodeQuadInit");
    // No separate error control: the integrated state already has it. With it, CVODES 6 takes
    // 45,000 steps instead of 600 for a stiff servo.
    check(CVodeSetQuadErrCon(memory(), 0), "CVodeSetQuadErrCon");
  }

  void restart(double t) {
    add_statistics(statistics_);
    if (model_.gamma) {
      // t lies within the last step.
      check(CVodeGetQuadDky(memory(), t, 0, turned_.get()), "CVodeGetQuadDky");
    }
    check(CVodeReInit(memory(), t, state_.get()), "CVodeReInit");
    if (model_.gamma) check(CVodeQuadReInit(memory(), turned_.get()), "CVodeQuadReInit");
    tiny_steps_ = 0;
    stepped_ = false;
  }

  // A solution that reaches infinity in finite time shrinks the step to nothing. A few tiny steps
  // are normal; a hundred in a row are not.
  [[nodiscard]] bool step_is_rounding(double last) {
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(time_);
    tiny_steps_ = std::abs(last) <= rounding ? tiny_steps_ + 1 : 0;
    return tiny_steps_ >= 100;
  }

  // Adds the counts since the last restart, which CVODES keeps.
  void add_statistics(Statistics& sum) const {
    long steps = 0, rhs = 0, jacobians = 0, iterations = 0, failures = 0;
    check(CVodeGetNumSteps(memory(), &steps), "CVodeGetNumSteps");
    check(CVodeGetNumRhsEvals(memory(), &rhs), "CVodeGetNumRhsEvals");
    check(CVodeGetNumNonlinSolvIters(memory(), &iterations), "CVodeGetNumNonlinSolvIters");
    check(CVodeGetNumErrTestFails(memory(), &failures), "CVodeGetNumErrTestFails");
    if (method_ == Method::bdf) {
      check(CVodeGetNumJacEvals(memory(), &jacobians), "CVodeGetNumJacEvals");
    }
    const auto add = [](std::size_t& total, long part) { total += static_cast<std::size_t>(part); };
    add(sum.steps, steps);
    add(sum.rhs_evaluations, rhs);
    add(sum.jacobian_evaluations, jacobians);
    add(sum.nonlinear_iterations, iterations);
    add(sum.error_test_failures, failures);
  }

  const model::Model& model_;
  Equations equations_;
  Method method_;
  sundials::Context context_;  // outlives everything made with it
  sundials::Vector state_, at_output_, turned_;
  sundials::DenseMatrix matrix_;
  sundials::LinearSolver linear_;
  sundials::NonlinearSolver nonlinear_;
  sundials::CvodeMemory cvode_;
  double time_ = 0;
  bool stepped_ = false;  // since construction or restart
  int tiny_steps_ = 0;
  Statistics statistics_;  // until the last restart
};

}  // namespace

std::unique_ptr<Stepper> make_cvode_stepper(const model::Model& model, Method method,
                                            Tolerances tolerances) {
  return std::make_unique<CvodeStepper>(model, method, tolerances);
}

}  // namespace bbsim::solve
