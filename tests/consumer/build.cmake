# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# cmake -DBUILD=FOLDER -DSOURCE=FOLDER -DINTO=FOLDER -DCXX=COMPILER -P build.cmake: installs the build into a fresh
# prefix, builds the consumer against it by CMake and by pkg-config, and runs it.
function(do)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE _failed OUTPUT_VARIABLE _out ERROR_VARIABLE _out)
  if(_failed)
    message(FATAL_ERROR "${ARGN}: ${_out}")
  endif()
  set(output "${_out}" PARENT_SCOPE)
endfunction()

function(expect)
  set(_wanted "rows, x = [-0-9.e]+, max_tilt\n2 cases\n[0-9]+ states\n[0-9]+ samples\nball.radius: allowed: ")
  if(NOT output MATCHES "${_wanted}")
    message(FATAL_ERROR "the consumer printed ${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${INTO})
do(${CMAKE_COMMAND} --install ${BUILD} --prefix ${INTO}/prefix --component library)
do(${CMAKE_COMMAND} --install ${BUILD} --prefix ${INTO}/prefix --component development)
do(${CMAKE_COMMAND} -S ${SOURCE}/tests/consumer -B ${INTO}/build -DCMAKE_PREFIX_PATH=${INTO}/prefix
   -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_FIND_PACKAGE_NO_PACKAGE_REGISTRY=ON)
do(${CMAKE_COMMAND} --build ${INTO}/build)
do(${INTO}/build/consumer ${SOURCE}/configs)
expect()

find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB_RECURSE _pc ${INTO}/prefix/*/bbsim.pc)
  get_filename_component(_folder ${_pc} DIRECTORY)
  set(ENV{PKG_CONFIG_PATH} ${_folder})
  do(${PKG_CONFIG} --cflags --libs bbsim)
  string(STRIP "${output}" _flags)
  separate_arguments(_flags)
  get_filename_component(_libraries ${_folder} DIRECTORY)
  do(${CXX} -std=c++20 ${SOURCE}/tests/consumer/consumer.cpp -o ${INTO}/consumer ${_flags} -Wl,-rpath,${_libraries})
  do(${INTO}/consumer ${SOURCE}/configs)
  expect()
endif()
message(STATUS "the consumer is built and run")
