// Cases on their way to an HDF5 file.
#include <algorithm>
#include <set>
#include <string_view>

#include "base/error.hpp"
#include "file/case_table.hpp"
#include "file/hdf5_file.hpp"

namespace bbsim::file {
namespace {

// Rows are handed to HDF5 so many at a time, fewer if they are wide, always a power of two: that
// makes the file's bytes independent of the caller's blocks.
constexpr std::size_t most_rows_at_once = 1024;
constexpr std::size_t most_bytes_at_once = std::size_t{8} * 1024 * 1024;

std::size_t rows_at_once(const std::vector<CaseColumn>& columns) {
  std::size_t bytes = 0;  // of a row, strings not counted
  for (const CaseColumn& column : columns) {
    bytes += column.kind == CaseKind::series
                 ? std::min(column.width, most_bytes_at_once) * sizeof(double)
             : column.kind == CaseKind::text ? sizeof(std::string)
                                             : sizeof(double);
  }
  std::size_t rows = most_rows_at_once;
  while (rows > 1 && rows * bytes > most_bytes_at_once) rows /= 2;
  return rows;
}

// The number of a case: a whole one, and what the rows of all other columns are called by.
bool is_case(const CaseColumn& column) {
  return column.name == "case" && column.kind == CaseKind::number;
}

bbsim_hdf5_kind kind_of(const CaseColumn& column) {
  switch (column.kind) {
    case CaseKind::text:
      return BBSIM_HDF5_TEXT;
    case CaseKind::series:
      return BBSIM_HDF5_SERIES;
    default:
      return is_case(column) ? BBSIM_HDF5_INTEGER : BBSIM_HDF5_NUMBER;
  }
}

bbsim_hdf5_column described(const CaseColumn& column, bbsim_hdf5_kind kind, std::size_t width) {
  return {column.name.c_str(), column.unit.c_str(), column.meaning.c_str(), kind, width,
          is_case(column)};
}

[[noreturn]] void refuse(const std::string& target, const std::string& reason) {
  throw OutputError("cannot write " + target + ": " + reason);
}

void check_layout(const std::string& target, const std::vector<CaseColumn>& columns,
                  const std::vector<CaseAxis>& axes) {
  if (columns.empty()) refuse(target, "a table of cases needs at least one column");
  std::set<std::string_view> names;
  for (const CaseColumn& column : columns) {
    if (!names.insert(column.name).second) {
      refuse(target, "two columns are called " + column.name);
    }
    if (column.kind == CaseKind::series && column.width == 0) {
      refuse(target, "the series " + column.name + " has no values");
    }
  }
  for (const auto& [axis, values] : axes) {
    if (!names.insert(axis.name).second) {
      refuse(target, "the axis " + axis.name + " has the name of a column or of another axis");
    }
  }
}

// After the checks that come before any file is touched.
Hdf5Output open_output(const std::string& target, const std::vector<CaseColumn>& columns,
                       const std::vector<CaseAxis>& axes) {
  check_layout(target, columns, axes);
  if (is_written_directly(target)) {
    refuse(target,
           "it is a device, a pipe or standard output, and HDF5 needs a regular file; name one");
  }
  std::vector<bbsim_hdf5_column> described_columns;
  for (const CaseColumn& column : columns) {
    described_columns.push_back(
        described(column, kind_of(column), column.kind == CaseKind::series ? column.width : 1));
  }
  return {target, described_columns, Durable::yes};
}

}  // namespace

class CaseTableWriter::State {
 public:
  State(const std::string& target, const std::vector<CaseColumn>& columns,
        const std::vector<CaseAxis>& axes, const std::vector<InputTable>& inputs)
      : target_(target),
        columns_(columns),
        rows_at_once_(rows_at_once(columns)),
        output_(open_output(target, columns, axes)) {
    waiting_.values.resize(columns.size());
    waiting_.texts.resize(columns.size());
    for (const auto& [axis, values] : axes) {
      output_.write_axis(described(axis, BBSIM_HDF5_AXIS, values.size()), values.data());
    }
    output_.write_inputs(inputs);
  }

  void append(const CaseBlock& block) {
    check_shape(block);
    for (std::size_t first = 0; first < block.rows;) {
      const std::size_t count = std::min(block.rows - first, rows_at_once_ - waiting_.rows);
      gather(block, first, count);
      first += count;
      if (waiting_.rows == rows_at_once_) flush();
    }
  }

  void finish(const Attributes& attributes) {
    flush();
    output_.finish(attributes);
  }

 private:
  void check_shape(const CaseBlock& block) const {
    bool fits = block.values.size() == columns_.size() && block.texts.size() == columns_.size();
    for (std::size_t c = 0; fits && c < columns_.size(); ++c) {
      const bool text = columns_[c].kind == CaseKind::text;
      fits = block.values[c].size() == (text ? 0 : block.rows * width_of(c)) &&
             block.texts[c].size() == (text ? block.rows : 0);
    }
    if (!fits) refuse(target_, "a block of rows does not have the shape of the columns");
  }

  [[nodiscard]] std::size_t width_of(std::size_t c) const {
    return columns_[c].kind == CaseKind::series ? columns_[c].width : 1;
  }

  void gather(const CaseBlock& block, std::size_t first, std::size_t count) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const auto part = [&](const auto& from, auto& to, std::size_t width) {
        const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first * width);
        to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count * width));
      };
      if (columns_[c].kind == CaseKind::text) {
        part(block.texts[c], waiting_.texts[c], 1);
      } else {
        part(block.values[c], waiting_.values[c], width_of(c));
      }
    }
    waiting_.rows += count;
  }

  void flush() {
    std::vector<std::vector<const char*>> texts(columns_.size());
    std::vector<bbsim_hdf5_values> values;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      for (const std::string& text : waiting_.texts[c]) texts[c].push_back(text.c_str());
      values.push_back({waiting_.values[c].data(), texts[c].data()});
    }
    output_.append(values.data(), waiting_.rows);
    for (auto& column : waiting_.values) column.clear();
    for (auto& column : waiting_.texts) column.clear();
    waiting_.rows = 0;
  }

  std::string target_;
  std::vector<CaseColumn> columns_;
  std::size_t rows_at_once_;
  Hdf5Output output_;
  CaseBlock waiting_;
};

CaseTableWriter::CaseTableWriter(const std::string& target, const std::vector<CaseColumn>& columns,
                                 const std::vector<CaseAxis>& axes,
                                 const std::vector<InputTable>& inputs)
    : state_(std::make_unique<State>(target, columns, axes, inputs)) {}
CaseTableWriter::~CaseTableWriter() = default;
CaseTableWriter::CaseTableWriter(CaseTableWriter&&) noexcept = default;
CaseTableWriter& CaseTableWriter::operator=(CaseTableWriter&&) noexcept = default;

void CaseTableWriter::append(const CaseBlock& block) {
  state_->append(block);
}

void CaseTableWriter::finish(const Attributes& attributes) {
  state_->finish(attributes);
}

}  // namespace bbsim::file
