# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Combines an HTML file with its local styles and scripts in one file:
#
#   cmake -DINDEX=replay.html -DLIBRARIES=FILE|FILE -DNOTICES=FOLDER -DOUTPUT=page.html
#         -P inline_page.cmake
#
# Each file that INDEX names is beside it or, by name, in LIBRARIES. @NOTICE:NAME@ becomes the text of NAME in NOTICES.
file(READ "${INDEX}" page)
get_filename_component(folder "${INDEX}" DIRECTORY)
string(REPLACE "|" ";" LIBRARIES "${LIBRARIES}")

function(content_of name result)
  set(file "${folder}/${name}")
  foreach(library IN LISTS LIBRARIES)
    get_filename_component(library_name "${library}" NAME)
    if(library_name STREQUAL name)
      set(file "${library}")
    endif()
  endforeach()
  file(READ "${file}" content)
  # An end tag would end the script that contains it. A source map would cause a network request.
  if(content MATCHES "</(script|style)")
    message(FATAL_ERROR "${file} contains '</${CMAKE_MATCH_1}', which would end its element of the page")
  endif()
  string(REGEX REPLACE "\n?(//|/[*])# sourceMappingURL=[^\n]*" "" content "${content}")
  # The page states its license once.
  string(REGEX REPLACE "^((//|/[*]) SPDX-[^\n]*\n+)+" "" content "${content}")
  # Remove indentation and comment lines, which a page does not need. examples.js has texts to show.
  if(NOT name MATCHES "[.]min[.]|^examples[.]js$")
    string(REGEX REPLACE "\n[ \t]*//[^\n]*" "" content "${content}")
    string(REGEX REPLACE "\n[ \t\n]+" "\n" content "${content}")
  endif()
  # Shader sources are a ninth of three.js. The page uses its own shader instead.
  if(name STREQUAL "three.min.js")
    string(REGEX REPLACE "(var [a-z0-9_]+=)\"[^\"]*\\\\n[^\"]*\"" "\\1\"\"" content "${content}")
  endif()
  set(${result} "${content}" PARENT_SCOPE)
endfunction()

string(REGEX MATCHALL "<link rel=\"stylesheet\" href=\"[^\"]*\">" links "${page}")
foreach(link IN LISTS links)
  string(REGEX REPLACE ".*href=\"([^\"]*)\".*" "\\1" name "${link}")
  content_of("${name}" content)
  string(REPLACE "${link}" "<style>\n${content}</style>" page "${page}")
endforeach()

string(REGEX MATCHALL "<script src=\"[^\"]*\"></script>" scripts "${page}")
foreach(script IN LISTS scripts)
  string(REGEX REPLACE ".*src=\"([^\"]*)\".*" "\\1" name "${script}")
  content_of("${name}" content)
  string(REPLACE "${script}" "<script>\n${content}\n</script>" page "${page}")
endforeach()

string(REGEX MATCHALL "@NOTICE:[^@]*@" notices "${page}")
foreach(notice IN LISTS notices)
  string(REGEX REPLACE "@NOTICE:(.*)@" "\\1" name "${notice}")
  file(READ "${NOTICES}/${name}" text)
  string(STRIP "${text}" text)
  string(REPLACE "&" "&amp;" text "${text}")
  string(REPLACE "<" "&lt;" text "${text}")
  string(REPLACE "${notice}" "${text}" page "${page}")
endforeach()

if(page MATCHES "(href|src)=\"[^\"#]+\\.(js|css)\"")
  message(FATAL_ERROR "${INDEX} refers to a file that is not in the page: ${CMAKE_MATCH_0}")
endif()
file(WRITE "${OUTPUT}" "${page}")
