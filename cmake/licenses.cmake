# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Writes texts, separated by lines of dashes, to a string in a C++ header:
#
#   cmake "-DTEXTS=FILE|FILE" -DINTO=FILE.hpp -P licenses.cmake
string(REPLACE "|" ";" TEXTS "${TEXTS}")
string(REPEAT "-" 80 rule)
set(strings "")
foreach(text IN LISTS TEXTS)
  file(READ "${text}" content)
  if(content MATCHES "[)]license\"")
    message(FATAL_ERROR "${text} contains )license\", which ends a string of ${INTO}")
  endif()
  if(NOT strings STREQUAL "")
    string(APPEND strings "\n    \"\\n${rule}\\n\\n\"")
  endif()
  string(APPEND strings "\n    R\"license(${content})license\"")
endforeach()
file(WRITE "${INTO}" "inline constexpr char bbsim_licenses[] =${strings};\n")
