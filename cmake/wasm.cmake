# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# The engine of live pages: the rooms as WebAssembly, by emscripten (scripts/build wasm). It has neither HDF5, CVODE nor
# child processes; wasm/absent.cpp says so to whoever asks for them. BBSIM_WASM_DEPS is the folder of the libraries'
# sources and headers (scripts/setup --wasm).
set(BBSIM_WASM_DEPS ${PROJECT_SOURCE_DIR}/.deps/wasm CACHE PATH "yaml-cpp's sources, and the headers of other libraries")
set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON) # libcxx.hpp comes first
foreach(_needed IN ITEMS yaml-cpp/src include/Eigen include/nlohmann include/fast_float)
  if(NOT EXISTS ${BBSIM_WASM_DEPS}/${_needed})
    message(FATAL_ERROR "${BBSIM_WASM_DEPS}/${_needed} is missing: run scripts/setup --wasm")
  endif()
endforeach()

target_compile_options(bbsim_options INTERFACE
  -msimd128 -fwasm-exceptions -fno-math-errno $<$<COMPILE_LANGUAGE:CXX>:-include${PROJECT_SOURCE_DIR}/wasm/libcxx.hpp>
  -Wno-unused-command-line-argument -Wno-sign-compare)
target_include_directories(bbsim_options SYSTEM INTERFACE ${BBSIM_WASM_DEPS}/include)
# Matrices up to about 30 by 30 are multiplied by short loops: Eigen's kernels for large ones are slow at -Os.
target_compile_definitions(bbsim_options INTERFACE EIGEN_GEMM_TO_COEFFBASED_THRESHOLD=100)

foreach(_headers IN ITEMS Eigen3::Eigen nlohmann_json::nlohmann_json Threads::Threads SUNDIALS::cvodes)
  add_library(${_headers} INTERFACE IMPORTED GLOBAL)
endforeach()

file(GLOB _yaml ${BBSIM_WASM_DEPS}/yaml-cpp/src/*.cpp)
add_library(bbsim_yaml_cpp STATIC ${_yaml})
add_library(bbsim::yaml_cpp ALIAS bbsim_yaml_cpp)
target_include_directories(bbsim_yaml_cpp SYSTEM PUBLIC ${BBSIM_WASM_DEPS}/yaml-cpp/include)
target_compile_options(bbsim_yaml_cpp PRIVATE -fwasm-exceptions -w)

# Sources whose functions wasm/absent.cpp replaces or that nothing in a page calls.
set(BBSIM_NOT_IN_PAGES "solve/cvode/|file/start_process|controller/(child|program|library|foreign_code|host)|study/(accuracy|reference|verify)|api/(accuracy|stepped_run|environments|run_sensitivity)")
