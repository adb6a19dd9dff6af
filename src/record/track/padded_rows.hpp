// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Doubles, aligned and padded for the kernels.
#pragma once

#include <cstddef>
#include <memory>
#include <new>

namespace bbsim::record {

class PaddedRows {
 public:
  // Keeps the values only if there is room already.
  void resize(std::size_t rows);
  // Repeats the last of `rows` values in the padding.
  void pad(std::size_t rows);
  [[nodiscard]] double* data() { return data_.get(); }
  [[nodiscard]] const double* data() const { return data_.get(); }

 private:
  struct Free {
    void operator()(double* memory) const { ::operator delete (memory, std::align_val_t{64}); }
  };
  std::unique_ptr<double, Free> data_;
  std::size_t room_ = 0;
};

}  // namespace bbsim::record
