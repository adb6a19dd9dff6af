#include "sweep/kernels/rows.hpp"

namespace bbsim::sweep {

struct Avx512Rows {
  static constexpr int lanes = 8;
};

extern const SweepKernels sweep_kernels_avx512;
constinit const SweepKernels sweep_kernels_avx512 = RowKernels<Avx512Rows>::kernels;

}  // namespace bbsim::sweep
