#include "solve/cvode.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>
#include <variant>

#include "model/jacobian.hpp"
#include "solve/row_block.hpp"
#include "solve/sundials.hpp"

namespace bbsim::solve {
namespace {

using sundials::check;
using sundials::data;

// CVODE's answer to "try again with a smaller step".
constexpr int recoverable = 1;

// The C callbacks. The right-hand side neither allocates nor throws.
template <class System>
struct Callbacks {
  static int derivative(sunrealtype t, N_Vector z, N_Vector dz, void* user_data) {
    const auto& system = *static_cast<const System*>(user_data);
    double* rate = N_VGetArrayPointer(dz);
    system.derivative(t, N_VGetArrayPointer(z), rate);
    const auto finite = [](double value) { return std::isfinite(value); };
    return std::all_of(rate, rate + System::size, finite) ? 0 : recoverable;
  }

  static int jacobian(sunrealtype t, N_Vector z, N_Vector, SUNMatrix matrix, void* user_data,
                      N_Vector, N_Vector, N_Vector) {
    const auto& system = *static_cast<const System*>(user_data);
    Eigen::Map<model::JacobianOf<System>> target(SUNDenseMatrix_Data(matrix));  // column-major both
    target = model::jacobian(system, t, N_VGetArrayPointer(z));
    return target.allFinite() ? 0 : recoverable;
  }

  static int quadrature(sunrealtype, N_Vector z, N_Vector rate, void*) {
    N_VGetArrayPointer(rate)[0] = N_VGetArrayPointer(z)[std::max(0, model::spin_index<System>)];
    return 0;
  }
};

std::string explain(int flag) {
  switch (flag) {
    case CV_TOO_MUCH_ACC:
      return "the tolerance is finer than double precision can follow";
    case CV_ERR_FAILURE:
      return "the error test failed again and again at the smallest step";
    case CV_CONV_FAILURE:
      return "the nonlinear iteration did not converge at the smallest step";
    case CV_FIRST_RHSFUNC_ERR:
    case CV_REPTD_RHSFUNC_ERR:
    case CV_UNREC_RHSFUNC_ERR:
      return "the accelerations are no longer finite";
    case CV_LSETUP_FAIL:
    case CV_LSOLVE_FAIL:
      return "the linear system is singular";
    default: {
      char* name = CVodeGetReturnFlagName(flag);
      std::string text = "CVODE gave up with " + std::string(name);
      free(name);  // NOLINT: CVODE allocates it with malloc
      return text;
    }
  }
}

template <class System>
class CvodeRun {
 public:
  CvodeRun(const System& system, const model::Model& model, Method method, Tolerances tolerances,
           const OutputGrid& grid, StateSink& sink, const Watch& watch)
      : model_(model),
        method_(method),
        grid_(grid),
        watch_(watch),
        rows_(sink, System::size + (model.gamma ? 1 : 0)),
        context_(sundials::make_context()),
        state_(sundials::make_vector(System::size, context_.get())),
        at_output_(sundials::make_vector(System::size, context_.get())),
        cvode_(sundials::created(
            CVodeCreate(method == Method::bdf ? CV_BDF : CV_ADAMS, context_.get()))) {
    std::copy(model.initial.begin(), model.initial.end(), data(state_));
    sundials::silence(memory());
    check(CVodeInit(memory(), Callbacks<System>::derivative, 0.0, state_.get()), "CVodeInit");
    check(CVodeSStolerances(memory(), tolerances.rtol, tolerances.atol), "CVodeSStolerances");
    // The callbacks only read it.
    check(CVodeSetUserData(memory(), const_cast<System*>(&system)), "CVodeSetUserData");
    if (method == Method::bdf) {
      use_newton();
    } else {
      use_fixed_point();
    }
    if (model.gamma) integrate_spin();
  }

  Outcome run() {
    write_row(grid_[0]);
    std::size_t next_row = 1;
    std::size_t next_stop = 0;
    set_stop(next_stop);
    for (std::size_t steps = 1; time_ < grid_.end(); ++steps) {
      const int flag = CVode(memory(), grid_.end(), state_.get(), &time_, CV_ONE_STEP);
      if (flag < 0) return ended(Ending::failed, explain(flag));
      for (; next_row < grid_.size() && grid_[next_row] <= time_; ++next_row) {
        write_row(grid_[next_row]);
      }
      if (step_is_rounding()) {
        return ended(Ending::failed, "the step shrank to the rounding of the time itself");
      }
      if (flag == CV_TSTOP_RETURN && next_stop < model_.stops.size()) {
        restart();
        set_stop(++next_stop);
      }
      if (watch_.stop != nullptr && watch_.stop->load(std::memory_order_relaxed)) {
        return ended(Ending::interrupted, "");
      }
      if (watch_.progress && steps % 256 == 0) watch_.progress(time_);
    }
    return ended(Ending::done, "");
  }

 private:
  [[nodiscard]] void* memory() const { return cvode_.get(); }

  void use_newton() {
    matrix_ = sundials::DenseMatrix(
        sundials::created(SUNDenseMatrix(System::size, System::size, context_.get())));
    linear_ = sundials::LinearSolver(
        sundials::created(SUNLinSol_Dense(state_.get(), matrix_.get(), context_.get())));
    check(CVodeSetLinearSolver(memory(), linear_.get(), matrix_.get()), "CVodeSetLinearSolver");
    check(CVodeSetJacFn(memory(), Callbacks<System>::jacobian), "CVodeSetJacFn");
  }

