// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "solve/radau/radau.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <new>
#include <type_traits>
#include <variant>

#include "solve/collocation/step_length.hpp"

namespace bbsim::solve::radau {
namespace {

constexpr std::size_t alignment = 64;

double highest_frequency(const model::Model& model) {
  return std::visit(
      [](const auto& system) {
        if constexpr (std::decay_t<decltype(system)>::open_loop) {
          return system.motion().highest_frequency();
        } else {
          return system.reference().highest_frequency();
        }
      },
      model.system);
}

bool is_open_loop(const model::Model& model) {
  return std::visit([](const auto& system) { return std::decay_t<decltype(system)>::open_loop; },
                    model.system);
}

// The fastest rate of the sines of the gimbal's angles, or of a reference, rad/s.
double tempo(const model::Model& model) {
  return std::visit(
      [&](const auto& system) {
        double fastest = highest_frequency(model);
        if constexpr (std::decay_t<decltype(system)>::open_loop) {
          const model::SignalView motion = system.motion().view();
          fastest += std::max(std::abs(motion.rate[0]), std::abs(motion.rate[1]));
        }
        return fastest;
      },
      model.system);
}

// For rigs beyond the paper's, the entry for 16 stages has the kernel for 12 (kernels.hpp).
const Kernel& find_kernel(const StepKernels& kernels, int stages, const model::Model& model) {
  const std::size_t order = stages == 8 ? 0 : stages == 12 ? 1 : 2;
  const Kernel& kernel = kernels.kernels[order][model.system.index()];
  if (kernel.attempt != nullptr) return kernel;
  return radau::kernels<simd::Baseline>().kernels[order][model.system.index()];
}

std::size_t size_of_view(const model::Model& model) {
  return std::visit([](const auto& system) { return sizeof(system.view()); }, model.system);
}

// The magnitude of the largest state; infinite if a state is not finite.
double size_of(const std::vector<double>& state) {
  double size = 0;
  for (const double value : state) {
    if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
    size = std::max(size, std::abs(value));
  }
  return size;
}

}  // namespace

const StepKernels& choose_kernels() {
  return simd::kernels_by<simd::Widest::avx2>(
      [](auto isa) -> const auto& { return kernels<decltype(isa)>(); });
}

int choose_stages(const model::Model& model, double rtol) {
  // Substitution solves no linear systems, so more stages cost little time.
  const double for_most = is_open_loop(model) ? 1e-6 : 3e-9;
  return rtol > 3e-6 ? 8 : rtol > for_most ? 12 : 16;
}

int stages_of(const model::Model& model, int stages) {
  return find_kernel(choose_kernels(), stages, model).stages;
}

RadauStepper::RadauStepper(const model::Model& model, const StepKernels& kernels, int stages,
                           Tolerances tolerances, double end)
    : model_(&model),
      kernel_(&find_kernel(kernels, stages, model)),
      tolerances_(tolerances),
      end_(end),
      highest_frequency_(highest_frequency(model)),
      reach_(resolved(kernel_->stages, tolerances.rtol)),
      // A sinusoid shorter than the distance of two nodes would look like a longer one.
      widest_(highest_frequency_ > 0 ? 1.6 * kernel_->stages / highest_frequency_
                                     : std::numeric_limits<double>::max()),
      tempo_(tempo(model)) {
  const std::size_t both = kernel_->workspace + size_of_view(model);
  std::size_t room = both + alignment;
  memory_ = std::make_unique_for_overwrite<std::byte[]>(room);
  workspace_ = memory_.get();
  std::align(alignment, both, workspace_, room);
  view_ = static_cast<std::byte*>(workspace_) + kernel_->workspace;
}

// Makes the kernel's own view of the system in its present mode.
void RadauStepper::look_at_model() {
  std::visit(
      [this](const auto& system) {
        using View = decltype(system.view());
        static_assert(std::is_trivially_destructible_v<View> && alignof(View) <= alignment);
        new (view_) View(system.view());
      },
      model_->system);
}

std::size_t RadauStepper::detail() const {
  return static_cast<std::size_t>(kernel_->stages);
}

// The Legendre coefficients of the accelerations fall geometrically, to the tolerance at the last
// stage. Those of products of two states fall half as fast, so they need twice as many. Explicit
// functions of time may not show in the error estimate. Their coefficients fall only beyond the
// number of radians in the step.
std::size_t RadauStepper::parts() const {
  constexpr double least = 8, of_products = 2, a_radian = 3, most = 128;
  const double parts = std::max(of_products * kernel_->stages * fill_,
                                least + a_radian * std::abs(tempo_ * accepted_step_));
  return static_cast<std::size_t>(std::clamp(std::ceil(parts), least, most));
}

// Makes the end of the last step the present state.
void RadauStepper::settle() {
  if (attempted_) kernel_->accept(workspace_);
  attempted_ = false;
}

std::vector<double> RadauStepper::state() const {
  std::vector<double> z(model_->size());
  kernel_->state(workspace_, z.data());
  return z;
}

void RadauStepper::start(double t, const double* z) {
  look_at_model();
  if (model_->gamma && t > 0 && attempted_) {
    std::vector<double> row(model_->size() + 1);
    evaluate(&t, 1, row.data());
    turned_ = row.back();
  }
  attempted_ = false;
  kernel_->start(workspace_, {view_, z, tolerances_.rtol, tolerances_.atol, model_->gamma});
  time_ = t;
  shrinking_.interrupt();
  if (steps_.next > 0) return;
  const double rate = std::max(kernel_->rate(workspace_, t), highest_frequency_);
  steps_.next = rate > 0 ? 2 * reach_ / rate : end_;
  if (!(steps_.next > 0)) steps_.next = end_ * 1e-6;
}

// Whether the motion is about to reach infinity. A hybrid rig is exempt, because an event may stop
// it first.
bool RadauStepper::diverges(double step, double t) {
  return shrinking_.diverges(step, t, [this] { return size_of(state()); }) && !model_->hybrid();
}

std::optional<Failure> RadauStepper::step(double limit) {
  settle();
  const int stages = kernel_->stages;
  const double t = time_;
  // The last stage is at the end of the step, and sees the input there.
  const double to = model_->jumps_at(limit) ? model_->just_before(limit) : limit;
  const double left = (to > t ? to : limit) - t;
  for (;;) {
    const auto [step, arrives] = stride(left, std::min(steps_.next, widest_));
    if (!arrives && is_lost(step, t)) return step_is_lost;
    Attempt attempt;
    kernel_->attempt(workspace_, t, step, &attempt);
    statistics_.rhs_evaluations += static_cast<std::size_t>(attempt.right_hand_sides);
    statistics_.jacobian_evaluations += static_cast<std::size_t>(attempt.jacobians);
    statistics_.nonlinear_iterations += static_cast<std::size_t>(attempt.iterations);
    const bool converged = attempt.verdict == Verdict::converged;
    if (converged) worst_state_ = static_cast<std::size_t>(attempt.worst_state);
    if (!converged || !(attempt.error <= 1)) {
      steps_.reject(step, converged ? step_growth(attempt.error, stages)
                          : attempt.verdict == Verdict::not_finite ? 0.1
                                                                   : StepControl::unsolved);
      ++statistics_.error_test_failures;
      continue;
    }
    if (!arrives && diverges(step, t)) return Shrinking::reason;
    attempted_ = true;
    time_ = arrives ? limit : t + step;
    ++statistics_.steps;
    const double factor = step_growth(static_cast<float>(attempt.error), stages);
    steps_.accept(step, arrives, factor, shrinking_.bound(attempt.error, step * factor, stages));
    accepted_step_ = step;
    fill_ = std::min(1.0, step_safety / factor);
    return {};
  }
}

void RadauStepper::evaluate(const double* times, std::size_t count, double* rows) {
  kernel_->evaluate(workspace_, times, count, rows);
  if (turned_ == 0) return;
  const std::size_t row = model_->size() + 1;
  for (std::size_t i = 0; i < count; ++i) rows[i * row + row - 1] += turned_;
}

}  // namespace bbsim::solve::radau
