# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# cmake --install runs this on the pages that it has just installed (cmake/packages.cmake). Their links are between
# source files. A link to an installed file of any component becomes a link to its installed place. A link to another
# source file becomes the file's name. Needs
#   BBSIM_SOURCE     the folder of the sources
#   BBSIM_PREFIX     the prefix, without DESTDIR, like the folders below
#   BBSIM_DOC_DIR, BBSIM_DATA_DIR, BBSIM_INCLUDE_DIR   folders below it, or absolute

foreach(_folder IN ITEMS DOC DATA INCLUDE)
  cmake_path(ABSOLUTE_PATH BBSIM_${_folder}_DIR BASE_DIRECTORY ${BBSIM_PREFIX} NORMALIZE)
endforeach()

# Sets the place where the file or folder `path` of the sources is installed; empty if it is not.
function(installed_place path result)
  set(_place)
  if(path MATCHES "^docs/(.*\\.(md|png))$")
    set(_place ${BBSIM_DOC_DIR}/pages/${CMAKE_MATCH_1})
  elseif(path MATCHES "^(README\\.md|CHANGELOG\\.md|CITATION\\.cff)$")
    set(_place ${BBSIM_DOC_DIR}/${path})
  elseif(path MATCHES "^(configs|examples|matlab)(/|$)")
    set(_place ${BBSIM_DATA_DIR}/bbsim/${path})
  elseif(path MATCHES "^include/(bbsim/.*)$")
    set(_place ${BBSIM_INCLUDE_DIR}/${CMAKE_MATCH_1})
  endif()
  set(${result} "${_place}" PARENT_SCOPE)
endfunction()

# rewrite PATH-IN-THE-SOURCES: writes the page to its installed place, from its text in the sources
function(rewrite page)
  installed_place(${page} _installed)
  set(_file $ENV{DESTDIR}${_installed})
  file(READ ${BBSIM_SOURCE}/${page} _rest)
  cmake_path(GET page PARENT_PATH _folder)
  cmake_path(GET _installed PARENT_PATH _installed_folder)
  set(_done)
  set(_names_sources FALSE)
  while(_rest MATCHES "\\[([^][]*)\\]\\(([^][() \n#]+)(#[^)\n]*)?\\)|\\]\\(([^][() \n#]+)(#[^)\n]*)?\\)")
    set(_link "${CMAKE_MATCH_0}")
    set(_text "${CMAKE_MATCH_1}")
    set(_target "${CMAKE_MATCH_2}${CMAKE_MATCH_4}")
    set(_anchor "${CMAKE_MATCH_3}${CMAKE_MATCH_5}")
    string(FIND "${_rest}" "${_link}" _at)
    string(SUBSTRING "${_rest}" 0 ${_at} _before)
    string(LENGTH "${_link}" _length)
    math(EXPR _after "${_at} + ${_length}")
    string(SUBSTRING "${_rest}" ${_after} -1 _rest)
    string(APPEND _done "${_before}")

    set(_path "${_folder}/${_target}")
    cmake_path(NORMAL_PATH _path)
    string(REGEX REPLACE "^/|/$" "" _path "${_path}")
    if(_target MATCHES "^[a-z]+:" OR NOT EXISTS "${BBSIM_SOURCE}/${_path}") # elsewhere, or code that looks like a link
      string(APPEND _done "${_link}")
      continue()
    endif()
    installed_place("${_path}" _place)
    if(_place)
      cmake_path(RELATIVE_PATH _place BASE_DIRECTORY ${_installed_folder})
      string(REPLACE "](${_target}${_anchor})" "](${_place}${_anchor})" _link "${_link}")
      string(APPEND _done "${_link}")
      continue()
    endif()
    set(_names_sources TRUE)
    # If the text is the file's name or ends it, only the full name remains.
    string(REGEX REPLACE "`|/$" "" _plain "${_text}")
    string(FIND "/${_path}" "/${_plain}" _at REVERSE)
    string(LENGTH "${_plain}" _length)
    math(EXPR _end "${_at} + ${_length}")
    string(LENGTH "${_path}" _length)
    if(NOT _at EQUAL -1 AND _end EQUAL _length)
      string(APPEND _done "`${_path}`")
    else()
      string(APPEND _done "${_text} (`${_path}`)")
    endif()
  endwhile()
  string(APPEND _done "${_rest}")
  if(_names_sources)
    string(APPEND _done "\nPaths without a link, such as `CMakeLists.txt`, are files of bbsim's sources.\n")
  endif()
  file(WRITE ${_file} "${_done}")
endfunction()

file(GLOB_RECURSE _pages RELATIVE ${BBSIM_SOURCE} ${BBSIM_SOURCE}/docs/*.md)
foreach(_page IN ITEMS README.md CHANGELOG.md LISTS _pages)
  rewrite(${_page})
endforeach()
