#include "solve/held/piece.hpp"

namespace bbsim::solve::held {

struct Avx512 {
  static constexpr int lanes = 8;
};

extern const Kernels kernels_avx512;
constinit const Kernels kernels_avx512 = Kernel<Avx512>::kernels;

}  // namespace bbsim::solve::held
