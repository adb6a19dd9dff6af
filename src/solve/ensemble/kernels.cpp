// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Compiled once for each instruction set (cmake/kernels.cmake).
#include "simd/isa.hpp"
#include "solve/ensemble/given_step.hpp"
#include "solve/ensemble/loop_step.hpp"
#include "solve/ensemble/step.hpp"

namespace bbsim::solve::ensemble {

template <class Isa, int s>
inline constexpr Kernel given = Step<GivenStep<Work<Linear<Isa, s>>>>::kernel;
template <class Isa, Actuation actuation, int s>
inline constexpr Kernel loop = Step<LoopStep<Work<Newton<Isa, actuation, s>>>>::kernel;

template <class Isa>
const Kernels& kernels() {
  static constexpr Kernels table{
      Isa::lanes,
      {given<Isa, 8>, given<Isa, 12>, given<Isa, 16>, loop<Isa, Actuation::by_acceleration, 8>,
       loop<Isa, Actuation::by_acceleration, 12>, loop<Isa, Actuation::by_servo, 8>,
       loop<Isa, Actuation::by_servo, 12>}};
  return table;
}
template const Kernels& kernels<BBSIM_ISA>();

}  // namespace bbsim::solve::ensemble
