# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# cmake -DSCRIPT=commit.cmake -DFOLDER=FOLDER -P commit.cmake
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
set(_header "${FOLDER}/bbsim_commit.hpp")

function(look_up)
  execute_process(COMMAND ${CMAKE_COMMAND} -DSOURCE=${FOLDER} -DINTO=${_header} -P "${SCRIPT}"
                  COMMAND_ERROR_IS_FATAL ANY)
endfunction()
function(require_text commit suffix)
  file(READ "${_header}" _text)
  if(NOT _text MATCHES "#define BBSIM_COMMIT \"${commit}\"\n#define BBSIM_COMMIT_SUFFIX \"${suffix}\"\n")
    message(FATAL_ERROR "found: ${_text}")
  endif()
endfunction()

look_up()
require_text("unknown: not built from a git work tree" "")
file(TIMESTAMP "${_header}" _first "%s")
execute_process(COMMAND ${CMAKE_COMMAND} -E sleep 1.1)
look_up()
file(TIMESTAMP "${_header}" _second "%s")
if(NOT _first STREQUAL _second)
  message(FATAL_ERROR "the header was written again, the same")
endif()

find_program(GIT git)
if(NOT GIT)
  return()
endif()
set(_git ${GIT} -C "${FOLDER}" -c user.name=n -c user.email=e -c commit.gpgsign=false)
file(WRITE "${FOLDER}/src/file" "one")
file(WRITE "${FOLDER}/tests/file" "one")
foreach(_words "init;-q" "add;src;tests" "commit;-q;-m;one")
  execute_process(COMMAND ${_git} ${_words} COMMAND_ERROR_IS_FATAL ANY)
endforeach()
look_up()
require_text("[0-9a-f]+" "\\+g[0-9a-f]+")
file(WRITE "${FOLDER}/tests/file" "another") # not a part of the program
look_up()
require_text("[0-9a-f]+" "\\+g[0-9a-f]+")
file(WRITE "${FOLDER}/src/file" "another")
look_up()
require_text("[0-9a-f]+, with changes" "\\+g[0-9a-f]+.changed")
