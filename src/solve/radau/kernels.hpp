// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// All kernels of one instruction set.
#pragma once

#include <type_traits>
#include <variant>

#include "model/systems/list.hpp"
#include "solve/radau/step.hpp"

namespace bbsim::solve::radau {

// Rigs beyond the paper's are cut into short pieces by what switches: orders above 23, which pay
// over long steps, are not compiled for them.
template <class System>
inline constexpr int stages_at_most = System::papers_rig ? 16 : 12;

// Of scenes with couples, sliding or torques, in which pieces are short and a right-hand side is
// long enough to hide what wider lanes would save, there are kernels for the baseline alone: they
// would take compilers as long as all others together.
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

}  // namespace bbsim::solve::radau
