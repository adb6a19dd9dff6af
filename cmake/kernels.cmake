# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Compiles one source for several instruction sets; the program chooses one at run time:
#
#   bbsim_add_kernels(TARGET ROOM [WIDEST_AVX2])
#
# creates an object library from kernels.cpp of the current folder: once for the baseline and, for x86-64, for AVX2 and,
# unless WIDEST_AVX2, for AVX-512. BBSIM_ISA is the tag of the set (simd/isa.hpp); BBSIM_IS_AVX512 is defined for
# AVX-512. Adds it to the library ROOM, which selects one of them
# (simd/instruction_set.hpp).
set(BBSIM_X86_KERNELS OFF)
if(NOT BBSIM_BASELINE_ONLY AND CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 8)
  set(BBSIM_X86_KERNELS ON)
  target_compile_definitions(bbsim_options INTERFACE BBSIM_X86_KERNELS)
endif()

# Adds kernels.cpp of the current folder to the object library, for one instruction set.
function(_bbsim_add_kernels_of target isa)
  string(TOLOWER ${isa} name)
  string(TOUPPER ${isa} upper)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/kernels_${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT
       "#define BBSIM_ISA bbsim::simd::${isa}\n#define BBSIM_IS_${upper}\n#include \"${CMAKE_CURRENT_SOURCE_DIR}/kernels.cpp\"\n")
  target_sources(${target} PRIVATE ${source})

  # Source options come last on the command line, so they override those of bbsim::options. Instruction sets agree to
  # the tolerance, not bit for bit, so products may be fused. Packs never cross a function's boundary, so their calling
  # convention (-Wpsabi) does not matter. Without errno, the roots of a pack are one instruction. Sanitizers are off,
  # because compilers would take many minutes for the unrolled loops; all memory is in fixed arrays.
  set(options -ffp-contract=fast -fno-math-errno -Wno-psabi ${ARGN})
  if(BBSIM_INSTRUMENTED)
    list(APPEND options -fno-sanitize=all)
  endif()
  set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${options}")
endfunction()

function(bbsim_add_kernels target room)
  add_library(${target} OBJECT)
  target_include_directories(${target} PRIVATE $<TARGET_PROPERTY:${room},INCLUDE_DIRECTORIES>)
  target_link_libraries(${target} PRIVATE bbsim::options)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_sources(${room} PRIVATE $<TARGET_OBJECTS:${target}>)

  _bbsim_add_kernels_of(${target} Baseline)
  if(BBSIM_X86_KERNELS)
    _bbsim_add_kernels_of(${target} Avx2 -mavx2 -mfma)
    if(NOT "WIDEST_AVX2" IN_LIST ARGN)
      _bbsim_add_kernels_of(${target} Avx512 -mavx512f -mavx512dq -mavx512vl -mavx2 -mfma -mprefer-vector-width=512)
    endif()
  endif()
endfunction()
