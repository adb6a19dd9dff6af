# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# NLopt's header, and the library name that bbsim tune and design load (docs/decisions/tuning.md).
find_path(NLOPT_INCLUDE_DIR nlopt.h REQUIRED)
find_library(NLOPT_LIBRARY nlopt REQUIRED)
mark_as_advanced(NLOPT_INCLUDE_DIR NLOPT_LIBRARY)
file(REAL_PATH ${NLOPT_LIBRARY} _file)
get_filename_component(NLOPT_SONAME ${_file} NAME)
# Programs load libnlopt.so.0.11.1 as libnlopt.so.0.
if(NLOPT_SONAME MATCHES "^(libnlopt\\.so\\.[0-9]+)")
  set(NLOPT_SONAME ${CMAKE_MATCH_1})
endif()
