// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The HDF5 side of case_file.hpp.
#pragma once

#include <memory>
#include <string>

#include "sweep/case_file.hpp"

namespace bbsim::sweep {

// An HDF5 file that was not closed is useless. The part is therefore CSV, with a file of plain
// numbers for the series. finish() makes the HDF5 file from both.
[[nodiscard]] std::unique_ptr<CaseFile> open_case_file_hdf5(const std::string& target,
                                                            CaseFileLayout layout,
                                                            const std::string& plan, bool resume);

}  // namespace bbsim::sweep
