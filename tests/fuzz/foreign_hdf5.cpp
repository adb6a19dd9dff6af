// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "foreign_hdf5.hpp"

#include <fuzzer/FuzzedDataProvider.h>
#include <hdf5.h>

#include <algorithm>
#include <vector>

namespace bbsim_fuzz {
namespace {

// Any identifier; negative if HDF5 refused, in which case later calls with it are refused too.
class Id {
 public:
  explicit Id(hid_t id) : id_(id) {}
  Id(Id&& other) noexcept : id_(other.id_) { other.id_ = -1; }
  ~Id() {
    if (id_ >= 0) H5Idec_ref(id_);
  }
  Id& operator=(Id&&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
};

// Names that the program looks for, or arbitrary ones.
std::string name_from(FuzzedDataProvider& bytes) {
  static const std::vector<std::string> known{
      "t",    "x",    "case",        "status",         "unit",           "units", "description",
      "axis", "NAME", "CLASS",       "DIMENSION_LIST", "REFERENCE_LIST", "error", "inputs",
      "rows", "y",    "end_time",    "scenario_text",  "inputs/a.csv",   "vary",  "reason",
      "rtol", "seed", "instruction", "version",        "samples",        "cases", "scenario"};
  const std::size_t pick = bytes.ConsumeIntegralInRange<std::size_t>(0, known.size());
  return pick < known.size() ? known[pick] : bytes.ConsumeRandomLengthString(20);
}

Id copy(hid_t type, std::size_t size = 0) {
  Id own(H5Tcopy(type));
  if (size > 0) H5Tset_size(own, size);
  return own;
}

Id string_type(FuzzedDataProvider& bytes, std::size_t size) {
  Id type = copy(H5T_C_S1, size);
  H5Tset_cset(type, bytes.ConsumeBool() ? H5T_CSET_UTF8 : H5T_CSET_ASCII);
  H5Tset_strpad(type,
                bytes.PickValueInArray({H5T_STR_NULLTERM, H5T_STR_NULLPAD, H5T_STR_SPACEPAD}));
  return type;
}

Id compound_type() {
  Id type(H5Tcreate(H5T_COMPOUND, 16));
  H5Tinsert(type, "re", 0, H5T_NATIVE_DOUBLE);
  H5Tinsert(type, "im", 8, H5T_NATIVE_DOUBLE);
  return type;
}

Id type_from(FuzzedDataProvider& bytes) {
  const hsize_t two[] = {2};
  switch (bytes.ConsumeIntegralInRange<int>(0, 17)) {
    case 0:
      return copy(H5T_IEEE_F64BE);
    case 1:
      return copy(H5T_IEEE_F32LE);
    case 2:
      return copy(H5T_STD_I8LE);
    case 3:
      return copy(H5T_STD_U64BE);
    case 4:
      return copy(H5T_STD_I32LE);
    case 5:
      return copy(H5T_NATIVE_LDOUBLE);
    case 6:
      return string_type(bytes, H5T_VARIABLE);
    case 7:
      return string_type(bytes, bytes.ConsumeIntegralInRange<std::size_t>(1, 40));
    case 8:
      return compound_type();
    case 9:
      return Id(H5Tenum_create(H5T_NATIVE_INT));
    case 10:
      return Id(H5Tvlen_create(H5T_NATIVE_DOUBLE));
    case 11:
      return Id(H5Tarray_create2(H5T_NATIVE_DOUBLE, 1, two));
    case 12:
      return Id(H5Tcreate(H5T_OPAQUE, bytes.ConsumeIntegralInRange<std::size_t>(1, 40)));
    case 13:
      return copy(H5T_STD_B16LE);
    case 14:
      return copy(H5T_STD_REF_OBJ);
    default:
      return copy(H5T_IEEE_F64LE);
  }
}

struct Extent {
  std::vector<hsize_t> size;
  bool null = false;

