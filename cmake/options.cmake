# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Compile options of every target, linked as bbsim::options.
add_library(bbsim_options INTERFACE)
add_library(bbsim::options ALIAS bbsim_options)

target_compile_options(bbsim_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                                               -Wno-sign-conversion -Wnon-virtual-dtor)
if(BBSIM_WARNINGS_AS_ERRORS)
  # Warnings that GCC infers from optimized code stay warnings: GCC 12 reports its own std::string.
  target_compile_options(bbsim_options INTERFACE -Werror
    $<$<CXX_COMPILER_ID:GNU>:-Wno-error=restrict;-Wno-error=stringop-overflow;-Wno-error=array-bounds;-Wno-error=maybe-uninitialized>)
endif()

if(BBSIM_UNITY)
  # These warnings are false for combined sources. The preset dev compiles sources singly and keeps them.
  target_compile_options(bbsim_options INTERFACE -Wno-shadow
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()

# a*b + c must give the same result on every machine, because results are compared bit for bit.
target_compile_options(bbsim_options INTERFACE -ffp-contract=off)

if(BBSIM_SANITIZE)
  # Fuzz targets share the project's objects with the tests. The tests' own sources omit libFuzzer's coverage counters,
  # which cost a fifth of the compile time.
  set(_counted $<AND:$<BOOL:${BBSIM_FUZZ}>,$<NOT:$<BOOL:$<TARGET_PROPERTY:BBSIM_NO_COVERAGE>>>>)
  set(_sanitizers address,undefined$<${_counted}:,fuzzer-no-link>)
  target_compile_options(bbsim_options INTERFACE -fsanitize=${_sanitizers}
                                                 -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(bbsim_options INTERFACE -fsanitize=address,undefined)
elseif(BBSIM_TSAN)
  target_compile_options(bbsim_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(bbsim_options INTERFACE -fsanitize=thread)
elseif(BBSIM_STATIC_RUNTIME)
  # Exceptions cross from a library to the program that loads it, so both must share a runtime.
  set(_own $<NOT:$<BOOL:$<TARGET_PROPERTY:BBSIM_SHARED_RUNTIME>>>)
  target_link_options(bbsim_options INTERFACE $<${_own}:-static-libstdc++> $<${_own}:-static-libgcc>)
endif()

# bbsim_spare_from_sanitizers(SOURCE...): compiles sources of the current folder without sanitizers. For sources with
# mostly dense Eigen algebra, which would take compilers minutes and a gigabyte each. Eigen's own assertions, which are
# on in these builds, check the bounds.
function(bbsim_spare_from_sanitizers)
  if(BBSIM_INSTRUMENTED)
    set_property(SOURCE ${ARGN} APPEND PROPERTY COMPILE_OPTIONS -fno-sanitize=all)
    set_property(SOURCE ${ARGN} PROPERTY SKIP_PRECOMPILE_HEADERS ON) # they are instrumented
  endif()
endfunction()
