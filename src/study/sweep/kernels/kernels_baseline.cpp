#include "study/sweep/kernels/rows.hpp"

#ifdef __x86_64__
#define BBSIM_BASELINE "sse2"
#else
#define BBSIM_BASELINE "baseline"
#endif

namespace bbsim::study {

struct BaselineRows {
  static constexpr int lanes = 2;
};

extern const SweepKernels sweep_kernels_baseline;
constinit const SweepKernels sweep_kernels_baseline =
    RowKernels<BaselineRows>::named(BBSIM_BASELINE);

}  // namespace bbsim::study
