// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "simd/instruction_set.hpp"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "base/error.hpp"
#include "base/text.hpp"

#if defined(BBSIM_X86_KERNELS) && !defined(__clang__) && __has_include(<sys/platform/x86.h>)
// Use the features that the C library found when the program started. The compiler's
// __builtin_cpu_supports asks the processor again at every start, which takes microseconds per
// question in a virtual machine. (Clang cannot read this header: it has C's _Bool.)
#include <sys/platform/x86.h>
#define BBSIM_CPU_HAS(feature, name) CPU_FEATURE_ACTIVE(feature)
#else
#define BBSIM_CPU_HAS(feature, name) __builtin_cpu_supports(name)
#endif

namespace bbsim::simd {
namespace {

struct Candidate {
  InstructionSet set;
  const char* name;
  bool (*runs_here)();
};

// From the best to the one that every processor runs.
const Candidate candidates[] = {
#ifdef BBSIM_X86_KERNELS
    {InstructionSet::avx512, "avx512",
     [] {
       return BBSIM_CPU_HAS(AVX512F, "avx512f") && BBSIM_CPU_HAS(AVX512DQ, "avx512dq") &&
              BBSIM_CPU_HAS(AVX512VL, "avx512vl") && BBSIM_CPU_HAS(AVX2, "avx2") &&
              BBSIM_CPU_HAS(FMA, "fma");
     }},
    {InstructionSet::avx2, "avx2",
     [] { return BBSIM_CPU_HAS(AVX2, "avx2") && BBSIM_CPU_HAS(FMA, "fma"); }},
#endif
#ifdef __x86_64__
    {InstructionSet::baseline, "sse2", [] { return true; }},
#else
    {InstructionSet::baseline, "baseline", [] { return true; }},
#endif
};

std::string names() {
  return joined(candidates, [](const Candidate& candidate) {
    return std::string(candidate.name) + (candidate.runs_here() ? "" : " (not on this processor)");
  });
}

}  // namespace

const char* name_of(InstructionSet set) {
  return std::ranges::find(candidates, set, &Candidate::set)->name;
}

std::optional<InstructionSet> find_instruction_set(std::string_view name) {
  for (const Candidate& candidate : candidates) {
    if (candidate.name == name && candidate.runs_here()) return candidate.set;
  }
  return {};
}

InstructionSet chosen_instruction_set() {
  if (const char* const asked = std::getenv("BBSIM_SIMD")) {
    if (const auto found = find_instruction_set(asked)) return *found;
    throw InputError("environment variable BBSIM_SIMD: found '" + std::string(asked) +
                     "'; allowed: " + names());
  }
  return std::ranges::find_if(candidates,
                              [](const Candidate& candidate) { return candidate.runs_here(); })
      ->set;
}

}  // namespace bbsim::simd
