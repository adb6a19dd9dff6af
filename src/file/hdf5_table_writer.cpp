// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Collects rows and writes them to an HDF5 file.
#include <algorithm>
#include <set>
#include <string_view>

#include "base/error.hpp"
#include "file/hdf5_file.hpp"
#include "file/hdf5_table.hpp"

namespace bbsim::file {
namespace {

// Rows per call of HDF5: fewer if rows are wide, and always a power of two. This makes the file's
// bytes independent of the caller's blocks.
constexpr std::size_t most_rows_at_once = 1024;
constexpr std::size_t most_bytes_at_once = std::size_t{8} * 1024 * 1024;

std::size_t rows_at_once(const std::vector<Hdf5Column>& columns) {
  std::size_t bytes = 0;  // of a row, without the text of strings
  for (const Hdf5Column& column : columns) {
    bytes += column.kind == Hdf5Kind::series
                 ? std::min(column.width, most_bytes_at_once) * sizeof(double)
             : column.kind == Hdf5Kind::text ? sizeof(std::string)
                                             : sizeof(double);
  }
  std::size_t rows = most_rows_at_once;
  while (rows > 1 && rows * bytes > most_bytes_at_once) rows /= 2;
  return rows;
}

// Whether the column holds case numbers, which are stored as integers.
bool is_case(const Hdf5Column& column) {
  return column.name == "case" && column.kind == Hdf5Kind::number;
}

// The column that serves as the scale of the rows, or the end.
auto find_scale(const std::vector<Hdf5Column>& columns) {
  const auto number = std::ranges::find_if(columns, is_case);
  if (number != columns.end()) return number;
  return std::ranges::find_if(columns, [](const Hdf5Column& column) {
    return column.name == "t" && column.kind == Hdf5Kind::number;
  });
}

bbsim_hdf5_kind kind_of(const Hdf5Column& column) {
  switch (column.kind) {
    case Hdf5Kind::text:
      return BBSIM_HDF5_TEXT;
    case Hdf5Kind::series:
      return BBSIM_HDF5_SERIES;
    default:
      return is_case(column) ? BBSIM_HDF5_INTEGER : BBSIM_HDF5_NUMBER;
  }
}

bbsim_hdf5_column described(const Hdf5Column& column, bbsim_hdf5_kind kind, std::size_t width,
                            bool is_scale = false, bool is_packed = false) {
  return {column.name.c_str(),
          column.unit.c_str(),
          column.meaning.c_str(),
          kind,
          width,
          is_scale,
          is_packed};
}

[[noreturn]] void refuse(const std::string& target, const std::string& reason) {
  throw OutputError("cannot write " + target + ": " + reason);
}

void check_layout(const std::string& target, const std::vector<Hdf5Column>& columns,
                  const std::vector<Hdf5Axis>& axes) {
  if (columns.empty()) refuse(target, "a table needs at least one column");
  std::set<std::string_view> names;
  for (const Hdf5Column& column : columns) {
    if (!names.insert(column.name).second) {
      refuse(target, "two columns are called " + column.name);
    }
    if (column.kind == Hdf5Kind::series && column.width == 0) {
      refuse(target, "the series " + column.name + " has no values");
    }
  }
  for (const auto& [axis, values] : axes) {
    if (!names.insert(axis.name).second) {
      refuse(target, "the axis " + axis.name + " has the name of a column or of another axis");
    }
  }
}

// Checks everything before it touches a file.
Hdf5Output open_output(const std::string& target, const std::vector<Hdf5Column>& columns,
                       const std::vector<Hdf5Axis>& axes, Durable durable) {
  check_layout(target, columns, axes);
  if (is_written_directly(target)) {
    refuse(target,
           "it is a device, a pipe or standard output, and HDF5 needs a regular file; name one");
  }
  const auto scale = find_scale(columns);
  const bool is_packed = std::ranges::any_of(columns, is_case);
  std::vector<bbsim_hdf5_column> described_columns;
  for (auto column = columns.begin(); column != columns.end(); ++column) {
    described_columns.push_back(described(*column, kind_of(*column),
                                          column->kind == Hdf5Kind::number ? 1 : column->width,
                                          column == scale, is_packed));
  }
  return {target, described_columns, durable};
}

}  // namespace

class Hdf5TableWriter::State {
 public:
  State(const std::string& target, const std::vector<Hdf5Column>& columns,
        const std::vector<Hdf5Axis>& axes, Durable durable)
      : target_(target),
        columns_(columns),
        rows_at_once_(rows_at_once(columns)),
        output_(open_output(target, columns, axes, durable)) {
    waiting_.values.resize(columns.size());
    waiting_.texts.resize(columns.size());
    for (const auto& [axis, values] : axes) {
      output_.write_axis(described(axis, BBSIM_HDF5_AXIS, values.size()), values.data());
    }
  }

