# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Finds CVODES, the serial vector, and the dense solver of SUNDIALS 6 or 7, static if possible.
#
# SUNDIALS has its own CMake config. Debian's version fails to load unless every library from its build is installed
# (MPI, hypre, PETSc, SuperLU: 135 packages). This module needs only the five libraries that bbsim links.
#
# Defines the target SUNDIALS::cvodes. Searches SUNDIALS_ROOT, then .deps/sundials (where scripts/setup unpacks it),
# then the system.
set(_hints ${SUNDIALS_ROOT} ${PROJECT_SOURCE_DIR}/.deps/sundials/usr)

find_path(SUNDIALS_INCLUDE_DIR cvodes/cvodes.h HINTS ${_hints} PATH_SUFFIXES include)

function(_sundials_library variable)
  set(CMAKE_FIND_LIBRARY_SUFFIXES .a ${CMAKE_FIND_LIBRARY_SUFFIXES})
  find_library(${variable} NAMES ${ARGN} HINTS ${_hints}
               PATH_SUFFIXES lib lib64 lib/${CMAKE_LIBRARY_ARCHITECTURE})
  mark_as_advanced(${variable})
endfunction()

_sundials_library(SUNDIALS_cvodes_LIBRARY sundials_cvodes)
_sundials_library(SUNDIALS_nvecserial_LIBRARY sundials_nvecserial)
_sundials_library(SUNDIALS_sunmatrixdense_LIBRARY sundials_sunmatrixdense)
_sundials_library(SUNDIALS_sunlinsoldense_LIBRARY sundials_sunlinsoldense)
_sundials_library(SUNDIALS_sunnonlinsolnewton_LIBRARY sundials_sunnonlinsolnewton)
_sundials_library(SUNDIALS_sunnonlinsolfixedpoint_LIBRARY sundials_sunnonlinsolfixedpoint)
_sundials_library(SUNDIALS_core_LIBRARY sundials_core sundials_generic) # core in 7, generic in 6

if(SUNDIALS_INCLUDE_DIR)
  file(STRINGS ${SUNDIALS_INCLUDE_DIR}/sundials/sundials_config.h _version
       REGEX "^#define SUNDIALS_VERSION \"")
  string(REGEX REPLACE ".*\"([0-9.]+).*" "\\1" SUNDIALS_VERSION "${_version}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SUNDIALS
  REQUIRED_VARS SUNDIALS_cvodes_LIBRARY SUNDIALS_nvecserial_LIBRARY SUNDIALS_sunmatrixdense_LIBRARY
                SUNDIALS_sunlinsoldense_LIBRARY SUNDIALS_core_LIBRARY SUNDIALS_INCLUDE_DIR
  VERSION_VAR SUNDIALS_VERSION
  REASON_FAILURE_MESSAGE "run scripts/setup, or pass -DSUNDIALS_ROOT=PREFIX")

if(SUNDIALS_FOUND AND NOT TARGET SUNDIALS::cvodes)
  add_library(SUNDIALS::cvodes INTERFACE IMPORTED)
  # libsundials_cvodes may contain the solver modules. If they are separate libraries, link them.
  set(_libraries ${SUNDIALS_cvodes_LIBRARY} ${SUNDIALS_nvecserial_LIBRARY}
                 ${SUNDIALS_sunlinsoldense_LIBRARY} ${SUNDIALS_sunmatrixdense_LIBRARY})
  foreach(_part sunnonlinsolnewton sunnonlinsolfixedpoint)
    if(SUNDIALS_${_part}_LIBRARY)
      list(APPEND _libraries ${SUNDIALS_${_part}_LIBRARY})
    endif()
  endforeach()
  list(APPEND _libraries ${SUNDIALS_core_LIBRARY})
  target_link_libraries(SUNDIALS::cvodes INTERFACE ${_libraries} m)
  target_include_directories(SUNDIALS::cvodes SYSTEM INTERFACE ${SUNDIALS_INCLUDE_DIR})
endif()
mark_as_advanced(SUNDIALS_INCLUDE_DIR)
