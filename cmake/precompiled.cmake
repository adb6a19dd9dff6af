# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Headers that are read once for many targets: half of what compilers do here is to read the standard
# library's and Eigen's.
#
#   bbsim_precompiled(NAME HEADERS <header>... [LIBRARIES <target>...] [OPTIONS <option>...])
#
# makes NAME, from which targets of the same options take what is compiled:
# target_precompile_headers(TARGET REUSE_FROM NAME). The level of -O is one of these: GCC compiles what
# takes headers of another level with theirs, and says nothing. Sources include what they use all the same:
# clang-tidy reads them without (preset tidy).
function(bbsim_precompiled name)
  cmake_parse_arguments(_with "" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
  set(_empty ${PROJECT_BINARY_DIR}/${name}.cpp)
  if(NOT EXISTS ${_empty})
    file(WRITE ${_empty} "")
  endif()
  add_library(${name} OBJECT ${_empty})
  target_link_libraries(${name} PRIVATE bbsim::options ${_with_LIBRARIES})
  target_compile_options(${name} PRIVATE ${_with_OPTIONS})
  target_precompile_headers(${name} PRIVATE ${_with_HEADERS})
endfunction()

set(BBSIM_STANDARD_HEADERS <algorithm> <array> <cmath> <cstddef> <cstdint> <cstdio> <functional>
    <limits> <map> <memory> <optional> <span> <string> <string_view> <type_traits> <utility> <variant> <vector>)
bbsim_precompiled(bbsim_standard_headers HEADERS ${BBSIM_STANDARD_HEADERS})
