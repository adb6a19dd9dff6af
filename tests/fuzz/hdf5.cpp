// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The HDF5 reader on valid files of all kinds (foreign_hdf5.hpp). HDF5 itself fails on damaged
// ones, which hdf5_file.cpp covers.
#include <cstdlib>
#include <string>
#include <vector>

#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "folder.hpp"
#include "foreign_hdf5.hpp"
#include "fuzz.hpp"

namespace {

using namespace bbsim_fuzz;
namespace file = bbsim::file;

void must_be_cases(const std::string& name) {
  constexpr std::size_t rows = 7;
  file::Hdf5TableReader reader(name, {rows, 3 * rows});
  must(!reader.columns().empty());
  file::Hdf5Block block;
  while (reader.read(block)) {
    must(block.rows <= rows);
    for (std::size_t c = 0; c < reader.columns().size(); ++c) {
      const file::Hdf5Column& column = reader.columns()[c];
      const bool text = column.kind == file::Hdf5Kind::text;
      must(block.texts[c].size() == (text ? block.rows : 0));
      must(block.values[c].size() == (text ? 0 : block.rows * column.width));
    }
  }
}

void must_be_a_table(const file::TableData& table) {
  must(!table.names.empty() && table.columns.size() == table.names.size());
  for (const std::vector<double>& column : table.columns)
    must(column.size() == table.columns[0].size());
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  setenv("BBSIM_MODULE_PATH", BBSIM_MODULE_FOLDER, 1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const InputFolder folder;
  static const std::string file = folder.path() / "foreign.h5";
  write_foreign_hdf5(file, data, size);
  may_refuse([&] { must_be_a_table(file::read_table(file)); });
  may_refuse([&] { must_be_cases(file); });
  return 0;
}
