// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Writes CSV: a header of bare names, then numbers in the shortest form that reads back to the same
// double. Each row ends in "\n".
#include "base/number_text.hpp"
#include "file/atomic_file.hpp"
#include "file/format.hpp"

namespace bbsim::file {
namespace {

class CsvWriter final : public TableWriter {
 public:
  CsvWriter(const std::string& target, const std::vector<ColumnHeader>& headers) : file_(target) {
    file_.write(csv_header(headers) + '\n');
  }

  void append(std::span<const double* const> columns, std::size_t rows) override {
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t c = 0; c < columns.size(); ++c) {
        char* to = file_.reserve(longest_number + 1);
        to = write_number(to, columns[c][row]);
        *to++ = c + 1 < columns.size() ? ',' : '\n';
        file_.advance(to);
      }
    }
  }

  void finish(const Attributes& /*CSV cannot hold them*/) override { file_.commit(); }

 private:
  AtomicFile file_;
};

}  // namespace

std::string csv_header(const std::vector<ColumnHeader>& headers) {
  std::string line;
  for (const ColumnHeader& header : headers) {
    if (!line.empty()) line += ',';
    line += header.name;
  }
  return line;
}

std::unique_ptr<TableWriter> open_csv(const std::string& target,
                                      const std::vector<ColumnHeader>& headers) {
  return std::make_unique<CsvWriter>(target, headers);
}

}  // namespace bbsim::file
