#include "simd/instruction_set.hpp"
#include "solve/rosenbrock/kernel.hpp"

namespace bbsim::solve::rosenbrock {

extern const LaneKernels kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const LaneKernels kernels_avx2;
extern const LaneKernels kernels_avx512;
#endif

const LaneKernels& choose_kernels() {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(simd::chosen_instruction_set(), kernels_baseline, kernels_avx2, kernels_avx512);
#else
  return kernels_baseline;
#endif
}

}  // namespace bbsim::solve::rosenbrock
