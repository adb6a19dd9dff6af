#include "record/merge_hdf5.hpp"

#include <algorithm>

#include "base/error.hpp"
#include "record/case_table.hpp"

namespace bbsim::record {
namespace {

// Numbers of series in memory at a time, about.
constexpr std::size_t most_numbers = std::size_t{1} << 19U;
constexpr std::size_t most_rows = 1024;

struct Part {
  std::string file;
  CaseTableReader table;
  std::size_t first = 0;  // case
};

std::size_t rows_at_a_time(const std::vector<CaseColumn>& columns) {
  std::size_t widest = 1;
  for (const CaseColumn& column : columns) widest = std::max(widest, column.width);
  return std::clamp<std::size_t>(most_numbers / widest, 1, most_rows);
}

}  // namespace

std::size_t merge_hdf5(const std::vector<std::string>& files, const std::string& target) {
  std::vector<Part> parts;
  CaseBlock block;
  for (const std::string& file : files) {
    Part part{file, CaseTableReader(file), 0};
    if (part.table.columns().empty() || part.table.columns()[0].name != "case") {
      throw InputError(file + ": found no column case first; allowed: what bbsim sweep writes");
    }
    if (part.table.rows() > 0) {
      part.table.read(0, 1, block);
      part.first = static_cast<std::size_t>(block.values[0][0]);
    }
    parts.push_back(std::move(part));
  }
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.first < b.first; });

  const CaseTableReader& model = parts.front().table;
  CaseTableWriter out(target, model.columns(), model.axes());
  std::size_t next = 0;
  for (const Part& part : parts) {
    if (part.table.columns() != model.columns() || part.table.axes() != model.axes() ||
        part.table.attributes() != model.attributes()) {
      throw InputError(part.file + ": found other columns or another scenario than in " +
                       parts.front().file + "; allowed: parts of one sweep");
    }
    const std::size_t rows = rows_at_a_time(model.columns());
    for (std::size_t first = 0; first < part.table.rows(); first += rows) {
      part.table.read(first, rows, block);
      for (std::size_t i = 0; i < block.rows; ++i, ++next) {
        if (block.values[0][i] == static_cast<double>(next)) continue;
        throw InputError(part.file + ": found case " +
                         std::to_string(static_cast<std::size_t>(block.values[0][i])) +
                         " where case " + std::to_string(next) +
                         " should come; allowed: every case of the sweep once");
      }
      out.append(block);
    }
  }
  for (const auto& [name, value] : model.attributes()) {
    if (name != "cases" || value == std::to_string(next)) continue;
    throw InputError("found " + std::to_string(next) + " cases of " + value +
                     "; allowed: all parts of the sweep");
  }
  out.finish(model.attributes());
  return next;
}

}  // namespace bbsim::record
