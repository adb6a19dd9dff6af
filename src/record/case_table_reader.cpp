// Cases read back, some rows at a time.
#include <algorithm>
#include <new>
#include <stdexcept>

#include "base/error.hpp"
#include "record/case_table.hpp"
#include "record/hdf5_file.hpp"

namespace bbsim::record {
namespace {

struct Dataset {
  CaseColumn column;
  std::size_t rows = 0;
  bool is_axis = false;
};

CaseKind kind_of(bbsim_hdf5_kind kind) {
  switch (kind) {
    case BBSIM_HDF5_TEXT:
      return CaseKind::text;
    case BBSIM_HDF5_SERIES:
      return CaseKind::series;
    default:
      return CaseKind::number;
  }
}

// Whether `action` found the memory that it needs: no exception may go back through the module.
template <class Action>
bool found_memory(Action action) noexcept {
  try {
    action();
    return true;
  } catch (const std::exception&) {  // bad_alloc or length_error
    return false;
  }
}

// What a file tells of itself, through the module's functions.
struct Contents {
  std::vector<Dataset> datasets;
  Attributes attributes;

  static int add_dataset(void* context, const bbsim_hdf5_column* column, std::size_t rows) {
    const bool found = found_memory([&] {
      const bool is_axis = column->kind == BBSIM_HDF5_AXIS;
      static_cast<Contents*>(context)->datasets.push_back(
          {{column->name, column->unit, column->description, kind_of(column->kind),
            is_axis ? 1 : column->width},
           rows,
           is_axis});
    });
    return found ? 0 : 1;
  }

  static int add_attribute(void* context, const bbsim_hdf5_attribute* attribute) {
    const bool found = found_memory([&] {
      static_cast<Contents*>(context)->attributes.emplace_back(attribute->name, attribute->value);
    });
    return found ? 0 : 1;
  }
};

int add_text(void* context, const char* text) {
  auto& texts = *static_cast<std::vector<std::string>*>(context);
  return found_memory([&] { texts.emplace_back(text); }) ? 0 : 1;
}

}  // namespace

class CaseTableReader::State {
 public:
  explicit State(const std::string& file)
      : input_(file, {&contents_, Contents::add_dataset, Contents::add_attribute}) {
    for (std::size_t d = 0; d < contents_.datasets.size(); ++d) {
      const auto& [column, rows, is_axis] = contents_.datasets[d];
      if (is_axis) {
        axes_.emplace_back(column, std::vector<double>());
        read_values(d, 0, rows, 1, axes_.back().second);
        continue;
      }
      if (!columns_.empty() && rows != rows_) {
        input_.fail("dataset " + column.name + " has " + std::to_string(rows) + " rows, " +
                    columns_[0].name + " has " + std::to_string(rows_) +
                    "; all must have the same number");
      }
      rows_ = rows;
      columns_.push_back(column);
      datasets_.push_back(d);
    }
    if (columns_.empty()) input_.fail("it holds no column of cases at its root");
  }

  [[nodiscard]] const std::vector<CaseColumn>& columns() const { return columns_; }
  [[nodiscard]] const std::vector<CaseAxis>& axes() const { return axes_; }
  [[nodiscard]] const Attributes& attributes() const { return contents_.attributes; }
  [[nodiscard]] std::size_t rows() const { return rows_; }

  void read(std::size_t first, std::size_t count, CaseBlock& into) const {
    count = first < rows_ ? std::min(count, rows_ - first) : 0;
    into.rows = count;
    into.values.resize(columns_.size());
    into.texts.resize(columns_.size());
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      into.texts[c].clear();
      into.values[c].clear();
      if (columns_[c].kind == CaseKind::text) {
        input_.read_texts(datasets_[c], first, count, {&into.texts[c], add_text});
      } else {
        read_values(datasets_[c], first, count, columns_[c].width, into.values[c]);
      }
    }
  }

 private:
  void read_values(std::size_t dataset, std::size_t first, std::size_t rows, std::size_t width,
                   std::vector<double>& into) const {
    const bool countable = width == 0 || rows <= into.max_size() / width;
    if (!countable || !found_memory([&] { into.resize(rows * width); })) {
      input_.fail("no memory for " + std::to_string(rows) + " rows of dataset " +
                  contents_.datasets[dataset].column.name);
    }
    input_.read_numbers(dataset, first, rows, into.data());
  }

  Contents contents_;  // filled by input_
  Hdf5Input input_;
  std::vector<CaseColumn> columns_;
  std::vector<std::size_t> datasets_;  // of each column, as the module counts them
  std::vector<CaseAxis> axes_;
  std::size_t rows_ = 0;
};

CaseTableReader::CaseTableReader(const std::string& file) : state_(std::make_unique<State>(file)) {}
CaseTableReader::~CaseTableReader() = default;
CaseTableReader::CaseTableReader(CaseTableReader&&) noexcept = default;
CaseTableReader& CaseTableReader::operator=(CaseTableReader&&) noexcept = default;

const std::vector<CaseColumn>& CaseTableReader::columns() const {
  return state_->columns();
}
const std::vector<CaseAxis>& CaseTableReader::axes() const {
  return state_->axes();
}
const Attributes& CaseTableReader::attributes() const {
  return state_->attributes();
}
std::size_t CaseTableReader::rows() const {
  return state_->rows();
}

void CaseTableReader::read(std::size_t first, std::size_t count, CaseBlock& into) const {
  state_->read(first, count, into);
}

}  // namespace bbsim::record
