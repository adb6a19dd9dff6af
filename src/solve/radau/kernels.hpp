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

template <class Isa, class System, int stages>
inline constexpr const Kernel& kernel_for =
    Step<Isa, System, (stages < stages_at_most<System> ? stages : stages_at_most<System>)>::kernel;

template <class Isa, class... Systems>
consteval StepKernels kernels_of(std::type_identity<std::variant<Systems...>>) {
  static_assert(sizeof...(Systems) == system_count);
  return {{{kernel_for<Isa, Systems, 8>...},
           {kernel_for<Isa, Systems, 12>...},
           {kernel_for<Isa, Systems, 16>...}}};
}

// In the order of the systems.
template <class Isa>
consteval StepKernels kernels_of() {
  return kernels_of<Isa>(std::type_identity<model::SystemViews>{});
}

}  // namespace bbsim::solve::radau
