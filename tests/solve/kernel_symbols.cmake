# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Kernels for different instruction sets must share no code: the linker would pick one definition of a shared function,
# and it could run on a machine without its instructions.
#
#   cmake -DNM=nm "-DOBJECTS=a.o|b.o" -P kernel_symbols.cmake
string(REPLACE "|" ";" OBJECTS "${OBJECTS}")
foreach(object IN LISTS OBJECTS)
  execute_process(COMMAND ${NM} -C --defined-only ${object} OUTPUT_VARIABLE symbols
                  COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
  foreach(symbol IN LISTS symbols)
    if(symbol MATCHES "^[0-9a-f]+ [TWu] " AND NOT symbol MATCHES "Avx2|Avx512|Baseline")
      message(SEND_ERROR "${object}: not of one instruction set: ${symbol}")
    endif()
  endforeach()
endforeach()
