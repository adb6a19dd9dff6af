#include "solve/collocation/kernels.hpp"

namespace bbsim::solve::collocation {

struct Avx2 {
  static constexpr int lanes = 4;
};

extern const KernelSet kernels_avx2;
constinit const KernelSet kernels_avx2{
    "avx2", {BBSIM_KERNELS(Avx2, 8), BBSIM_KERNELS(Avx2, 12), BBSIM_KERNELS(Avx2, 16)}};

}  // namespace bbsim::solve::collocation
