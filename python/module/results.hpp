// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Stored results, what bbsim knows of their columns, and files written whole.
#pragma once

#include <pybind11/pybind11.h>

namespace bbsim::python {

void define_results(pybind11::module_& module);

}  // namespace bbsim::python
