# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# cmake -DNM=PROGRAM -DDYNAMIC=OPTION -DLIBRARY=FILE -P exports.cmake: fails if the library exports a name outside its
# API. OPTION is -D for a shared library, -g for an archive.
execute_process(COMMAND ${NM} ${DYNAMIC} --defined-only -C ${LIBRARY} OUTPUT_VARIABLE _names COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" _names "${_names}")
set(_count 0)
foreach(_name IN LISTS _names)
  if(_name STREQUAL "" OR _name MATCHES "^[^ ]+:$") # name of an archive member
    continue()
  endif()
  math(EXPR _count "${_count} + 1")
  if(NOT _name MATCHES "bbsim::v0::")
    message(SEND_ERROR "exported: ${_name}")
  endif()
endforeach()
if(_count LESS 20)
  message(FATAL_ERROR "exported: only ${_count} names")
endif()
