// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/reader.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include "base/text.hpp"

namespace bbsim::file::hdf5 {
namespace {

// The largest ratio of the declared size of a dataset to the file's: deflate packs at most 1032
// bytes into one. `slack` allows for some declared data that was never written.
constexpr std::uint64_t most_expansion = 1100;
constexpr std::uint64_t slack = 65536;  // bytes

constexpr const char* opening = "opening the file";
constexpr const char* listing = "listing the datasets";

File open_file(const std::string& file) {
  if (H5Fis_hdf5(file.c_str()) == 0) throw Failure("it is not an HDF5 file");
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, file_access()), opening};
}

std::uint64_t size_of(hid_t file) {
  hsize_t bytes = 0;
  check(H5Fget_filesize(file, &bytes), opening);
  return bytes;
}

// The order of links or attributes: by creation if the file records it, otherwise by name.
H5_index_t order_of(hid_t group, herr_t (*get_order)(hid_t, unsigned*)) {
  const Properties creation(H5Gget_create_plist(group), opening);
  unsigned flags = 0;
  check(get_order(creation, &flags), opening);
  return (flags & H5P_CRT_ORDER_TRACKED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

// Gets a name with two calls of call(buffer, size): for its length, then for the name.
template <class Call>
std::string name_from(Call call, const char* doing) {
  std::string name(static_cast<std::size_t>(check(call(nullptr, 0), doing)), '\0');
  check(call(name.data(), name.size() + 1), doing);
  return name;
}

// Access properties that follow links within the file but never into another file.
Properties within_file() {
  Properties access(H5Pcreate(H5P_LINK_ACCESS), opening);
  const auto refuse_all = [](const char*, const char*, const char*, const char*, unsigned*, hid_t,
                             void*) -> herr_t { return -1; };
  check(H5Pset_elink_cb(access, refuse_all, nullptr), opening);
  return access;
}

// The names of the links in a group. Throws Failure for a link to another file: this file must not
// make bbsim open others.
std::vector<std::string> links_of(hid_t group, const std::string& path) {
  const H5_index_t order = order_of(group, H5Pget_link_creation_order);
  H5G_info_t info{};
  check(H5Gget_info(group, &info), listing);
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    names.push_back(name_from(
        [&](char* to, std::size_t size) {
          return H5Lget_name_by_idx(group, ".", order, H5_ITER_INC, i, to, size, H5P_DEFAULT);
        },
        listing));
    H5L_info_t link{};
    check(H5Lget_info_by_idx(group, ".", order, H5_ITER_INC, i, &link, H5P_DEFAULT), listing);
    if (link.type == H5L_TYPE_HARD || link.type == H5L_TYPE_SOFT) continue;
    throw Failure(shown(path + names.back()) +
                  " is a link to another file; allowed: data in the file itself");
  }
  return names;
}

Attributes attributes_of(hid_t root) {
  constexpr const char* doing = "reading an attribute";
  const H5_index_t order = order_of(root, H5Pget_attr_creation_order);
  const int count = check(H5Aget_num_attrs(root), doing);
  Attributes attributes;
  for (int i = 0; i < count; ++i) {
    const Attribute attribute(H5Aopen_by_idx(root, ".", order, H5_ITER_INC, static_cast<hsize_t>(i),
                                             H5P_DEFAULT, H5P_DEFAULT),
                              doing);
    if (const auto value = value_of(attribute)) {
      const auto name = [&](char* to, std::size_t size) {
        return H5Aget_name(attribute, size, to);
      };
      attributes.emplace_back(name_from(name, doing), *value);
    }
  }
  return attributes;
}

std::string reading_of(const std::string& path) {
  return "reading dataset " + shown(path);
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Failure("dataset " + shown(path) + " is not a column: " + why);
}

// The longest fixed length that is reported. Longer strings count as strings of any length.
constexpr std::size_t longest_to_copy = 1024;

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result) ? std::numeric_limits<std::uint64_t>::max() : result;
}

// Whole rows of a dataset, in the file and in memory.
struct Selection {
  Dataspace file, memory;
};

