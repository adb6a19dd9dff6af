# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# find_package(bbsim): bbsim::bbsim, the shared library, and bbsim::bbsim_static, if it was built. The components shared
# and static ask for one of them.
include(${CMAKE_CURRENT_LIST_DIR}/bbsim-targets.cmake)
set(bbsim_shared_FOUND TRUE)
set(bbsim_static_FOUND FALSE)
if(EXISTS ${CMAKE_CURRENT_LIST_DIR}/bbsim-static-targets.cmake)
  include(CMakeFindDependencyMacro)
  find_dependency(Threads)
  include(${CMAKE_CURRENT_LIST_DIR}/bbsim-static-targets.cmake)
  set(bbsim_static_FOUND TRUE)
endif()
foreach(_component IN LISTS bbsim_FIND_COMPONENTS)
  if(bbsim_FIND_REQUIRED_${_component} AND NOT bbsim_${_component}_FOUND)
    set(bbsim_FOUND FALSE)
    set(bbsim_NOT_FOUND_MESSAGE "found no component ${_component}; this bbsim was built with: shared")
    if(bbsim_static_FOUND)
      string(APPEND bbsim_NOT_FOUND_MESSAGE ", static")
    endif()
  endif()
endforeach()
