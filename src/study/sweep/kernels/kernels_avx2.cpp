#include "study/sweep/kernels/rows.hpp"

namespace bbsim::study {

struct Avx2Rows {
  static constexpr int lanes = 4;
};

extern const SweepKernels sweep_kernels_avx2;
constinit const SweepKernels sweep_kernels_avx2 = RowKernels<Avx2Rows>::named("avx2");

}  // namespace bbsim::study
