// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "record/track/padded_rows.hpp"

#include "record/track/kernels/track_kernels.hpp"

namespace bbsim::record {

void PaddedRows::resize(std::size_t rows) {
  const std::size_t room = (rows + row_padding - 1) / row_padding * row_padding;
  if (room <= room_) return;
  data_.reset(static_cast<double*>(::operator new (room * sizeof(double), std::align_val_t{64})));
  room_ = room;
}

void PaddedRows::pad(std::size_t rows) {
  double* const values = data_.get();
  for (std::size_t i = rows; i % row_padding != 0; ++i) values[i] = values[rows - 1];
}

}  // namespace bbsim::record
