# SPDX-FileCopyrightText: 2026 the bbsim authors
# SPDX-License-Identifier: BSD-3-Clause

# Finds a Python with numpy, scipy, matplotlib and headers, and pybind11. BBSIM_HAS_PYTHON is ON if all were found. The system's
# packages may be for another Python than the first python3 on PATH.
set(BBSIM_HAS_PYTHON OFF)
set(_pythons ${PYTHON_EXECUTABLE} python3 /usr/bin/python3)
foreach(_python IN LISTS _pythons)
  execute_process(
    COMMAND ${_python} -c "import matplotlib, numpy, os, scipy, sys, sysconfig; h = sysconfig.get_path('include'); assert os.path.exists(os.path.join(h, 'Python.h')); print(sys.executable)"
    OUTPUT_VARIABLE _found OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE _failed)
  if(NOT _failed)
    set(PYTHON_EXECUTABLE ${_found} CACHE FILEPATH "the Python that the package bbsim is built for")
    find_package(pybind11 2.10 QUIET)
    set(BBSIM_HAS_PYTHON ${pybind11_FOUND})
    break()
  endif()
endforeach()
