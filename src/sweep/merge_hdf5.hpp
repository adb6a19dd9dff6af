// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The HDF5 side of merge.hpp.
#pragma once

#include "sweep/merge.hpp"

namespace bbsim::sweep {

[[nodiscard]] Merged merge_hdf5(const std::vector<std::string>& parts, const std::string& target,
                                const std::atomic<bool>& stop);

}  // namespace bbsim::sweep
