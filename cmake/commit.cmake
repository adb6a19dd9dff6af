# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# cmake -DSOURCE=FOLDER -DINTO=HEADER -P commit.cmake: writes a header with the commit of the source tree. Leaves an
# unchanged header alone, so that sources that include it are not compiled again.
set(_commit "unknown: not built from a git work tree")
set(_suffix "")
file(REAL_PATH "${SOURCE}" _source)
function(ask_git into)
  execute_process(COMMAND git --no-optional-locks -C "${_source}" ${ARGN}
                  RESULT_VARIABLE _result OUTPUT_VARIABLE _output ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT _result EQUAL 0)
    set(_output "")
  endif()
  set(${into} "${_output}" PARENT_SCOPE)
endfunction()

ask_git(_top rev-parse --show-toplevel)
# A source tree unpacked inside another work tree does not belong to that tree's commits.
if(_top AND _top STREQUAL _source)
  ask_git(_hash rev-parse --short=7 HEAD)
  # Changes of what the program is built from.
  ask_git(_changes status --porcelain --untracked-files=no -- CMakeLists.txt cmake include src apps python)
  if(_hash MATCHES "^[0-9a-f]+$")
    set(_commit "${_hash}")
    set(_suffix "+g${_hash}")
    if(_changes)
      string(APPEND _commit ", with changes")
      string(APPEND _suffix ".changed")
    endif()
  endif()
endif()

set(_text "#pragma once\n\n#define BBSIM_COMMIT \"${_commit}\"\n#define BBSIM_COMMIT_SUFFIX \"${_suffix}\"\n")
set(_before "")
if(EXISTS "${INTO}")
  file(READ "${INTO}" _before)
endif()
if(NOT _before STREQUAL _text)
  file(WRITE "${INTO}" "${_text}")
endif()
