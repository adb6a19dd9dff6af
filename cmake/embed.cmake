# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Writes the names and texts of files to an array in a C++ header:
#
#   cmake "-DFILES=FILE|FILE" -DNAME=NAME -DINTO=FILE.hpp -P embed.cmake
string(REPLACE "|" ";" FILES "${FILES}")
set(entries "")
foreach(file IN LISTS FILES)
  file(READ "${file}" content)
  if(content MATCHES "[)]embedded\"")
    message(FATAL_ERROR "${file} contains )embedded\", which would end a string in ${INTO}")
  endif()
  get_filename_component(name "${file}" NAME)
  string(APPEND entries "    {\"${name}\", R\"embedded(${content})embedded\"},\n")
endforeach()
file(WRITE "${INTO}" "inline constexpr bbsim::app::EmbeddedFile ${NAME}[] = {\n${entries}};\n")
