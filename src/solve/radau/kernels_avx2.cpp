#include "solve/radau/kernels.hpp"

namespace bbsim::solve::radau {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const StepKernels kernels_avx2;
constinit const StepKernels kernels_avx2{
    {BBSIM_KERNELS(Avx2, 8), BBSIM_KERNELS(Avx2, 12), BBSIM_KERNELS(Avx2, 16)}};

}  // namespace bbsim::solve::radau
