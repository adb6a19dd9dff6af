# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Writes the man pages bbsim.1, bbsim-run.1 and so on INTO a folder, by HELP2MAN from the help of ./bbsim.
execute_process(COMMAND ./bbsim --words "" OUTPUT_VARIABLE _commands COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[a-z]+" _commands "${_commands}")
file(REMOVE_RECURSE ${INTO})
foreach(_command IN LISTS _commands ITEMS "")
  set(_page bbsim)
  set(_what "simulate a ball on a plate that tilts about two axes")
  if(_command)
    set(_page bbsim-${_command})
    execute_process(COMMAND ./bbsim ${_command} --help OUTPUT_VARIABLE _what COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX REPLACE "\nUsage: .*" "" _what "${_what}")
    string(REPLACE "\n" " " _what "${_what}")
  endif()
  string(STRIP "./bbsim ${_command}" _words)
  execute_process(COMMAND ${HELP2MAN} --no-info --version-string=${VERSION} "--name=${_what}" ${_words}
                  OUTPUT_VARIABLE _text COMMAND_ERROR_IS_FATAL ANY)
  # The names of pages have no spaces.
  string(TOUPPER ${_page} _title)
  string(REPLACE ".TH BBSIM " ".TH ${_title} " _text "${_text}")
  string(REPLACE ".SH NAME\nbbsim ${_command} " ".SH NAME\n${_page} " _text "${_text}")
  file(WRITE ${INTO}/${_page}.1 "${_text}")
endforeach()
