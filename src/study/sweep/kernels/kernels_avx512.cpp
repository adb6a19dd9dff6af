#include "study/sweep/kernels/rows.hpp"

namespace bbsim::study {

struct Avx512Rows {
  static constexpr int lanes = 8;
};

extern const SweepKernels sweep_kernels_avx512;
constinit const SweepKernels sweep_kernels_avx512 = RowKernels<Avx512Rows>::named("avx512");

}  // namespace bbsim::study
