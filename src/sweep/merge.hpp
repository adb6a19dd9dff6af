// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The parts of a sweep -> the file that one run of it would have written.
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

namespace bbsim::sweep {

struct Merged {
  std::size_t cases = 0;
  bool interrupted = false;  // nothing was written
  std::string note;          // what the user should know of the parts, a sentence; or empty
};

// Puts the parts, CSV or HDF5 alike, in the order of their cases and writes them to `target`, to
// the byte what a sweep without shards writes. Ends soon after `stop` becomes true.
//
// Throws InputError unless the parts have the same columns and together every case from 0 on once;
// parts that are named as of so many (-2of3) must be all there. What says of which sweep they are
// (the plan beside a CSV part, the attributes of an HDF5 part) must agree in all but the
// instruction set, which is noted. Throws OutputError.
[[nodiscard]] Merged merge_cases(const std::vector<std::string>& parts, const std::string& target,
                                 const std::atomic<bool>& stop);

// Where the plan of a CSV part is, if it has one.
[[nodiscard]] std::string plan_of_part(const std::string& part);

}  // namespace bbsim::sweep
