// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/run_state.hpp"

#include "base/archive.hpp"
#include "base/error.hpp"
#include "base/fnv1a.hpp"
#include "file/whole_file.hpp"

namespace bbsim::record {
namespace {

constexpr std::string_view magic = "bbsim run state 2\n";

template <class Archive>
void archive_of(Archive& archive, RunState& state) {
  archive(state.version, state.instruction_set, state.identity, state.gamma, state.endless,
          state.end, state.least_end, state.time, state.next_row, state.state);
  // A state is saved only after the first row.
  archive.require(state.next_row > 0 && is_finite(state.end, state.time) &&
                  is_number(state.least_end));
}

}  // namespace

std::string to_bytes(RunState state) {
  StateWriter writer;
  archive_of(writer, state);
  std::string bytes = std::string(magic) + writer.bytes();
  std::uint64_t sum = fnv1a(bytes);
  StateWriter end;
  end(sum);
  return bytes + end.bytes();
}

RunState read_state(const std::string& file) {
  const std::string bytes = file::read_whole(file, magic);
  if (!bytes.starts_with(magic)) {
    throw InputError(
        file + ": found no state of a run; allowed: a file that bbsim run --save-state wrote");
  }
  std::uint64_t sum = 0;
  const std::size_t size = bytes.size() < magic.size() + sizeof sum ? 0 : bytes.size() - sizeof sum;
  if (size > 0) {
    StateReader end(std::string_view(bytes).substr(size));
    end(sum);
  }
  if (size == 0 || sum != fnv1a(std::string_view(bytes).substr(0, size))) {
    throw InputError(file + ": is damaged: its checksum does not match its content");
  }
  try {
    RunState state;
    StateReader reader(std::string_view(bytes).substr(magic.size(), size - magic.size()));
    archive_of(reader, state);
    StateReader::require(reader.at_end() && !state.state.empty());
    return state;
  } catch (const StateFault& fault) {
    throw InputError(file + ": " + fault.what());
  }
}

}  // namespace bbsim::record
