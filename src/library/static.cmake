# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# libbbsim.a, the target bbsim::bbsim_static: one object with all that the shared library has inside, made by ld and
# objcopy of binutils. An archive of archives would offer the rooms' names, yaml-cpp's and SUNDIALS' to the program that
# links it, which may have other versions of them. join.cmake leaves only the names of the API.
get_target_property(_sundials SUNDIALS::cvodes INTERFACE_LINK_LIBRARIES)
list(REMOVE_ITEM _sundials m)
set(_archives ${_sundials} ${YAML_CPP_STATIC_LIBRARY})
set(_shared ${_archives})
list(FILTER _shared EXCLUDE REGEX "[.]a$")
find_program(BBSIM_JOIN_LINKER NAMES ${CMAKE_LIBRARY_ARCHITECTURE}-ld.bfd ld.bfd DOC "GNU ld, for libbbsim.a")
find_program(BBSIM_JOIN_OBJCOPY NAMES ${CMAKE_LIBRARY_ARCHITECTURE}-objcopy objcopy DOC "GNU objcopy, for libbbsim.a")
mark_as_advanced(BBSIM_JOIN_LINKER BBSIM_JOIN_OBJCOPY)
set(_lacks)
if(NOT YAML_CPP_STATIC_LIBRARY)
  set(_lacks "yaml-cpp has no static library here")
elseif(_shared)
  set(_lacks "SUNDIALS has no static library here")
elseif(NOT BBSIM_JOIN_LINKER OR NOT BBSIM_JOIN_OBJCOPY)
  set(_lacks "there is no ld.bfd or objcopy of GNU's binutils")
endif()
if(_lacks)
  message(STATUS "No static library: ${_lacks}")
  return()
endif()

get_property(_rooms GLOBAL PROPERTY BBSIM_ROOMS)
foreach(_room IN LISTS _rooms)
  list(APPEND _room_files $<TARGET_FILE:${_room}>)
endforeach()
set(_joined ${CMAKE_CURRENT_BINARY_DIR}/bbsim.o)
set(_join ${CMAKE_CURRENT_SOURCE_DIR}/join.cmake)
add_custom_command(
  OUTPUT ${_joined}
  COMMAND ${CMAKE_COMMAND} -DLINKER=${BBSIM_JOIN_LINKER} -DOBJCOPY=${BBSIM_JOIN_OBJCOPY} -DNM=${CMAKE_NM}
          "-DOBJECT=$<TARGET_OBJECTS:bbsim_library>" "-DARCHIVES=$<JOIN:${_room_files};${_archives},|>"
          -DINTO=${_joined} -P ${_join}
  DEPENDS $<TARGET_OBJECTS:bbsim_library> ${_rooms} ${_room_files} ${_archives} ${_join}
  COMMENT "Joining the library and all that it needs in one object" VERBATIM)
add_library(bbsim_static STATIC ${_joined})
add_library(bbsim::bbsim_static ALIAS bbsim_static)
set_source_files_properties(${_joined} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
target_include_directories(bbsim_static PUBLIC ${_include})
target_compile_features(bbsim_static PUBLIC cxx_std_20)
target_link_libraries(bbsim_static INTERFACE Threads::Threads ${CMAKE_DL_LIBS} m)
set_target_properties(bbsim_static PROPERTIES LINKER_LANGUAGE CXX OUTPUT_NAME bbsim
  ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib UNITY_BUILD OFF)
