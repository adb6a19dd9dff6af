#include "solve/lanes/rosenbrock.hpp"

namespace bbsim::solve::lanes {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const KernelSet kernels_avx512;
constinit const KernelSet kernels_avx512{"avx512", Avx512::lanes,
                                         Rosenbrock<Avx512, Drives::acceleration>::kernel,
                                         Rosenbrock<Avx512, Drives::angle>::kernel};

}  // namespace bbsim::solve::lanes
