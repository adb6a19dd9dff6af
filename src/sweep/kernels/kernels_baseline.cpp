#include "sweep/kernels/rows.hpp"

namespace bbsim::sweep {

struct BaselineRows {
  static constexpr int lanes = 2;
};

extern const SweepKernels sweep_kernels_baseline;
constinit const SweepKernels sweep_kernels_baseline = RowKernels<BaselineRows>::kernels;

}  // namespace bbsim::sweep
