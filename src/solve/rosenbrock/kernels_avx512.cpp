#include "solve/rosenbrock/rosenbrock.hpp"

namespace bbsim::solve::rosenbrock {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const LaneKernels kernels_avx512;
constinit const LaneKernels kernels_avx512{Avx512::lanes,
                                           Rosenbrock<Avx512, Drives::acceleration>::kernel,
                                           Rosenbrock<Avx512, Drives::angle>::kernel};

}  // namespace bbsim::solve::rosenbrock
