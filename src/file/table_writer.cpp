// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/table_writer.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "file/atomic_file.hpp"

namespace bbsim::file {
namespace {

// A header of bare names, then numbers in the shortest form that reads back to the same double.
// Each row ends in "\n".
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

Format format_of(const std::string& file) {
  const std::string ending = lower_ending(file);
  if (ending == ".csv") return Format::csv;
  return ending == ".h5" || ending == ".hdf5" ? Format::hdf5 : Format::other;
}

std::string lower_ending(const std::string& file) {
  return lower(std::filesystem::path(file).extension().string());
}

void require_table_name(const std::string& target) {
  if (format_of(target) != Format::other || is_written_directly(target)) return;
  throw InputError("output file \"" + target +
                   "\": the name's ending picks the format and is one of .csv, .h5 and .hdf5; "
                   "\"-\" is CSV on standard output");
}

std::unique_ptr<TableWriter> open_table(const std::string& target,
                                        const std::vector<ColumnHeader>& headers) {
  require_table_name(target);
  const bool hdf5 = format_of(target) == Format::hdf5 && !is_written_directly(target);
  if (hdf5) return open_hdf5(target, headers);
  return std::make_unique<CsvWriter>(target, headers);
}

Table read_table(const std::string& file, const CsvChoice& choice) {
  if (const std::string ending = lower_ending(file); ending == ".yaml" || ending == ".yml") {
    throw InputError(file + ": is a scenario; allowed: a table, such as its result: bbsim run " +
                     shell_word(file) + " -o run.h5");
  }
  Table table = format_of(file) == Format::hdf5 ? read_hdf5(file) : read_csv(file, choice);
  table.file = file;
  return table;
}

}  // namespace bbsim::file
