# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# The program uses only api/: no file of apps/ includes the computing code (docs/architecture.md).
file(GLOB_RECURSE _files ${SOURCE}/apps/*.cpp ${SOURCE}/apps/*.hpp ${SOURCE}/apps/*.h)
if(NOT _files)
  message(FATAL_ERROR "found no sources in ${SOURCE}/apps")
endif()
set(_found)
foreach(_file IN LISTS _files)
  file(STRINGS ${_file} _includes REGEX "#[ \t]*include[ \t]*[<\"](model|controller|solve|record|study|sweep)/")
  foreach(_include IN LISTS _includes)
    string(APPEND _found "\n${_file}: ${_include}")
  endforeach()
endforeach()
if(_found)
  message(FATAL_ERROR "these belong behind src/api:${_found}")
endif()
