// The parts of a sweep -> the file that one run of it would have written.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace bbsim::record {

// Puts the parts, CSV or HDF5 alike, in the order of their cases and writes them to `target`, to
// the byte what a sweep without shards writes. Returns the number of cases.
//
// Throws InputError unless they have the same columns and together every case from 0 on once; parts
// that are named as of so many (-2of3) must be all there. Throws OutputError.
[[nodiscard]] std::size_t merge_cases(const std::vector<std::string>& parts,
                                      const std::string& target);

}  // namespace bbsim::record
