// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiled once for each instruction set (cmake/kernels.cmake).
#include <type_traits>
#include <variant>

#include "model/systems/list.hpp"
#include "simd/isa.hpp"
#include "solve/radau/step.hpp"

namespace bbsim::solve::radau {
namespace {

// Switches cut the motion of rigs beyond the paper's into short pieces. Orders above 23 pay only
// over long steps, so they are not compiled for these rigs.
template <class System>
inline constexpr int stages_at_most = System::papers_rig ? 16 : 12;

// Coupled scenes (losses, sliding, torques, linkages, pushes) have kernels for the baseline only.
// Their pieces are short, and their right-hand sides so long that wider lanes would save little.
// These kernels would take as long to compile as all others together.
template <class Isa, class System>
inline constexpr bool is_compiled = Isa::lanes == 2 || !model::is_coupled<System>;

template <class Isa, class System, int stages>
consteval Kernel kernel_for() {
  if constexpr (is_compiled<Isa, System>) {
    return Step<Isa, System,
                (stages < stages_at_most<System> ? stages : stages_at_most<System>)>::kernel;
  } else {
    return {};
  }
}

template <class Isa, class... Systems>
consteval StepKernels kernels_of(std::type_identity<std::variant<Systems...>>) {
  static_assert(sizeof...(Systems) == system_count);
  return {{{kernel_for<Isa, Systems, 8>()...},
           {kernel_for<Isa, Systems, 12>()...},
           {kernel_for<Isa, Systems, 16>()...}}};
}

// In the order of the systems.
template <class Isa>
consteval StepKernels kernels_of() {
  return kernels_of<Isa>(std::type_identity<model::SystemViews>{});
}

}  // namespace

template <class Isa>
const StepKernels& kernels() {
  static constexpr StepKernels table = kernels_of<Isa>();
  return table;
}
template const StepKernels& kernels<BBSIM_ISA>();

}  // namespace bbsim::solve::radau
