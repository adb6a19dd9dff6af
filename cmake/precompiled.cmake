# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Precompiles headers once for many targets. Reading the standard library and Eigen is half of the compile time.
#
#   bbsim_precompiled(NAME HEADERS <header>... [LIBRARIES <target>...] [OPTIONS <option>...])
#
# creates NAME. Targets with the same options reuse its headers with target_precompile_headers(TARGET REUSE_FROM NAME).
# The options include the -O level: GCC would silently compile a target with the level of the headers. Sources still
# include what they use, because clang-tidy reads them without precompiled headers (preset tidy).
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