  void append(const Hdf5Block& block) {
    check_shape(block);
    append(
        block.rows, [&block](std::size_t c) { return block.values[c].data(); },
        [&block](std::size_t c) { return block.texts[c].data(); });
  }

  void append(std::span<const double* const> columns, std::size_t rows) {
    const bool fits = columns.size() == columns_.size() &&
                      std::ranges::all_of(columns_, [](const Hdf5Column& column) {
                        return column.kind == Hdf5Kind::number;
                      });
    if (!fits) refuse_shape();
    append(
        rows, [columns](std::size_t c) { return columns[c]; },
        [](std::size_t) -> const std::string* { return nullptr; });
  }

  void add_column(const Hdf5Column& column, const std::vector<double>& values) {
    if (values.size() != rows_)
      refuse(target_, "a column does not have as many rows as the others");
    flush();
    output_.write_column(described(column, BBSIM_HDF5_NUMBER, 1), values.data());
  }

  void keep(const std::vector<InputTable>& inputs) { output_.write_inputs(inputs); }

  void finish(const Attributes& attributes) {
    flush();
    output_.finish(attributes);
  }

 private:
  void check_shape(const Hdf5Block& block) const {
    bool fits = block.values.size() == columns_.size() && block.texts.size() == columns_.size();
    for (std::size_t c = 0; fits && c < columns_.size(); ++c) {
      const bool text = columns_[c].kind == Hdf5Kind::text;
      fits = block.values[c].size() == (text ? 0 : block.rows * width_of(c)) &&
             block.texts[c].size() == (text ? block.rows : 0);
    }
    if (!fits) refuse_shape();
  }

  [[noreturn]] void refuse_shape() const {
    refuse(target_, "a block of rows does not have the shape of the columns");
  }

  [[nodiscard]] std::size_t width_of(std::size_t c) const {
    return columns_[c].kind == Hdf5Kind::series ? columns_[c].width : 1;
  }

  // numbers(c) and texts(c) point to the first row of column c.
  template <class Numbers, class Texts>
  void append(std::size_t rows, Numbers numbers, Texts texts) {
    for (std::size_t first = 0; first < rows;) {
      const std::size_t count = std::min(rows - first, rows_at_once_ - waiting_.rows);
      for (std::size_t c = 0; c < columns_.size(); ++c) {
        const std::size_t width = width_of(c);
        if (columns_[c].kind == Hdf5Kind::text) {
          waiting_.texts[c].insert(waiting_.texts[c].end(), texts(c) + first,
                                   texts(c) + first + count);
        } else {
          waiting_.values[c].insert(waiting_.values[c].end(), numbers(c) + first * width,
                                    numbers(c) + (first + count) * width);
        }
      }
      waiting_.rows += count;
      first += count;
      if (waiting_.rows == rows_at_once_) flush();
    }
    rows_ += rows;
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
  std::vector<Hdf5Column> columns_;
  std::size_t rows_at_once_, rows_ = 0;
  Hdf5Output output_;
  Hdf5Block waiting_;
};

Hdf5TableWriter::Hdf5TableWriter(const std::string& target, const std::vector<Hdf5Column>& columns,
                                 const std::vector<Hdf5Axis>& axes, Durable durable)
    : state_(std::make_unique<State>(target, columns, axes, durable)) {}
Hdf5TableWriter::~Hdf5TableWriter() = default;
Hdf5TableWriter::Hdf5TableWriter(Hdf5TableWriter&&) noexcept = default;
Hdf5TableWriter& Hdf5TableWriter::operator=(Hdf5TableWriter&&) noexcept = default;

void Hdf5TableWriter::append(const Hdf5Block& block) {
  state_->append(block);
}

void Hdf5TableWriter::append(std::span<const double* const> columns, std::size_t rows) {
  state_->append(columns, rows);
}

void Hdf5TableWriter::add_column(const Hdf5Column& column, const std::vector<double>& values) {
  state_->add_column(column, values);
}

void Hdf5TableWriter::keep(const std::vector<InputTable>& inputs) {
  state_->keep(inputs);
}

void Hdf5TableWriter::finish(const Attributes& attributes) {
  state_->finish(attributes);
}

}  // namespace bbsim::file
