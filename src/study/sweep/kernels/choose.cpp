#include <cstring>

#include "solve/collocation/radau.hpp"
#include "study/sweep/kernels/sweep_kernels.hpp"

namespace bbsim::study {

extern const SweepKernels sweep_kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const SweepKernels sweep_kernels_avx2;
extern const SweepKernels sweep_kernels_avx512;
#endif

const SweepKernels& choose_sweep_kernels() {
#ifdef BBSIM_X86_KERNELS
  const char* const name = solve::collocation::choose_kernels().name;
  for (const SweepKernels* const kernels : {&sweep_kernels_avx512, &sweep_kernels_avx2}) {
    if (std::strcmp(kernels->name, name) == 0) return *kernels;
  }
#endif
  return sweep_kernels_baseline;
}

}  // namespace bbsim::study
