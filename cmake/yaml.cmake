# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# yaml-cpp. The program links the static library if the system has one: the shared one adds 0.3 ms to its start.
# Debian's static library cannot be linked into a shared one, so bbsim's library and Python module use the shared one.
find_package(yaml-cpp REQUIRED)
add_library(bbsim_yaml_cpp INTERFACE)
add_library(bbsim::yaml_cpp ALIAS bbsim_yaml_cpp)
find_library(YAML_CPP_STATIC_LIBRARY libyaml-cpp.a)
mark_as_advanced(YAML_CPP_STATIC_LIBRARY)
if(YAML_CPP_STATIC_LIBRARY)
  target_link_libraries(bbsim_yaml_cpp INTERFACE
    $<IF:$<BOOL:$<TARGET_PROPERTY:BBSIM_SHARED_RUNTIME>>,yaml-cpp,${YAML_CPP_STATIC_LIBRARY}>)
  target_include_directories(bbsim_yaml_cpp SYSTEM INTERFACE ${YAML_CPP_INCLUDE_DIR})
else()
  target_link_libraries(bbsim_yaml_cpp INTERFACE yaml-cpp)
endif()
