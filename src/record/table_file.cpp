// Which format a file's name asks for.
#include <algorithm>
#include <cctype>
#include <filesystem>

#include "base/error.hpp"
#include "record/atomic_file.hpp"
#include "record/formats.hpp"
#include "record/table_writer.hpp"

namespace bbsim::record {
namespace {

std::string ending(const std::string& file) {
  std::string text = std::filesystem::path(file).extension();
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool is_hdf5(const std::string& file) {
  const std::string text = ending(file);
  return text == ".h5" || text == ".hdf5";
}

}  // namespace

std::unique_ptr<TableWriter> open_table(const std::string& target,
                                        const std::vector<ColumnHeader>& headers) {
  if (ending(target) == ".csv") return open_csv(target, headers);
  if (is_written_directly(target)) return open_csv(target, headers);
  if (is_hdf5(target)) return open_hdf5(target, headers);
  throw InputError("output file \"" + target +
                   "\": the name's ending picks the format and is one of .csv, .h5 and .hdf5; "
                   "\"-\" is CSV on standard output");
}

TableData read_table(const std::string& file) {
  return is_hdf5(file) ? read_hdf5(file) : read_csv(file);
}

}  // namespace bbsim::record
