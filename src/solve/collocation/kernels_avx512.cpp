#include "solve/collocation/kernels.hpp"

namespace bbsim::solve::collocation {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const KernelSet kernels_avx512;
constinit const KernelSet kernels_avx512{
    "avx512", {BBSIM_KERNELS(Avx512, 8), BBSIM_KERNELS(Avx512, 12), BBSIM_KERNELS(Avx512, 16)}};

}  // namespace bbsim::solve::collocation
