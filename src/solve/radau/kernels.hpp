// All kernels of one instruction set.
#pragma once

#include "model/systems/rig_loop.hpp"
#include "model/systems/system.hpp"
#include "solve/radau/step.hpp"

namespace bbsim::solve::radau {

template <class Isa, int s>
struct Family {
  template <model::Shape shape>
  using Open = Step<Isa, model::OpenLoop<shape, model::SignalView>, s>;
  template <model::Shape shape, Drives drives>
  using Closed = Step<Isa, model::ClosedLoop<shape, drives, model::SignalView>, s>;

  // Rigs beyond the paper's are cut into short pieces by what switches: orders above 23, which pay
  // over long steps, are not compiled for them.
  static constexpr int rig_stages = s < 12 ? s : 12;
  using GeneralOpen =
      Step<Isa, model::OpenLoop<model::Shape::full, model::SignalView, model::GeneralRolling>,
           rig_stages>;
  template <bool integrates>
  using Rig = Step<Isa, model::RigLoop<integrates, model::SignalView>, rig_stages>;
};

// In the order of model::System.
#define BBSIM_KERNELS(Isa, s)                                                             \
  {                                                                                       \
    Family<Isa, s>::Open<model::Shape::full>::kernel,                                     \
        Family<Isa, s>::Open<model::Shape::along_x>::kernel,                              \
        Family<Isa, s>::Open<model::Shape::along_y>::kernel,                              \
        Family<Isa, s>::Closed<model::Shape::full, Drives::acceleration>::kernel,         \
        Family<Isa, s>::Closed<model::Shape::along_x, Drives::acceleration>::kernel,      \
        Family<Isa, s>::Closed<model::Shape::along_y, Drives::acceleration>::kernel,      \
        Family<Isa, s>::Closed<model::Shape::full, Drives::angle>::kernel,                \
        Family<Isa, s>::Closed<model::Shape::along_x, Drives::angle>::kernel,             \
        Family<Isa, s>::Closed<model::Shape::along_y, Drives::angle>::kernel,             \
        Family<Isa, s>::GeneralOpen::kernel, Family<Isa, s>::template Rig<false>::kernel, \
        Family<Isa, s>::template Rig<true>::kernel                                        \
  }

}  // namespace bbsim::solve::radau
