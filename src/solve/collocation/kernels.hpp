// All kernels of one instruction set.
#pragma once

#include "model/system.hpp"
#include "solve/collocation/step.hpp"

namespace bbsim::solve::collocation {

template <class Isa, int s>
struct Family {
  template <model::Shape shape>
  using Open = Step<Isa, model::OpenLoop<shape, model::SignalView>, s>;
  template <model::Shape shape, Drives drives>
  using Closed = Step<Isa, model::ClosedLoop<shape, drives, model::SignalView>, s>;
};

// In the order of model::System.
#define BBSIM_KERNELS(Isa, s)                                                        \
  {                                                                                  \
    Family<Isa, s>::Open<model::Shape::full>::kernel,                                \
        Family<Isa, s>::Open<model::Shape::along_x>::kernel,                         \
        Family<Isa, s>::Open<model::Shape::along_y>::kernel,                         \
        Family<Isa, s>::Closed<model::Shape::full, Drives::acceleration>::kernel,    \
        Family<Isa, s>::Closed<model::Shape::along_x, Drives::acceleration>::kernel, \
        Family<Isa, s>::Closed<model::Shape::along_y, Drives::acceleration>::kernel, \
        Family<Isa, s>::Closed<model::Shape::full, Drives::angle>::kernel,           \
        Family<Isa, s>::Closed<model::Shape::along_x, Drives::angle>::kernel,        \
        Family<Isa, s>::Closed<model::Shape::along_y, Drives::angle>::kernel         \
  }

}  // namespace bbsim::solve::collocation
