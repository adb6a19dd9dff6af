// Which kernels run: those for the best instruction set of the processor, or the one named.
#include <cstdlib>
#include <cstring>
#include <string>

#include "base/error.hpp"
#include "solve/collocation/radau.hpp"

namespace bbsim::solve::collocation {

extern const KernelSet kernels_baseline;
#ifdef BBSIM_X86_KERNELS
extern const KernelSet kernels_avx2;
extern const KernelSet kernels_avx512;
#endif

namespace {

struct Candidate {
  const KernelSet& kernels;
  bool (*runs_here)();
};

bool always() {
  return true;
}

// From the best to the one that every processor runs.
const Candidate candidates[] = {
#ifdef BBSIM_X86_KERNELS
    {kernels_avx512,
     [] {
       return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
              __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx2") &&
              __builtin_cpu_supports("fma");
     }},
    {kernels_avx2, [] { return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"); }},
#endif
    {kernels_baseline, always},
};

std::string names() {
  std::string list;
  for (const Candidate& candidate : candidates) {
    list += (list.empty() ? "" : ", ") + std::string(candidate.kernels.name);
    if (!candidate.runs_here()) list += " (not on this processor)";
  }
  return list;
}

}  // namespace

const KernelSet* find_kernels(const char* name) {
  for (const Candidate& candidate : candidates) {
    if (std::strcmp(candidate.kernels.name, name) == 0) {
      return candidate.runs_here() ? &candidate.kernels : nullptr;
    }
  }
  return nullptr;
}

const KernelSet& choose_kernels() {
  if (const char* const asked = std::getenv("BBSIM_SIMD")) {
    if (const KernelSet* const found = find_kernels(asked)) return *found;
    throw InputError("environment variable BBSIM_SIMD: found '" + std::string(asked) +
                     "'; allowed: " + names());
  }
  for (const Candidate& candidate : candidates) {
    if (candidate.runs_here()) return candidate.kernels;
  }
  return kernels_baseline;
}

}  // namespace bbsim::solve::collocation
