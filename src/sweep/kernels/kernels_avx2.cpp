#include "sweep/kernels/rows.hpp"

namespace bbsim::sweep {

struct Avx2Rows {
  static constexpr int lanes = 4;
};

extern const SweepKernels sweep_kernels_avx2;
constinit const SweepKernels sweep_kernels_avx2 = RowKernels<Avx2Rows>::kernels;

}  // namespace bbsim::sweep
