// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Replay pages and comparisons of results.
#pragma once

#include <pybind11/pybind11.h>

namespace bbsim::python {

void define_pages(pybind11::module_& module);

}  // namespace bbsim::python
