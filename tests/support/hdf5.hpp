// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// HDF5 itself, to look at what bbsim writes and to write what other programs write.
#pragma once

#include <hdf5.h>
#include <hdf5_hl.h>

#include <string>
#include <utility>
#include <vector>

// An object of HDF5 that is closed at the end.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

using Sizes = std::vector<hsize_t>;

inline Handle opened(const std::string& file, unsigned flags = H5F_ACC_RDONLY) {
  return {H5Fopen(file.c_str(), flags, H5P_DEFAULT), H5Fclose};
}

inline Handle created(const std::string& file) {
  return {H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, H5P_DEFAULT), H5Fclose};
}

inline Handle dataset_of(hid_t file, const std::string& name) {
  return {H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose};
}

inline Handle type_of(hid_t dataset) {
  return {H5Dget_type(dataset), H5Tclose};
}

inline Handle space_of(const Sizes& sizes) {
  return {sizes.empty() ? H5Screate(H5S_SCALAR)
                        : H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr),
          H5Sclose};
}

// Text of equal length, or of any.
inline Handle text_type(std::size_t length = H5T_VARIABLE) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, length);
  return type;
}

// A new dataset; `data` has elements of `type`.
inline Handle put_dataset(hid_t file, const std::string& name, hid_t type, const Sizes& sizes,
                          const void* data = nullptr, hid_t creation = H5P_DEFAULT) {
  Handle dataset(
      H5Dcreate2(file, name.c_str(), type, space_of(sizes), H5P_DEFAULT, creation, H5P_DEFAULT),
      H5Dclose);
  if (data != nullptr) H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data);
  return dataset;
}

inline void put_attribute(hid_t object, const std::string& name, hid_t type, const void* value) {
  const Handle attribute(
      H5Acreate2(object, name.c_str(), type, space_of({}), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  H5Awrite(attribute, type, value);
}
