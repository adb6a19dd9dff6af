#include "record/hdf5/writer.hpp"

#include <hdf5_hl.h>

#include <string_view>

#include "record/hdf5/descriptor_driver.hpp"

namespace bbsim::hdf5 {
namespace {

// 8 KiB: small enough for the common run of a thousand rows, large enough for long ones.
constexpr hsize_t rows_a_chunk = 1024;

constexpr unsigned in_order = H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED;

File create_file(int descriptor, int* system_error) {
  const Properties access(H5Pcreate(H5P_FILE_ACCESS), "preparing the file");
  use_descriptor(access, {descriptor, system_error});
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "preparing the file");
  const Properties creation(H5Pcreate(H5P_FILE_CREATE), "preparing the file");
  check(H5Pset_link_creation_order(creation, in_order), "preparing the file");
  check(H5Pset_attr_creation_order(creation, in_order), "preparing the file");
  // No times of day, here and below: the same run is to give the same bytes.
  check(H5Pset_obj_track_times(creation, false), "preparing the file");
  return {H5Fcreate("bbsim", H5F_ACC_TRUNC, creation, access), "creating the file"};
}

// A string of any length in UTF-8, as h5py writes it.
void set_attribute(hid_t object, const char* name, const char* value) {
  const Datatype type(H5Tcopy(H5T_C_S1), "writing an attribute");
  check(H5Tset_size(type, H5T_VARIABLE), "writing an attribute");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "writing an attribute");
  const Dataspace space(H5Screate(H5S_SCALAR), "writing an attribute");
  Attribute attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
                      "writing an attribute");
  check(H5Awrite(attribute, type, &value), "writing an attribute");
  attribute.close_checked("writing an attribute");
}

Dataset create_dataset(hid_t file, const bbsim_hdf5_column& column) {
  const hsize_t size = 0;
  const hsize_t most = H5S_UNLIMITED;
  const Dataspace space(H5Screate_simple(1, &size, &most), "creating a dataset");
  const Properties creation(H5Pcreate(H5P_DATASET_CREATE), "creating a dataset");
  check(H5Pset_chunk(creation, 1, &rows_a_chunk), "creating a dataset");
  check(H5Pset_obj_track_times(creation, false), "creating a dataset");
  Dataset dataset(
      H5Dcreate2(file, column.name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
      "creating a dataset");
  set_attribute(dataset, "unit", column.unit);
  set_attribute(dataset, "description", column.description);
  return dataset;
}

}  // namespace

Writer::Writer(int descriptor, std::span<const bbsim_hdf5_column> columns)
    : file_(create_file(descriptor, system_error_.get())) {
  hid_t time = -1;
  for (const bbsim_hdf5_column& column : columns) {
    datasets_.push_back(create_dataset(file_, column));
    if (std::string_view(column.name) == "t") time = datasets_.back();
  }
  if (time < 0) return;
  check(H5DSset_scale(time, "t"), "making t the dimension scale");
  for (const Dataset& dataset : datasets_) {
    if (dataset != time) check(H5DSattach_scale(dataset, time, 0), "attaching the scale t");
  }
}

void Writer::append(const double* const* columns, std::size_t rows) {
  if (rows == 0) return;
  const hsize_t count = rows;
  const hsize_t size = rows_ + count;
  const Dataspace memory(H5Screate_simple(1, &count, nullptr), "writing rows");
  for (std::size_t c = 0; c < datasets_.size(); ++c) {
    check(H5Dset_extent(datasets_[c], &size), "writing rows");
    const Dataspace space(H5Dget_space(datasets_[c]), "writing rows");
    check(H5Sselect_hyperslab(space, H5S_SELECT_SET, &rows_, nullptr, &count, nullptr),
          "writing rows");
    check(H5Dwrite(datasets_[c], H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, columns[c]),
          "writing rows");
  }
  rows_ = size;
}

void Writer::finish(std::span<const bbsim_hdf5_attribute> attributes) {
  for (const bbsim_hdf5_attribute& attribute : attributes) {
    set_attribute(file_, attribute.name, attribute.value);
  }
  for (Dataset& dataset : datasets_) dataset.close_checked("closing a dataset");
  file_.close_checked("closing the file");
}

}  // namespace bbsim::hdf5
