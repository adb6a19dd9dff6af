// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/writer.hpp"

#include <hdf5_hl.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "file/hdf5/attributes.hpp"
#include "file/hdf5/descriptor_driver.hpp"
#include "file/hdf5/layout.hpp"

namespace bbsim::hdf5 {
namespace {

// 8 KiB of numbers: small enough for a common run of a thousand rows, large enough for long runs.
constexpr hsize_t rows_a_chunk = 1024;
// A chunk of a series has as many rows as fit into this: a power of two, at least one.
constexpr hsize_t bytes_a_series_chunk = hsize_t{128} * 1024;
// The largest chunk cache. Chunks are written once, from front to back, so it holds the last one
// only. Larger chunks than this need no cache, because they are written whole.
constexpr std::size_t largest_cache = std::size_t{1024} * 1024;

constexpr const char* making_scale = "making a dimension scale";

constexpr unsigned in_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

File create_file(int descriptor, int* system_error) {
  const Properties access(H5Pcreate(H5P_FILE_ACCESS), "preparing the file");
  use_descriptor(access, {descriptor, system_error});
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "preparing the file");
  const Properties creation(H5Pcreate(H5P_FILE_CREATE), "preparing the file");
  check(H5Pset_link_creation_order(creation, in_order), "preparing the file");
  check(H5Pset_attr_creation_order(creation, in_order), "preparing the file");
  // No timestamps, here and below, so that the same run gives the same bytes.
  check(H5Pset_obj_track_times(creation, false), "preparing the file");
  return {H5Fcreate("bbsim", H5F_ACC_TRUNC, creation, access), "creating the file"};
}

hsize_t rows_of_a_chunk(const bbsim_hdf5_column& column) {
  if (column.kind != BBSIM_HDF5_SERIES) return rows_a_chunk;
  const hsize_t most = bytes_a_series_chunk / sizeof(double) / column.width;
  hsize_t rows = 1;
  while (2 * rows <= most) rows *= 2;
  return rows;
}

void describe(hid_t dataset, const bbsim_hdf5_column& column) {
  set_attribute(dataset, "unit", column.unit);
  // netCDF tools expect this name.
  if (*column.unit != '\0') set_attribute(dataset, "units", column.unit);
  set_attribute(dataset, "description", column.description);
}

hid_t number_type(const bbsim_hdf5_column& column) {
  return column.kind == BBSIM_HDF5_INTEGER ? H5T_STD_I64LE : H5T_IEEE_F64LE;
}

bool is_of_fixed_length(bbsim_hdf5_kind kind, std::size_t width) {
  return kind == BBSIM_HDF5_TEXT && width > 1;
}

// The lowest level of deflate: higher ones take longer and gain little on computed numbers.
constexpr unsigned least_deflation = 1;

// Shuffling puts equal bytes of similar numbers together, so that they compress better.
void pack(hid_t creation, const bbsim_hdf5_column& column, const char* doing) {
  if (H5Zfilter_avail(H5Z_FILTER_DEFLATE) <= 0) return;
  if (!is_of_fixed_length(column.kind, column.width)) check(H5Pset_shuffle(creation), doing);
  check(H5Pset_deflate(creation, least_deflation), doing);
}

Dataset create_dataset(hid_t file, const bbsim_hdf5_column& column) {
  constexpr const char* doing = "creating a dataset";
  const bool is_text = column.kind == BBSIM_HDF5_TEXT;
  const bool is_fixed = is_of_fixed_length(column.kind, column.width);
  const int rank = column.kind == BBSIM_HDF5_SERIES ? 2 : 1;
  const std::array<hsize_t, 2> size = {0, column.width};
  const std::array<hsize_t, 2> most = {H5S_UNLIMITED, column.width};
  const std::array<hsize_t, 2> chunk = {rows_of_a_chunk(column), column.width};
  const Dataspace space(H5Screate_simple(rank, size.data(), most.data()), doing);
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE), doing);
  check(H5Pset_chunk(creation, rank, chunk.data()), doing);
  check(H5Pset_obj_track_times(creation, false), doing);
  if (column.is_packed != 0) pack(creation, column, doing);

  constexpr std::size_t bytes_of_a_reference = 16;  // to a string of any length
  const std::size_t bytes = is_fixed  ? column.width
                            : is_text ? bytes_of_a_reference
                                      : sizeof(double) * column.width;
  const Properties access(H5Pcreate(H5P_DATASET_ACCESS), doing);
  check(H5Pset_chunk_cache(access, 1, std::min<std::size_t>(chunk[0] * bytes, largest_cache), 1.0),
        doing);

  const Datatype type = is_fixed  ? string_type_of(column.width)
                        : is_text ? string_type()
                                  : Datatype(H5Tcopy(number_type(column)), doing);
  Dataset dataset(H5Dcreate2(file, column.name, type, space, H5P_DEFAULT, creation, access), doing);
  describe(dataset, column);
  return dataset;
}

void set_root_attribute(hid_t file, const bbsim_hdf5_attribute& attribute) {
  switch (attribute.kind) {
    case BBSIM_HDF5_TEXT_VALUE:
      return set_attribute(file, attribute.name, attribute.text);
    case BBSIM_HDF5_REAL_VALUE:
      return set_attribute(file, attribute.name, attribute.real);
    case BBSIM_HDF5_INTEGER_VALUE:
      return set_attribute(file, attribute.name, attribute.integer);
  }
}

