#include "record/hdf5/reader.hpp"

#include <string>

#include "record/hdf5/handle.hpp"

namespace bbsim::hdf5 {
namespace {

File open_file(const char* path) {
  const Properties access(H5Pcreate(H5P_FILE_ACCESS), "opening the file");
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "opening the file");
#if H5_VERSION_GE(1, 12, 1) || (H5_VERSION_GE(1, 10, 7) && !H5_VERSION_GE(1, 12, 0))
  // Results do not change once they are there, and many network file systems know no locks.
  check(H5Pset_file_locking(access, false, true), "opening the file");
#endif
  return {H5Fopen(path, H5F_ACC_RDONLY, access), "opening the file"};
}

// In the order in which they were created, where the file tells.
H5_index_t order_of(hid_t group) {
  const Properties creation(H5Gget_create_plist(group), "opening the file");
  unsigned flags = 0;
  check(H5Pget_link_creation_order(creation, &flags), "opening the file");
  return (flags & H5P_CRT_ORDER_TRACKED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

std::string name_of(hid_t group, H5_index_t index, hsize_t position) {
  const auto length =
      check(H5Lget_name_by_idx(group, ".", index, H5_ITER_INC, position, nullptr, 0, H5P_DEFAULT),
            "listing the datasets");
  std::string name(static_cast<std::size_t>(length), '\0');
  check(H5Lget_name_by_idx(group, ".", index, H5_ITER_INC, position, name.data(), name.size() + 1,
                           H5P_DEFAULT),
        "listing the datasets");
  return name;
}

void read_dataset(hid_t dataset, const std::string& name, const bbsim_hdf5_sink& sink) {
  const std::string doing = "reading dataset " + name;
  const Dataspace space(H5Dget_space(dataset), doing.c_str());
  const Datatype type(H5Dget_type(dataset), doing.c_str());
  const H5T_class_t kind = H5Tget_class(type);
  if (H5Sget_simple_extent_ndims(space) != 1 || (kind != H5T_FLOAT && kind != H5T_INTEGER)) {
    throw Failure("dataset " + name + " is no column: it must have one dimension and hold numbers");
  }
  hsize_t rows = 0;
  check(H5Sget_simple_extent_dims(space, &rows, nullptr), doing.c_str());
  double* to = sink.column(sink.context, name.c_str(), rows);
  if (to == nullptr) {
    throw Failure("no memory for the " + std::to_string(rows) + " rows of dataset " + name);
  }
  if (rows == 0) return;
  check(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, to), doing.c_str());
}

}  // namespace

void read(const char* path, const bbsim_hdf5_sink& sink) {
  if (H5Fis_hdf5(path) == 0) throw Failure("it is no HDF5 file");
  const File file = open_file(path);
  const Group root(H5Gopen2(file, "/", H5P_DEFAULT), "opening the file");
  const H5_index_t order = order_of(root);
  H5G_info_t info{};
  check(H5Gget_info(root, &info), "listing the datasets");
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const std::string name = name_of(root, order, i);
    const std::string doing = "opening " + name;
    const Object object(H5Oopen(root, name.c_str(), H5P_DEFAULT), doing.c_str());
    if (H5Iget_type(object) == H5I_DATASET) read_dataset(object, name, sink);
  }
}

}  // namespace bbsim::hdf5
