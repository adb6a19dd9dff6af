// The HDF5 side of merge.hpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bbsim::record {

[[nodiscard]] std::size_t merge_hdf5(const std::vector<std::string>& parts,
                                     const std::string& target);

}  // namespace bbsim::record