Selection select(hid_t dataset, hsize_t first, hsize_t rows, const std::string& doing) {
  Selection result;
  result.file = Dataspace(H5Dget_space(dataset), doing);
  std::array<hsize_t, 2> count{};
  check(H5Sget_simple_extent_dims(result.file, count.data(), nullptr), doing);
  const std::array<hsize_t, 2> start = {first, 0};
  count[0] = rows;
  check(H5Sselect_hyperslab(result.file, H5S_SELECT_SET, start.data(), nullptr, count.data(),
                            nullptr),
        doing);
  const int rank = H5Sget_simple_extent_ndims(result.file);
  result.memory = Dataspace(H5Screate_simple(rank, count.data(), nullptr), doing);
  return result;
}

void read_numbers(hid_t dataset, std::size_t first, std::size_t rows, std::size_t width,
                  const std::string& doing, std::vector<double>& numbers) {
  numbers.resize(product(rows, width));
  if (numbers.empty()) return;
  const Selection selected = select(dataset, first, rows, doing);
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, selected.memory, selected.file, H5P_DEFAULT,
                numbers.data()),
        doing);
}

// The strings that HDF5 has allocated for a selection.
class Strings {
 public:
  Strings(hid_t type, hid_t space, std::size_t count)
      : type_(type), space_(space), texts_(count, nullptr) {}
  ~Strings() { H5Dvlen_reclaim(type_, space_, H5P_DEFAULT, data()); }
  Strings(const Strings&) = delete;
  Strings& operator=(const Strings&) = delete;

  [[nodiscard]] void* data() { return static_cast<void*>(texts_.data()); }
  [[nodiscard]] const std::vector<char*>& texts() const { return texts_; }

 private:
  hid_t type_, space_;
  std::vector<char*> texts_;
};

void read_texts(hid_t dataset, std::size_t first, std::size_t rows, const std::string& doing,
                std::vector<std::string>& texts) {
  if (rows == 0) return;
  const Datatype type(H5Dget_type(dataset), doing);  // HDF5 cannot convert character sets
  const Selection selected = select(dataset, first, rows, doing);
  const auto read = [&](void* to) {
    check(H5Dread(dataset, type, selected.memory, selected.file, H5P_DEFAULT, to), doing);
  };
  if (check(H5Tis_variable_str(type), doing) > 0) {
    Strings strings(type, selected.memory, rows);
    read(strings.data());
    std::ranges::transform(strings.texts(), std::back_inserter(texts),
                           [](const char* text) { return text == nullptr ? "" : text; });
    return;
  }
  const std::size_t size = H5Tget_size(type);
  std::vector<char> strings(rows * size);
  read(strings.data());
  for (std::size_t i = 0; i < rows; ++i) {
    const char* text = strings.data() + i * size;
    texts.emplace_back(text, std::find(text, text + size, '\0'));
  }
}

}  // namespace

FileReader::FileReader(const std::string& file, Hdf5Head& head)
    : file_(open_file(file)), bytes_(size_of(file_)) {
  const Group root(H5Gopen2(file_, "/", H5P_DEFAULT), opening);
  head.attributes = attributes_of(root);
  for (Column& column : columns_of(root, "")) {
    if (column.is_axis) {
      std::vector<double> values;
      read_numbers(column.dataset, 0, column.rows, 1, reading_of(column.path), values);
      head.axes.emplace_back(std::move(column.about), std::move(values));
    } else {
      head.columns.push_back(column.about);
      columns_.push_back(std::move(column));
    }
  }
  if (columns_.empty()) throw Failure("it holds no column at its root");
  head.rows = columns_[0].rows;
  for (const Column& column : columns_) {
    if (column.rows == head.rows) continue;
    throw Failure("dataset " + shown(column.path) + " has " + std::to_string(column.rows) +
                  " rows, " + shown(columns_[0].path) + " has " + std::to_string(head.rows) +
                  "; all must have the same number");
  }
}

std::vector<FileReader::Column> FileReader::columns_of(hid_t group, const std::string& path) const {
  std::vector<Column> columns;
  for (const std::string& name : links_of(group, path)) {
    const std::string doing = "opening " + shown(path + name);
    const Object object(H5Oopen(group, name.c_str(), within_file()), doing);
    if (H5Iget_type(object) != H5I_DATASET) continue;
    Column column = column_of(object, name, path + name);
    column.dataset = Dataset(H5Dopen2(group, name.c_str(), H5P_DEFAULT), doing);
    check_size(column);
    columns.push_back(std::move(column));
  }
  return columns;
}