  void use_fixed_point() {
    nonlinear_ = sundials::NonlinearSolver(
        sundials::created(SUNNonlinSol_FixedPoint(state_.get(), 0, context_.get())));
    check(CVodeSetNonlinearSolver(memory(), nonlinear_.get()), "CVodeSetNonlinearSolver");
  }

  void integrate_spin() {
    turned_ = sundials::make_vector(1, context_.get());
    data(turned_)[0] = 0;
    check(CVodeQuadInit(memory(), Callbacks<System>::quadrature, turned_.get()), "CVodeQuadInit");
    // No error control of its own: it is the integral of a state that has it. With it, CVODES 6
    // takes 45,000 steps instead of 600 over a stiff servo.
    check(CVodeSetQuadErrCon(memory(), 0), "CVodeSetQuadErrCon");
  }

  void set_stop(std::size_t next_stop) {
    const double stop = next_stop < model_.stops.size() ? model_.stops[next_stop] : grid_.end();
    check(CVodeSetStopTime(memory(), stop), "CVodeSetStopTime");
  }

  // From a stop, where the inputs' derivatives jump, the method's history is of no use.
  void restart() {
    collect_statistics();
    if (model_.gamma) {
      double unused = 0;
      check(CVodeGetQuad(memory(), &unused, turned_.get()), "CVodeGetQuad");
    }
    check(CVodeReInit(memory(), time_, state_.get()), "CVodeReInit");
    if (model_.gamma) check(CVodeQuadReInit(memory(), turned_.get()), "CVodeQuadReInit");
    tiny_steps_ = 0;
  }

  void write_row(double t) {
    double* row = rows_.next();
    const bool start = t == 0;
    if (start) {
      std::copy_n(data(state_), System::size, row);
    } else {
      check(CVodeGetDky(memory(), t, 0, at_output_.get()), "CVodeGetDky");
      std::copy_n(data(at_output_), System::size, row);
    }
    if (!model_.gamma) return;
    if (!start) check(CVodeGetQuadDky(memory(), t, 0, turned_.get()), "CVodeGetQuadDky");
    row[System::size] = data(turned_)[0];
  }

  // A solution that reaches infinity in finite time drives the step to nothing. A few tiny steps
  // are the method feeling its way; a hundred in a row are not.
  [[nodiscard]] bool step_is_rounding() {
    double last = 0;
    check(CVodeGetLastStep(memory(), &last), "CVodeGetLastStep");
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::abs(time_);
    tiny_steps_ = std::abs(last) <= rounding ? tiny_steps_ + 1 : 0;
    return tiny_steps_ >= 100;
  }

  void collect_statistics() {
    long steps = 0, rhs = 0, jacobians = 0, iterations = 0, failures = 0;
    CVodeGetNumSteps(memory(), &steps);
    CVodeGetNumRhsEvals(memory(), &rhs);
    CVodeGetNumNonlinSolvIters(memory(), &iterations);
    CVodeGetNumErrTestFails(memory(), &failures);
    if (method_ == Method::bdf) CVodeGetNumJacEvals(memory(), &jacobians);
    const auto add = [](std::size_t& sum, long part) { sum += static_cast<std::size_t>(part); };
    add(statistics_.steps, steps);
    add(statistics_.rhs_evaluations, rhs);
    add(statistics_.jacobian_evaluations, jacobians);
    add(statistics_.nonlinear_iterations, iterations);
    add(statistics_.error_test_failures, failures);
  }

  Outcome ended(Ending ending, std::string reason) {
    rows_.flush();
    collect_statistics();
    Outcome outcome{ending, method_, time_, rows_.rows(), statistics_, std::move(reason), 0, {}};
    if (ending == Ending::failed) {
      outcome.last_state.assign(data(state_), data(state_) + System::size);
      outcome.worst_state = worst_state();
    }
    return outcome;
  }

  // The state with the largest local error estimate in the solver's own weights.
  [[nodiscard]] std::size_t worst_state() const {
    const auto errors = sundials::make_vector(System::size, context_.get());
    const auto weights = sundials::make_vector(System::size, context_.get());
    if (CVodeGetEstLocalErrors(memory(), errors.get()) < 0) return 0;
    if (CVodeGetErrWeights(memory(), weights.get()) < 0) return 0;
    std::size_t worst = 0;
    double largest = -1;
    for (std::size_t i = 0; i < System::size; ++i) {
      const double weighted = std::abs(data(errors)[i] * data(weights)[i]);
      if (weighted > largest) {
        largest = weighted;
        worst = i;
      }
    }
    return worst;
  }

  const model::Model& model_;
  Method method_;
  const OutputGrid& grid_;
  const Watch& watch_;
  RowBlock rows_;
  sundials::Context context_;  // outlives all that is made with it
  sundials::Vector state_, at_output_, turned_;
  sundials::DenseMatrix matrix_;
  sundials::LinearSolver linear_;
  sundials::NonlinearSolver nonlinear_;
  sundials::CvodeMemory cvode_;
  double time_ = 0;
  int tiny_steps_ = 0;
  Statistics statistics_;
};

}  // namespace

Outcome integrate_cvode(const model::Model& model, Method method, Tolerances tolerances,
                        const OutputGrid& grid, StateSink& sink, const Watch& watch) {
  return std::visit(
      [&](const auto& system) {
        using System = std::decay_t<decltype(system)>;
        return CvodeRun<System>(system, model, method, tolerances, grid, sink, watch).run();
      },
      model.system);
}

}  // namespace bbsim::solve
