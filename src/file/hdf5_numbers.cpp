// HDF5 tables of numbers, as runs write them.
#include "base/error.hpp"
#include "base/shown.hpp"
#include "file/formats.hpp"
#include "file/hdf5_file.hpp"
#include "file/hdf5_input.hpp"

namespace bbsim::file {
namespace {

// The texts of a ColumnHeader as C strings, which string_views need not be.
struct Header {
  std::string name, unit, description;

  explicit Header(const ColumnHeader& header)
      : name(header.name), unit(header.unit), description(header.meaning) {}

  [[nodiscard]] bbsim_hdf5_column column() const {
    return {name.c_str(), unit.c_str(), description.c_str(), BBSIM_HDF5_NUMBER, 1, name == "t"};
  }
};

Hdf5Output open_output(const std::string& target, const std::vector<ColumnHeader>& headers) {
  const std::vector<Header> texts(headers.begin(), headers.end());
  std::vector<bbsim_hdf5_column> columns;
  for (const Header& text : texts) columns.push_back(text.column());
  return {target, columns};
}

class Hdf5Writer final : public TableWriter {
 public:
  Hdf5Writer(const std::string& target, const std::vector<ColumnHeader>& headers)
      : output_(open_output(target, headers)) {}

  void append(std::span<const double* const> columns, std::size_t rows) override {
    rows_ += rows;
    values_.clear();
    for (const double* column : columns) values_.push_back({column, nullptr});
    output_.append(values_.data(), rows);
  }

  void add_column(const ColumnHeader& header, const std::vector<double>& values) override {
    if (values.size() != rows_) throw OutputError("a column has not as many rows as the others");
    output_.write_column(Header(header).column(), values.data());
  }

  void keep(const std::vector<InputTable>& inputs) override { output_.write_inputs(inputs); }

  void finish(const Attributes& attributes) override { output_.finish(attributes); }

 private:
  Hdf5Output output_;
  std::vector<bbsim_hdf5_values> values_;  // of the block that is written
  std::size_t rows_ = 0;
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
  const Hdf5Input input(file);
  const std::span<const Hdf5Dataset> datasets(input.datasets().data(), input.root_datasets());
  if (datasets.empty()) input.fail("it holds no datasets at its root");
  const Hdf5Dataset& first = datasets.front();
  TableData table;
  for (const Hdf5Dataset& dataset : datasets) {
    if (const char* held = why_no_column(dataset.kind)) {
      input.fail("dataset " + shown(dataset.name) + " is no column of numbers: it holds " + held);
    }
    if (dataset.rows != first.rows) {
      input.fail("dataset " + shown(dataset.name) + " has " + std::to_string(dataset.rows) +
                 " rows, " + shown(first.name) + " has " + std::to_string(first.rows) +
                 "; all must have the same number");
    }
    table.names.push_back(dataset.name);
  }
  table.columns.resize(datasets.size());
  std::vector<Hdf5Wanted> wanted;
  for (std::size_t d = 0; d < datasets.size(); ++d) wanted.push_back({d, &table.columns[d]});
  input.read(0, first.rows, wanted);
  return table;
}

}  // namespace bbsim::file