FileReader::Column FileReader::column_of(hid_t dataset, const std::string& name,
                                         const std::string& path) const {
  const std::string doing = reading_of(path);
  const Dataspace space(H5Dget_space(dataset), doing);
  const Datatype type(H5Dget_type(dataset), doing);
  const H5T_class_t held = H5Tget_class(type);
  const int rank = check(H5Sget_simple_extent_ndims(space), doing);
  if (held != H5T_FLOAT && held != H5T_INTEGER && held != H5T_STRING) {
    refuse(path, "it must hold numbers or strings");
  }
  if (rank != 1 && (rank != 2 || held == H5T_STRING)) {
    refuse(path, "it has " + std::to_string(rank) + " dimensions; numbers may have 1 or 2, text 1");
  }
  const Properties creation(H5Dget_create_plist(dataset), doing);
  if (H5Pget_layout(creation) == H5D_VIRTUAL || check(H5Pget_external_count(creation), doing) > 0) {
    refuse(path, "its numbers are in other files; allowed: data in the file itself");
  }
  std::array<hsize_t, 2> size{};
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr), doing);
  const std::string title = text_of(dataset, column_title);
  Column column{{dataset_name(title) == name ? title : name, text_of(dataset, "unit"),
                 text_of(dataset, "description")},
                path,
                size[0]};
  if (rank == 2) {
    column.about.kind = Hdf5Kind::series;
    column.about.width = size[1];
  } else if (held != H5T_STRING) {
    column.is_axis = check(H5Aexists(dataset, axis_mark), doing) > 0;
  } else {
    column.about.kind = Hdf5Kind::text;
    const bool fixed = check(H5Tis_variable_str(type), doing) == 0;
    const std::size_t length = H5Tget_size(type);
    if (fixed && length <= longest_to_copy) column.about.width = length;
  }
  return column;
}

void FileReader::check_size(const Column& column) const {
  const Datatype type(H5Dget_type(column.dataset), reading_of(column.path));
  const std::size_t numbers = column.about.kind == Hdf5Kind::series ? column.about.width : 1;
  const std::uint64_t declared = product(product(column.rows, numbers), H5Tget_size(type));
  if (declared <= slack || declared / most_expansion <= bytes_) return;
  throw Failure("dataset " + shown(column.path) + " declares " + std::to_string(column.rows) +
                (column.rows == 1 ? " row" : " rows") +
                (numbers == 1 ? "" : " of " + std::to_string(numbers) + " numbers") + ", " +
                std::to_string(declared) + " bytes; the file has " + std::to_string(bytes_) +
                ": it is damaged, or the dataset was never filled");
}

void FileReader::read(std::size_t first, std::size_t rows, Hdf5Block& into) const {
  into = {rows, std::vector<std::vector<double>>(columns_.size()),
          std::vector<std::vector<std::string>>(columns_.size())};
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto& [about, path, all, is_axis, dataset] = columns_[c];
    if (about.kind == Hdf5Kind::text) {
      read_texts(dataset, first, rows, reading_of(path), into.texts[c]);
    } else {
      const std::size_t width = about.kind == Hdf5Kind::series ? about.width : 1;
      read_numbers(dataset, first, rows, width, reading_of(path), into.values[c]);
    }
  }
}

std::vector<InputTable> FileReader::read_inputs() const {
  std::vector<InputTable> inputs;
  if (check(H5Lexists(file_, inputs_group, H5P_DEFAULT), listing) == 0) return inputs;
  const Object group(H5Oopen(file_, inputs_group, within_file()), listing);
  if (H5Iget_type(group) != H5I_GROUP) return inputs;  // a column with this name
  const std::string path = std::string(inputs_group) + "/";
  for (const std::string& name : links_of(group, path)) {
    const Object table(H5Oopen(group, name.c_str(), within_file()), listing);
    if (H5Iget_type(table) != H5I_GROUP) continue;
    const std::string file = text_of(table, input_file);
    Table data;
    for (const Column& column : columns_of(table, path + name + "/")) {
      const std::string title = text_of(column.dataset, column_title);
      if (column.about.kind != Hdf5Kind::number ||
          (!data.columns.empty() && column.rows != data.columns[0].numbers.size())) {
        throw Failure("input table " + shown(file) + " is not a table of numbers");
      }
      data.columns.push_back({title.empty() ? column.about.name : title, {}});
      read_numbers(column.dataset, 0, column.rows, 1, reading_of(column.path),
                   data.columns.back().numbers);
    }
    inputs.push_back({file.empty() ? name : file, std::make_shared<Table>(std::move(data))});
  }
  return inputs;
}

}  // namespace bbsim::file::hdf5
