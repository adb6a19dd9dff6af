// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/writer.hpp"

#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <set>

namespace bbsim::file::hdf5 {
namespace {

// 8 KiB of numbers: small enough for a common run of a thousand rows, large enough for long runs.
constexpr hsize_t rows_a_chunk = 1024;
// A chunk of a series has as many rows as fit into this: a power of two, at least one.
constexpr hsize_t bytes_a_series_chunk = hsize_t{128} * 1024;
// The largest chunk cache. Chunks are written once, from front to back, so it holds the last one
// only. Larger chunks than this need no cache, because they are written whole.
constexpr std::size_t largest_cache = std::size_t{1024} * 1024;

constexpr const char* making_scale = "making a dimension scale";
constexpr const char* writing_rows = "writing rows";

constexpr unsigned in_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

File create_file(const std::string& file) {
  const Properties creation(H5Pcreate(H5P_FILE_CREATE), "preparing the file");
  check(H5Pset_link_creation_order(creation, in_order), "preparing the file");
  check(H5Pset_attr_creation_order(creation, in_order), "preparing the file");
  // No timestamps, here and below, so that the same run gives the same bytes.
  check(H5Pset_obj_track_times(creation, false), "preparing the file");
  return {H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, file_access()), "creating the file"};
}

bool is_case(const Hdf5Column& column) {
  return column.name == "case" && column.kind == Hdf5Kind::number;
}

void check_layout(const std::vector<Hdf5Column>& columns, const std::vector<Hdf5Axis>& axes) {
  if (columns.empty()) throw Failure("a table needs at least one column");
  std::set<std::string> names;
  for (const Hdf5Column& column : columns) {
    if (!names.insert(dataset_name(column.name)).second) {
      throw Failure("two columns are called " + column.name);
    }
    if (column.kind == Hdf5Kind::series && column.width == 0) {
      throw Failure("the series " + column.name + " has no values");
    }
  }
  for (const auto& [axis, values] : axes) {
    if (!names.insert(dataset_name(axis.name)).second) {
      throw Failure("the axis " + axis.name + " has the name of a column or of another axis");
    }
  }
}

int rank_of(Hdf5Kind kind) {
  return kind == Hdf5Kind::series ? 2 : 1;
}

hsize_t rows_of_a_chunk(const Hdf5Column& column) {
  if (column.kind != Hdf5Kind::series) return rows_a_chunk;
  const hsize_t most = bytes_a_series_chunk / sizeof(double) / column.width;
  hsize_t rows = 1;
  while (2 * rows <= most) rows *= 2;
  return rows;
}

void describe(hid_t dataset, const Hdf5Column& column) {
  set_attribute(dataset, "unit", column.unit);
  if (!column.unit.empty()) set_attribute(dataset, "units", column.unit);  // for netCDF tools
  set_attribute(dataset, "description", column.meaning);
  if (dataset_name(column.name) != column.name) set_attribute(dataset, column_title, column.name);
}

bool is_of_fixed_length(Hdf5Kind kind, std::size_t width) {
  return kind == Hdf5Kind::text && width > 1;
}

Datatype type_of(const Hdf5Column& column, const char* doing) {
  if (is_of_fixed_length(column.kind, column.width)) return string_type_of(column.width);
  if (column.kind == Hdf5Kind::text) return string_type();
  return {H5Tcopy(is_case(column) ? H5T_STD_I64LE : H5T_IEEE_F64LE), doing};
}

// The lowest level of deflate: higher ones take longer and gain little on computed numbers.
constexpr unsigned least_deflation = 1;

// Shuffling puts equal bytes of similar numbers together, so that they compress better.
void pack(hid_t creation, const Hdf5Column& column, const char* doing) {
  if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0) return;
  if (!is_of_fixed_length(column.kind, column.width)) check(H5Pset_shuffle(creation), doing);
  check(H5Pset_deflate(creation, least_deflation), doing);
}

