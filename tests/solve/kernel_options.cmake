# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Kernels must be compiled with their own options (cmake/kernels.cmake), which the common options of other targets would
# undo if they came later: fused products if the instruction set has them, and no sanitizers.
#
#   cmake -DNM=nm -DOBJDUMP=objdump "-DOBJECTS=a.o|b.o" -P kernel_options.cmake
string(REPLACE "|" ";" OBJECTS "${OBJECTS}")
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} --undefined-only ${object} OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
  if(symbols MATCHES "__(asan|ubsan|sanitizer)_[a-z0-9_]+")
    message(SEND_ERROR "${object}: instrumented: it calls ${CMAKE_MATCH_0}")
  endif()

  execute_process(COMMAND ${OBJDUMP} -d --no-show-raw-insn ${object}
                  COMMAND grep -Ec "[[:space:]]vfn?m(add|sub)[0-9]+[ps]d[[:space:]]"
                  OUTPUT_VARIABLE fused OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT fused MATCHES "^[0-9]+$")
    message(SEND_ERROR "${object}: ${OBJDUMP} cannot be read")
  elseif(object MATCHES "kernels_avx(2|512)\\." AND fused EQUAL 0)
    message(SEND_ERROR "${object}: no fused product")
  endif()
  message(STATUS "${object}: ${fused} fused products")
endforeach()
