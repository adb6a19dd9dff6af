// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 files byte by byte, through the program's reader. HDF5 itself may fail on damaged files, the
// program may not.
#include <cstdlib>
#include <string>

#include "file/hdf5_table.hpp"
#include "file/table_writer.hpp"
#include "folder.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  setenv("BBSIM_MODULE_PATH", BBSIM_MODULE_FOLDER, 1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace bbsim_fuzz;
  static const InputFolder folder;
  static const std::string file = folder.path() / "damaged.h5";
  folder.put("damaged.h5", std::string(text_of(data, size)));
  may_refuse([&] { (void)bbsim::file::read_table(file); });
  may_refuse([&] {
    bbsim::file::Hdf5TableReader reader(file, {8, 8});
    bbsim::file::Hdf5Block block;
    reader.read(block);
  });
  return 0;
}
