#include "record/hdf5/reader.hpp"

#include <array>
#include <string>

#include "record/hdf5/strings.hpp"

namespace bbsim::hdf5 {
namespace {

constexpr std::size_t cache_slots = 31;
constexpr std::size_t cache_bytes = std::size_t{256} * 1024;

File open_file(const char* path) {
  if (H5Fis_hdf5(path) == 0) throw Failure("it is no HDF5 file");
  const Properties access(H5Pcreate(H5P_FILE_ACCESS), "opening the file");
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "opening the file");
#if H5_VERSION_GE(1, 12, 1) || (H5_VERSION_GE(1, 10, 7) && !H5_VERSION_GE(1, 12, 0))
  // Results do not change once they are there, and many network file systems know no locks.
  check(H5Pset_file_locking(access, false, true), "opening the file");
#endif
  return {H5Fopen(path, H5F_ACC_RDONLY, access), "opening the file"};
}

// In the order in which they were created, where the file tells: of links or of attributes.
H5_index_t order_of(hid_t group, herr_t (*get_order)(hid_t, unsigned*)) {
  const Properties creation(H5Gget_create_plist(group), "opening the file");
  unsigned flags = 0;
  check(get_order(creation, &flags), "opening the file");
  return (flags & H5P_CRT_ORDER_TRACKED) != 0 ? H5_INDEX_CRT_ORDER : H5_INDEX_NAME;
}

// HDF5 copies a name, or tells its length: call(buffer, size) for one or the other.
template <class Call>
std::string name_from(Call call, const char* doing) {
  std::string name(static_cast<std::size_t>(check(call(nullptr, 0), doing)), '\0');
  check(call(name.data(), name.size() + 1), doing);
  return name;
}

struct Shape {
  bbsim_hdf5_kind kind;
  std::size_t width, rows;
};

Shape shape_of(hid_t dataset, const std::string& name) {
  const std::string doing = "reading dataset " + name;
  const Dataspace space(H5Dget_space(dataset), doing.c_str());
  const Datatype type(H5Dget_type(dataset), doing.c_str());
  const H5T_class_t held = H5Tget_class(type);
  const bool numbers = held == H5T_FLOAT || held == H5T_INTEGER;
  const bool text = held == H5T_STRING && H5Tis_variable_str(type) > 0;
  const int rank = check(H5Sget_simple_extent_ndims(space), doing.c_str());
  if (!numbers && !text) {
    throw Failure("dataset " + name +
                  " is no column: it must hold numbers or strings of variable length");
  }
  if (rank != 1 && (rank != 2 || text)) {
    throw Failure("dataset " + name + " is no column: it has " + std::to_string(rank) +
                  " dimensions; numbers may have 1 or 2, text 1");
  }
  std::array<hsize_t, 2> size{};
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr), doing.c_str());
  if (text) return {BBSIM_HDF5_TEXT, 1, size[0]};
  if (rank == 2) return {BBSIM_HDF5_SERIES, size[1], size[0]};
  if (check(H5Aexists(dataset, "axis"), doing.c_str()) > 0) {
    return {BBSIM_HDF5_AXIS, size[0], size[0]};
  }
  return {BBSIM_HDF5_NUMBER, 1, size[0]};
}

// Rows of a dataset, whole, in the file and in memory.
struct Selection {
  Dataspace file, memory;
};

