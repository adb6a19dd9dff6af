// HDF5 tables of numbers, as runs write them.
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "record/formats.hpp"
#include "record/hdf5_file.hpp"

namespace bbsim::record {
namespace {

// The texts of a ColumnHeader as C strings, which string_views need not be.
struct Header {
  std::string name, unit, description;
};

Hdf5Output open_output(const std::string& target, const std::vector<ColumnHeader>& headers) {
  std::vector<Header> texts;
  texts.reserve(headers.size());
  std::vector<bbsim_hdf5_column> columns;
  for (const ColumnHeader& header : headers) {
    const Header& text = texts.emplace_back(
        Header{std::string(header.name), std::string(header.unit), std::string(header.meaning)});
    columns.push_back({text.name.c_str(), text.unit.c_str(), text.description.c_str(),
                       text.name == "t" ? BBSIM_HDF5_SCALE : BBSIM_HDF5_NUMBER, 1});
  }
  return {target, columns};
}

class Hdf5Writer final : public TableWriter {
 public:
  Hdf5Writer(const std::string& target, const std::vector<ColumnHeader>& headers)
      : output_(open_output(target, headers)) {}

  void append(std::span<const double* const> columns, std::size_t rows) override {
    values_.clear();
    for (const double* column : columns) values_.push_back({column, nullptr});
    output_.append(values_.data(), rows);
  }

  void finish(const Attributes& attributes) override { output_.finish(attributes); }

 private:
  Hdf5Output output_;
  std::vector<bbsim_hdf5_values> values_;  // of the block that is written
};

// What a file tells of itself. Its functions are the module's: no exception may go through them.
struct Contents {
  struct Dataset {
    std::string name;
    bbsim_hdf5_kind kind;
    std::size_t rows;
  };
  std::vector<Dataset> datasets;

  static int add(void* context, const bbsim_hdf5_column* column, std::size_t rows) noexcept {
    try {
      static_cast<Contents*>(context)->datasets.push_back({column->name, column->kind, rows});
      return 0;
    } catch (const std::exception&) {
      return 1;
    }
  }
  static int skip(void* /*context*/, const bbsim_hdf5_attribute* /*attribute*/) { return 0; }
};

const char* why_no_column(bbsim_hdf5_kind kind) {
  switch (kind) {
    case BBSIM_HDF5_TEXT:
      return "text";
    case BBSIM_HDF5_SERIES:
      return "several numbers a row, in two dimensions";
    case BBSIM_HDF5_AXIS:
      return "the axis of other datasets";
    default:
      return nullptr;
  }
}

}  // namespace

std::unique_ptr<TableWriter> open_hdf5(const std::string& target,
                                       const std::vector<ColumnHeader>& headers) {
  return std::make_unique<Hdf5Writer>(target, headers);
}

TableData read_hdf5(const std::string& file) {
  Contents contents;
  const Hdf5Input input(file, {&contents, Contents::add, Contents::skip});
  TableData table;
  const auto& datasets = contents.datasets;
  if (datasets.empty()) input.fail("it holds no datasets at its root");
  for (const auto& [name, kind, rows] : datasets) {
    if (const char* held = why_no_column(kind)) {
      input.fail("dataset " + name + " is no column of numbers: it holds " + held);
    }
    if (rows != datasets[0].rows) {
      input.fail("dataset " + name + " has " + std::to_string(rows) + " rows, " + datasets[0].name +
                 " has " + std::to_string(datasets[0].rows) + "; all must have the same number");
    }
  }
  for (std::size_t d = 0; d < datasets.size(); ++d) {
    const auto& [name, kind, rows] = datasets[d];
    try {
      table.columns.emplace_back(rows);
    } catch (const std::exception&) {  // bad_alloc or length_error
      input.fail("no memory for the " + std::to_string(rows) + " rows of dataset " + name);
    }
    input.read_numbers(d, 0, rows, table.columns.back().data());
    table.names.push_back(name);
  }
  return table;
}

}  // namespace bbsim::record
