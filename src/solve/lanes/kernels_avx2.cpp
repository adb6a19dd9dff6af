#include "solve/lanes/rosenbrock.hpp"

namespace bbsim::solve::lanes {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const KernelSet kernels_avx2;
constinit const KernelSet kernels_avx2{"avx2", Avx2::lanes,
                                       Rosenbrock<Avx2, Drives::acceleration>::kernel,
                                       Rosenbrock<Avx2, Drives::angle>::kernel};

}  // namespace bbsim::solve::lanes
