// For every processor: pairs of lanes, which are SSE2 on x86-64 and Neon on 64-bit ARM.
#include "solve/collocation/kernels.hpp"

namespace bbsim::solve::collocation {

struct Baseline {
  static constexpr int lanes = 2;
};

#ifdef __x86_64__
#define BBSIM_BASELINE "sse2"
#else
#define BBSIM_BASELINE "baseline"
#endif

extern const KernelSet kernels_baseline;
constinit const KernelSet kernels_baseline{
    BBSIM_BASELINE,
    {BBSIM_KERNELS(Baseline, 8), BBSIM_KERNELS(Baseline, 12), BBSIM_KERNELS(Baseline, 16)}};

}  // namespace bbsim::solve::collocation