Dataset create_dataset(hid_t file, const Hdf5Column& column, bool is_packed) {
  constexpr const char* doing = "creating a dataset";
  const int rank = rank_of(column.kind);
  const std::array<hsize_t, 2> size = {0, column.width};
  const std::array<hsize_t, 2> most = {H5S_UNLIMITED, column.width};
  const std::array<hsize_t, 2> chunk = {rows_of_a_chunk(column), column.width};
  const Dataspace space(H5Screate_simple(rank, size.data(), most.data()), doing);
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE), doing);
  check(H5Pset_chunk(creation, rank, chunk.data()), doing);
  check(H5Pset_obj_track_times(creation, false), doing);
  if (is_packed) pack(creation, column, doing);

  const Datatype type = type_of(column, doing);
  constexpr std::size_t bytes_of_a_reference = 16;  // to a string of any length
  const bool of_any_length = check(H5Tis_variable_str(type), doing) > 0;
  const std::size_t bytes =
      of_any_length ? bytes_of_a_reference : H5Tget_size(type) * (rank == 2 ? column.width : 1);
  const Properties access(H5Pcreate(H5P_DATASET_ACCESS), doing);
  check(H5Pset_chunk_cache(access, 1, std::min<std::size_t>(chunk[0] * bytes, largest_cache), 1.0),
        doing);
  Dataset dataset(H5Dcreate2(file, dataset_name(column.name).c_str(), type, space, H5P_DEFAULT,
                             creation, access),
                  doing);
  describe(dataset, column);
  return dataset;
}

std::vector<char> side_by_side(const std::vector<std::string>& texts, std::size_t width) {
  std::vector<char> strings(texts.size() * width, '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (texts[i].size() > width) {
      throw Failure("writing rows: a text is longer than its column");
    }
    std::ranges::copy(texts[i], strings.data() + i * width);
  }
  return strings;
}

// Writes a dataset of fixed size at once.
Dataset write_numbers(hid_t place, const std::string& name, const std::vector<double>& values,
                      const char* doing) {
  const hsize_t size = values.size();
  const Dataspace space(H5Screate_simple(1, &size, nullptr), doing);
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE), doing);
  check(H5Pset_obj_track_times(creation, false), doing);
  Dataset dataset(
      H5Dcreate2(place, name.c_str(), H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
      doing);
  if (size > 0) {
    check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()),
          doing);
  }
  return dataset;
}

Group create_group(hid_t place, const std::string& name) {
  constexpr const char* doing = "creating a group";
  const Properties creation(H5Pcreate(H5P_GROUP_CREATE), doing);
  check(H5Pset_link_creation_order(creation, in_order), doing);
  check(H5Pset_obj_track_times(creation, false), doing);
  return {H5Gcreate2(place, name.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), doing};
}

// A name like `wanted` that HDF5 accepts and that is not in `taken`. Adds it to `taken`.
std::string free_name(const std::string& wanted, std::set<std::string>& taken) {
  std::string valid = dataset_name(wanted);
  if (valid.empty() || valid == ".") valid += '_';
  std::string name = valid;
  for (int i = 2; !taken.insert(name).second; ++i) name = valid + " (" + std::to_string(i) + ")";
  return name;
}

// "motion.csv" from "../tables/motion.csv".
std::string last_part(const std::string& file) {
  return file.substr(file.rfind('/') + 1);  // npos + 1 = 0: everything
}

}  // namespace

FileWriter::FileWriter(const std::string& file, const std::vector<Hdf5Column>& columns,
                       const std::vector<Hdf5Axis>& axes) {
  check_layout(columns, axes);
  file_ = create_file(file);
  const bool is_packed = std::ranges::any_of(columns, is_case);
  for (const Hdf5Column& column : columns) {
    columns_.push_back({create_dataset(file_, column, is_packed), column.kind, column.width});
  }
  attach_scale(columns);
  for (const auto& [axis, values] : axes) write_axis(axis, values);
}

