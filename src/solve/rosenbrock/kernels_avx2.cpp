#include "solve/rosenbrock/rosenbrock.hpp"

namespace bbsim::solve::rosenbrock {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const LaneKernels kernels_avx2;
constinit const LaneKernels kernels_avx2{Avx2::lanes,
                                         Rosenbrock<Avx2, Drives::acceleration>::kernel,
                                         Rosenbrock<Avx2, Drives::angle>::kernel};

}  // namespace bbsim::solve::rosenbrock
