// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The HDF5 side of merge.hpp.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <iterator>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "file/hdf5_table.hpp"
#include "sweep/merge.hpp"

namespace bbsim::sweep {
namespace {

// Approximate limit for numbers of series in memory.
constexpr std::size_t most_numbers = std::size_t{1} << 19U;
constexpr std::size_t most_at_a_time = 1024;

constexpr const char* instruction_set = "instruction_set";

struct Hdf5Part {
  std::string file;
  file::Hdf5Head head;
  std::vector<file::InputTable> inputs;
  std::size_t first = 0;  // number of the first case
};

std::size_t rows_at_a_time(const std::vector<file::Hdf5Column>& columns) {
  std::size_t widest = 1;
  for (const file::Hdf5Column& column : columns) {
    if (column.kind == file::Hdf5Kind::series) widest = std::max(widest, column.width);
  }
  return std::clamp<std::size_t>(most_numbers / widest, 1, most_at_a_time);
}

std::size_t case_in(const std::string& file, double number) {
  if (is_whole(number, 0)) return static_cast<std::size_t>(number);
  throw InputError(
      file + ": found a case that is not a whole number; allowed: a file that bbsim sweep wrote");
}

file::Attributes without_instruction_set(const file::Attributes& all) {
  file::Attributes rest = all;
  std::erase_if(rest, [](const auto& attribute) { return attribute.first == instruction_set; });
  return rest;
}

InstructionSets instruction_sets_of(const std::vector<Hdf5Part>& parts) {
  InstructionSets all;
  for (const Hdf5Part& part : parts) {
    for (const auto& [name, value] : part.head.attributes) {
      if (name == instruction_set) all.insert(value.text());
    }
  }
  return all;
}

// Compares bits, so that equal NaNs count as equal.
bool same_data(const file::Table& a, const file::Table& b) {
  constexpr auto bits = [](double number) { return std::bit_cast<std::uint64_t>(number); };
  return std::ranges::equal(a.columns, b.columns, [&](auto& x, auto& y) {
    return x.name == y.name && std::ranges::equal(x.numbers, y.numbers, {}, bits, bits);
  });
}

// Whether the scenarios read the same tables.
bool same_inputs(const std::vector<file::InputTable>& a, const std::vector<file::InputTable>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const file::InputTable& first, const file::InputTable& second) {
                      return first.file == second.file && same_data(*first.data, *second.data);
                    });
}

Hdf5Part read_part(const std::string& file) {
  file::Hdf5TableReader table(file, 1);
  if (table.columns()[0].name != "case" || table.columns()[0].kind != file::Hdf5Kind::number) {
    throw InputError(file + ": found no column case first; allowed: a file that bbsim sweep wrote");
  }
  file::Hdf5Block row;
  const std::size_t first = table.read(row) ? case_in(file, row.values[0][0]) : 0;
  return {file, table.head(), table.read_inputs(), first};
}

// Returns the parts in the order of their cases.
std::vector<Hdf5Part> read_parts(const std::vector<std::string>& files) {
  std::vector<Hdf5Part> parts;
  std::ranges::transform(files, std::back_inserter(parts), read_part);
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Hdf5Part& a, const Hdf5Part& b) { return a.first < b.first; });
  return parts;
}

void check_same_sweep(const std::vector<Hdf5Part>& parts) {
  const Hdf5Part& model = parts.front();
  const file::Attributes common = without_instruction_set(model.head.attributes);
  for (const Hdf5Part& part : parts) {
    if (part.head.columns == model.head.columns && part.head.axes == model.head.axes &&
        without_instruction_set(part.head.attributes) == common &&
        same_inputs(part.inputs, model.inputs)) {
      continue;
    }
    throw InputError(part.file + ": found other columns or another scenario than in " + model.file +
                     "; allowed: parts of one sweep");
  }
}

}  // namespace

Merged merge_hdf5(const std::vector<std::string>& files, const std::string& target,
                  const std::atomic<bool>& stop) {
  const std::vector<Hdf5Part> parts = read_parts(files);
  check_same_sweep(parts);
  const Hdf5Part& model = parts.front();
  const InstructionSets instruction_sets = instruction_sets_of(parts);

  file::Hdf5TableWriter out(target, model.head.columns, model.head.axes);
  out.keep(model.inputs);
  Merged merged{0, false, note_on(instruction_sets)};
  file::Hdf5Block block;
  for (const Hdf5Part& part : parts) {
    file::Hdf5TableReader table(part.file, rows_at_a_time(model.head.columns));
    while (table.read(block)) {
      if (stop.load(std::memory_order_relaxed)) {
        merged.interrupted = true;
        return merged;
      }
      for (std::size_t i = 0; i < block.rows; ++i, ++merged.cases) {
        check_case(part.file, case_in(part.file, block.values[0][i]), merged.cases);
      }
      out.append(block);
    }
  }
  file::Attributes attributes = model.head.attributes;
  for (auto& [name, value] : attributes) {
    if (name == "cases") check_all_there(merged.cases, value.text());
    if (name == instruction_set) value = names_of(instruction_sets);
  }
  out.finish(attributes);
  return merged;
}

}  // namespace bbsim::sweep
