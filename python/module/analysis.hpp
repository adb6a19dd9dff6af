// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What fits, tuning and designs need of a scenario: its keys, tables, measures and drawn cases.
#pragma once

#include "given.hpp"

namespace bbsim::python {

void define_analysis(py::module_& module);

}  // namespace bbsim::python