void FileWriter::attach_scale(const std::vector<Hdf5Column>& columns) {
  auto scale = std::ranges::find_if(columns, is_case);
  if (scale == columns.end()) {
    scale = std::ranges::find_if(columns, [](const Hdf5Column& column) {
      return column.name == "t" && column.kind == Hdf5Kind::number;
    });
  }
  if (scale == columns.end()) return;
  scale_ = columns_[static_cast<std::size_t>(scale - columns.begin())].dataset;
  check(H5DSset_scale(scale_, scale->name.c_str()), making_scale);
  for (const Column& column : columns_) {
    if (column.dataset == scale_) continue;
    check(H5DSattach_scale(column.dataset, scale_, 0), making_scale);
  }
}

void FileWriter::write_axis(const Hdf5Column& axis, const std::vector<double>& values) {
  constexpr const char* doing = "writing an axis";
  const std::string name = dataset_name(axis.name);
  Dataset dataset = write_numbers(file_, name, values, doing);
  describe(dataset, axis);
  set_attribute(dataset, axis_mark, "series");
  check(H5DSset_scale(dataset, name.c_str()), making_scale);
  for (const Column& column : columns_) {
    if (column.kind != Hdf5Kind::series || column.width != values.size()) continue;
    check(H5DSattach_scale(column.dataset, dataset, 1), making_scale);
  }
  dataset.close_checked(doing);
}

void FileWriter::add_column(const Hdf5Column& column, const std::vector<double>& values) {
  constexpr const char* doing = "writing a column";
  Dataset dataset = write_numbers(file_, dataset_name(column.name), values, doing);
  describe(dataset, column);
  if (scale_ >= 0) check(H5DSattach_scale(dataset, scale_, 0), making_scale);
  dataset.close_checked(doing);
}

void FileWriter::keep(const std::vector<InputTable>& inputs) {
  constexpr const char* doing = "writing an input table";
  if (inputs.empty()) return;
  Group group = create_group(file_, inputs_group);
  std::set<std::string> taken;
  for (const auto& [file, data] : inputs) {
    Group table = create_group(group, free_name(last_part(file), taken));
    set_attribute(table, input_file, file);
    std::set<std::string> columns;
    for (const auto& column : data->columns) {
      Dataset dataset =
          write_numbers(table, free_name(column.name, columns), column.numbers, doing);
      set_attribute(dataset, column_title, column.name);
      dataset.close_checked(doing);
    }
    table.close_checked(doing);
  }
  group.close_checked("closing a group");
}

void FileWriter::append(const Hdf5Block& block) {
  if (block.rows == 0) return;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto& [dataset, kind, width] = columns_[c];
    const int rank = rank_of(kind);
    const std::array<hsize_t, 2> size = {rows_ + block.rows, width};
    const std::array<hsize_t, 2> first = {rows_, 0};
    const std::array<hsize_t, 2> count = {block.rows, width};
    check(H5Dset_extent(dataset, size.data()), writing_rows);
    const Dataspace memory(H5Screate_simple(rank, count.data(), nullptr), writing_rows);
    const Dataspace space(H5Dget_space(dataset), writing_rows);
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr),
          writing_rows);
    const auto write = [&, &to = dataset](hid_t type, const void* values) {
      check(H5Dwrite(to, type, memory, space, H5P_DEFAULT, values), writing_rows);
    };
    if (is_of_fixed_length(kind, width)) {
      write(string_type_of(width), side_by_side(block.texts[c], width).data());
    } else if (kind == Hdf5Kind::text) {
      std::vector<const char*> texts;
      for (const std::string& text : block.texts[c]) texts.push_back(text.c_str());
      write(string_type(), static_cast<const void*>(texts.data()));
    } else {
      write(H5T_NATIVE_DOUBLE, block.values[c].data());
    }
  }
  rows_ += block.rows;
}

void FileWriter::finish(const Attributes& attributes) {
  for (const auto& [name, value] : attributes) set_attribute(file_, name, value);
  for (Column& column : columns_) column.dataset.close_checked("closing a dataset");
  file_.close_checked("closing the file");
}

}  // namespace bbsim::file::hdf5
