#include "simd/instruction_set.hpp"
#include "sweep/kernels/sweep_kernels.hpp"

namespace bbsim::sweep {

extern const SweepKernels sweep_kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const SweepKernels sweep_kernels_avx2;
extern const SweepKernels sweep_kernels_avx512;
#endif

const SweepKernels& choose_sweep_kernels() {
#ifdef BBSIM_X86_KERNELS
  return simd::pick(simd::chosen_instruction_set(), sweep_kernels_baseline, sweep_kernels_avx2,
                    sweep_kernels_avx512);
#else
  return sweep_kernels_baseline;
#endif
}

}  // namespace bbsim::sweep