std::vector<char> side_by_side(const char* const* texts, std::size_t rows, std::size_t width) {
  std::vector<char> strings(rows * width, '\0');
  for (std::size_t i = 0; i < rows; ++i) {
    const std::size_t size = std::strlen(texts[i]);
    if (size > width) throw Failure("writing rows: a text is longer than its column");
    std::copy_n(texts[i], size, strings.data() + i * width);
  }
  return strings;
}

// Writes a dataset of fixed size at once.
Dataset write_numbers(hid_t place, const char* name, const double* values, std::size_t count,
                      const char* doing) {
  const hsize_t size = count;
  const Dataspace space(H5Screate_simple(1, &size, nullptr), doing);
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE), doing);
  check(H5Pset_obj_track_times(creation, false), doing);
  Dataset dataset(
      H5Dcreate2(place, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT), doing);
  if (size > 0) {
    check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), doing);
  }
  return dataset;
}

Group create_group(hid_t place, const char* name) {
  constexpr const char* doing = "creating a group";
  const Properties creation(H5Pcreate(H5P_GROUP_CREATE), doing);
  check(H5Pset_link_creation_order(creation, in_order), doing);
  check(H5Pset_obj_track_times(creation, false), doing);
  return {H5Gcreate2(place, name, H5P_DEFAULT, creation, H5P_DEFAULT), doing};
}

}  // namespace

void Writer::start(int descriptor, std::span<const bbsim_hdf5_column> columns) {
  file_ = create_file(descriptor, system_error_.get());
  for (const bbsim_hdf5_column& column : columns) {
    columns_.push_back({create_dataset(file_, column), column.kind, column.width});
  }
  attach_scale(columns);
}

void Writer::attach_scale(std::span<const bbsim_hdf5_column> columns) {
  const auto scale = std::find_if(columns.begin(), columns.end(),
                                  [](const auto& column) { return column.is_scale != 0; });
  if (scale == columns.end()) return;
  scale_ = columns_[static_cast<std::size_t>(scale - columns.begin())].dataset;
  check(H5DSset_scale(scale_, scale->name), making_scale);
  for (const Column& column : columns_) {
    if (column.dataset == scale_) continue;
    check(H5DSattach_scale(column.dataset, scale_, 0), making_scale);
  }
}

void Writer::write_axis(const bbsim_hdf5_column& axis, const double* values) {
  constexpr const char* doing = "writing an axis";
  Dataset dataset = write_numbers(file_, axis.name, values, axis.width, doing);
  describe(dataset, axis);
  set_attribute(dataset, axis_mark, "series");  // distinguishes it from a column
  check(H5DSset_scale(dataset, axis.name), making_scale);
  for (const Column& column : columns_) {
    if (column.kind != BBSIM_HDF5_SERIES || column.width != axis.width) continue;
    check(H5DSattach_scale(column.dataset, dataset, 1), making_scale);
  }
  dataset.close_checked(doing);
}

void Writer::write_column(const bbsim_hdf5_column& column, const double* values) {
  constexpr const char* doing = "writing a column";
  Dataset dataset = write_numbers(file_, column.name, values, rows_, doing);
  describe(dataset, column);
  if (scale_ >= 0) check(H5DSattach_scale(dataset, scale_, 0), making_scale);
  dataset.close_checked(doing);
}

void Writer::write_input(const char* name, const char* file,
                         std::span<const bbsim_hdf5_input_column> columns, std::size_t rows) {
  constexpr const char* doing = "writing an input table";
  if (inputs_ < 0) inputs_ = create_group(file_, inputs_group);
  Group table = create_group(inputs_, name);
  set_attribute(table, input_file, file);
  for (const bbsim_hdf5_input_column& column : columns) {
    Dataset dataset = write_numbers(table, column.name, column.numbers, rows, doing);
    set_attribute(dataset, input_title, column.title);
    dataset.close_checked(doing);
  }
  table.close_checked(doing);
}

void Writer::append(const bbsim_hdf5_values* columns, std::size_t rows) {
  if (rows == 0) return;
  const Datatype string = string_type();
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const auto& [dataset, kind, width] = columns_[c];
    const int rank = kind == BBSIM_HDF5_SERIES ? 2 : 1;
    const std::array<hsize_t, 2> size = {rows_ + rows, width};
    const std::array<hsize_t, 2> first = {rows_, 0};
    const std::array<hsize_t, 2> count = {rows, width};
    check(H5Dset_extent(dataset, size.data()), "writing rows");
    const Dataspace memory(H5Screate_simple(rank, count.data(), nullptr), "writing rows");
    const Dataspace space(H5Dget_space(dataset), "writing rows");
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, first.data(), nullptr, count.data(), nullptr),
          "writing rows");
    if (is_of_fixed_length(kind, width)) {
      const std::vector<char> strings = side_by_side(columns[c].texts, rows, width);
      check(H5Dwrite(dataset, string_type_of(width), memory, space, H5P_DEFAULT, strings.data()),
            "writing rows");
    } else if (kind == BBSIM_HDF5_TEXT) {
      check(H5Dwrite(dataset, string, memory, space, H5P_DEFAULT,
                     static_cast<const void*>(columns[c].texts)),
            "writing rows");
    } else {
      check(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, columns[c].numbers),
            "writing rows");
    }
  }
  rows_ += rows;
}

void Writer::finish(std::span<const bbsim_hdf5_attribute> attributes) {
  for (const bbsim_hdf5_attribute& attribute : attributes) set_root_attribute(file_, attribute);
  if (inputs_ >= 0) inputs_.close_checked("closing a group");
  for (Column& column : columns_) column.dataset.close_checked("closing a dataset");
  file_.close_checked("closing the file");
}

}  // namespace bbsim::hdf5