Selection select(hid_t dataset, hsize_t first, hsize_t rows, const char* doing) {
  Selection result;
  result.file = Dataspace(H5Dget_space(dataset), doing);
  std::array<hsize_t, 2> count{};  // no dataset that shape_of() lets pass has more dimensions
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

void must_go_on(int answer) {
  if (answer != 0) throw Failure("there is not enough memory for what it holds");
}

void tell_attributes(hid_t root, const bbsim_hdf5_contents& contents) {
  constexpr const char* doing = "reading an attribute";
  const H5_index_t order = order_of(root, H5Pget_attr_creation_order);
  const int count = check(H5Aget_num_attrs(root), doing);
  for (int i = 0; i < count; ++i) {
    const Attribute attribute(H5Aopen_by_idx(root, ".", order, H5_ITER_INC, static_cast<hsize_t>(i),
                                             H5P_DEFAULT, H5P_DEFAULT),
                              doing);
    std::string value;
    if (!read_attribute(attribute, value)) continue;
    const std::string name = name_from(
        [&](char* to, std::size_t size) { return H5Aget_name(attribute, size, to); }, doing);
    const bbsim_hdf5_attribute pair{name.c_str(), value.c_str()};
    must_go_on(contents.attribute(contents.context, &pair));
  }
}

}  // namespace

Reader::Reader(const char* path, const bbsim_hdf5_contents& contents) : file_(open_file(path)) {
  const Group root(H5Gopen2(file_, "/", H5P_DEFAULT), "opening the file");
  tell_datasets(root, contents);
  tell_attributes(root, contents);
}

void Reader::tell_datasets(hid_t root, const bbsim_hdf5_contents& contents) {
  const H5_index_t order = order_of(root, H5Pget_link_creation_order);
  // Rows are mostly read front to back: there is no need for HDF5's MiB a dataset.
  const Properties access(H5Pcreate(H5P_DATASET_ACCESS), "opening the file");
  check(H5Pset_chunk_cache(access, cache_slots, cache_bytes, 1.0), "opening the file");
  H5G_info_t info{};
  check(H5Gget_info(root, &info), "listing the datasets");
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const std::string name = name_from(
        [&](char* to, std::size_t size) {
          return H5Lget_name_by_idx(root, ".", order, H5_ITER_INC, i, to, size, H5P_DEFAULT);
        },
        "listing the datasets");
    const std::string doing = "opening " + name;
    const Object object(H5Oopen(root, name.c_str(), H5P_DEFAULT), doing.c_str());
    if (H5Iget_type(object) != H5I_DATASET) continue;
    const auto [kind, width, rows] = shape_of(object, name);
    const std::string unit = attribute_of(object, "unit");
    const std::string description = attribute_of(object, "description");
    const bbsim_hdf5_column column{name.c_str(), unit.c_str(), description.c_str(), kind, width};
    must_go_on(contents.dataset(contents.context, &column, rows));
    datasets_.push_back({name, Dataset(H5Dopen2(root, name.c_str(), access), doing.c_str())});
  }
}

void Reader::read_numbers(std::size_t dataset, std::size_t first, std::size_t rows,
                          double* to) const {
  if (rows == 0) return;
  const auto& [name, from] = datasets_.at(dataset);
  const std::string doing = "reading dataset " + name;
  const Selection selected = select(from, first, rows, doing.c_str());
  if (check(H5Sget_select_npoints(selected.file), doing.c_str()) == 0) return;  // no width
  check(H5Dread(from, H5T_NATIVE_DOUBLE, selected.memory, selected.file, H5P_DEFAULT, to),
        doing.c_str());
}

void Reader::read_texts(std::size_t dataset, std::size_t first, std::size_t rows,
                        const bbsim_hdf5_texts& to) const {
  if (rows == 0) return;
  const auto& [name, from] = datasets_.at(dataset);
  const std::string doing = "reading dataset " + name;
  const Selection selected = select(from, first, rows, doing.c_str());
  const Datatype type(H5Dget_type(from), doing.c_str());  // HDF5 converts no character sets
  Strings strings(type, selected.memory, rows);
  check(H5Dread(from, type, selected.memory, selected.file, H5P_DEFAULT, strings.data()),
        doing.c_str());
  for (const char* text : strings.texts()) {
    must_go_on(
        to.text(to.context, text == nullptr ? "" : text));  // nothing is kept of an empty one
  }
}

}  // namespace bbsim::hdf5
