// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/format.hpp"

#include <filesystem>

#include "base/error.hpp"
#include "base/text.hpp"
#include "file/atomic_file.hpp"

namespace bbsim::file {

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
  return hdf5 ? open_hdf5(target, headers) : open_csv(target, headers);
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
