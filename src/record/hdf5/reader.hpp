// Reads the datasets of a file's root group, some rows at a time.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "record/hdf5/handle.hpp"
#include "record/hdf5/interface.h"

namespace bbsim::hdf5 {

// Every function may throw Failure.
class Reader {
 public:
  Reader(const char* path, const bbsim_hdf5_contents& contents);

  void read_numbers(std::size_t dataset, std::size_t first, std::size_t rows, double* to) const;
  void read_texts(std::size_t dataset, std::size_t first, std::size_t rows,
                  const bbsim_hdf5_texts& to) const;

 private:
  void tell_datasets(hid_t root, const bbsim_hdf5_contents& contents);

  struct Named {
    std::string name;
    Dataset dataset;
  };

  File file_;
  std::vector<Named> datasets_;
};

}  // namespace bbsim::hdf5
