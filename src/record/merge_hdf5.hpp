// The HDF5 side of merge.hpp.
#pragma once

#include "record/merge.hpp"

namespace bbsim::record {

[[nodiscard]] Merged merge_hdf5(const std::vector<std::string>& parts, const std::string& target,
                                const std::atomic<bool>& stop);

}  // namespace bbsim::record
