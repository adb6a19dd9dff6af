#include "solve/radau/kernels.hpp"

namespace bbsim::solve::radau {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const StepKernels kernels_avx512;
constinit const StepKernels kernels_avx512{
    {BBSIM_KERNELS(Avx512, 8), BBSIM_KERNELS(Avx512, 12), BBSIM_KERNELS(Avx512, 16)}};

}  // namespace bbsim::solve::radau