  // Whether the dataset is small enough to write.
  [[nodiscard]] bool small() const {
    hsize_t all = null ? 0 : 1;
    for (const hsize_t one : size) all = one > 64 ? 65 : all * one;
    return all <= 64;
  }
};

Extent extent_from(FuzzedDataProvider& bytes) {
  Extent extent;
  extent.null = bytes.ConsumeIntegralInRange<int>(0, 15) == 0;
  const int rank = bytes.PickValueInArray({1, 1, 1, 2, 2, 0, 3, 32});
  for (int d = 0; d < rank && !extent.null; ++d) {
    const bool large = bytes.ConsumeIntegralInRange<int>(0, 7) == 0;
    extent.size.push_back(large ? hsize_t{1} << bytes.ConsumeIntegralInRange<unsigned>(5, 63)
                                : bytes.ConsumeIntegralInRange<hsize_t>(0, 5));
  }
  return extent;
}

Id space_of(const Extent& extent, bool extendible) {
  if (extent.null) return Id(H5Screate(H5S_NULL));
  if (extent.size.empty()) return Id(H5Screate(H5S_SCALAR));
  const std::vector<hsize_t> most(extent.size.size(), H5S_UNLIMITED);
  return Id(H5Screate_simple(static_cast<int>(extent.size.size()), extent.size.data(),
                             extendible ? most.data() : nullptr));
}

// Values for `space`, of a type without pointers.
std::vector<std::uint8_t> values_from(FuzzedDataProvider& bytes, hid_t type, hid_t space) {
  const hssize_t points = std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0);
  std::vector<std::uint8_t> values(static_cast<std::size_t>(points) * H5Tget_size(type) + 1);
  const auto taken = bytes.ConsumeBytes<std::uint8_t>(values.size() / 2);
  std::copy(taken.begin(), taken.end(), values.begin());
  return values;
}

// Calls write(values) with values of the type.
template <class Write>
void write_values(FuzzedDataProvider& bytes, hid_t type, hid_t space, const Extent& extent,
                  Write write) {
  if (!extent.small() || !bytes.ConsumeBool()) return;
  if (H5Tis_variable_str(type) > 0) {
    const std::string text = bytes.ConsumeRandomLengthString(20);
    const std::vector<const char*> texts(64, text.c_str());
    write(static_cast<const void*>(texts.data()));
  } else if (H5Tdetect_class(type, H5T_VLEN) == 0 && H5Tdetect_class(type, H5T_REFERENCE) == 0) {
    const std::vector<std::uint8_t> values = values_from(bytes, type, space);
    write(static_cast<const void*>(values.data()));
  }
}

void add_attribute(FuzzedDataProvider& bytes, hid_t object) {
  const std::string name = name_from(bytes);
  const Id type = type_from(bytes);
  const Extent extent = bytes.ConsumeBool() ? Extent{} : extent_from(bytes);
  if (!extent.small()) return;
  const Id space = space_of(extent, false);
  const Id attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT));
  if (attribute < 0) return;
  write_values(bytes, type, space, extent,
               [&](const void* values) { H5Awrite(attribute, type, values); });
}

Id layout_from(FuzzedDataProvider& bytes, const Extent& extent, bool& chunked) {
  Id layout(H5Pcreate(H5P_DATASET_CREATE));
  switch (bytes.ConsumeIntegralInRange<int>(0, 3)) {
    case 0:
      H5Pset_layout(layout, H5D_COMPACT);
      break;
    case 1:
      break;
    default: {
      const std::vector<hsize_t> chunk(extent.size.size(),
                                       bytes.ConsumeIntegralInRange<hsize_t>(1, 8));
      chunked =
          !chunk.empty() && H5Pset_chunk(layout, static_cast<int>(chunk.size()), chunk.data()) >= 0;
      if (bytes.ConsumeBool()) H5Pset_shuffle(layout);
      if (bytes.ConsumeBool()) H5Pset_deflate(layout, 1);
      if (bytes.ConsumeBool()) H5Pset_fletcher32(layout);
    }
  }
  return layout;
}

void add_dataset(FuzzedDataProvider& bytes, hid_t parent) {
  const std::string name = name_from(bytes);
  const Id type = type_from(bytes);
  const Extent extent = extent_from(bytes);
  bool chunked = false;
  const Id layout = layout_from(bytes, extent, chunked);
  const Id space = space_of(extent, chunked);
  const Id dataset(H5Dcreate2(parent, name.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT));
  if (dataset < 0) return;
  write_values(bytes, type, space, extent, [&](const void* values) {
    H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
  });
  for (int i = bytes.ConsumeIntegralInRange<int>(0, 3); i > 0; --i) add_attribute(bytes, dataset);
}

void add_object(FuzzedDataProvider& bytes, hid_t parent, int depth) {
  const std::string name = name_from(bytes);
  switch (bytes.ConsumeIntegralInRange<int>(0, 9)) {
    case 0: {
      const Id group(H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
      for (int i = depth < 3 ? bytes.ConsumeIntegralInRange<int>(0, 3) : 0; i > 0; --i) {
        add_object(bytes, group, depth + 1);
      }
      break;
    }
    case 1:
      H5Lcreate_soft(name_from(bytes).c_str(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 2:
      H5Lcreate_external("elsewhere.h5", "/x", parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
      break;
    case 3: {
      const Id type = type_from(bytes);
      H5Tcommit2(parent, name.c_str(), type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      break;
    }
    case 4:
      H5Lcreate_hard(parent, name_from(bytes).c_str(), parent, name.c_str(), H5P_DEFAULT,
                     H5P_DEFAULT);
      break;
    default:
      add_dataset(bytes, parent);
  }
}

}  // namespace

void write_foreign_hdf5(const std::string& file, const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider bytes(data, size);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Id creation(H5Pcreate(H5P_FILE_CREATE)), access(H5Pcreate(H5P_FILE_ACCESS));
  if (bytes.ConsumeBool()) {
    H5Pset_link_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
    H5Pset_attr_creation_order(creation, H5P_CRT_ORDER_TRACKED | H5P_CRT_ORDER_INDEXED);
  }
  if (bytes.ConsumeBool()) H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Id id(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, access));
  must(id >= 0);
  const Id root(H5Gopen2(id, "/", H5P_DEFAULT));
  for (int i = bytes.ConsumeIntegralInRange<int>(0, 4); i > 0; --i) add_attribute(bytes, root);
  for (int i = bytes.ConsumeIntegralInRange<int>(0, 6); i > 0; --i) add_object(bytes, root, 0);
}

}  // namespace bbsim_fuzz
