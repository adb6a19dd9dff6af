// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/reader.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "base/quoted.hpp"
#include "file/hdf5/layout.hpp"

namespace bbsim::hdf5 {
namespace {

// The chunk cache of a dataset: at least least_cache bytes, enough for one chunk, and about
// most_cache for all datasets together.
constexpr std::size_t cache_slots = 31;
constexpr std::size_t least_cache = std::size_t{256} * 1024;
constexpr std::size_t most_cache = std::size_t{256} * 1024 * 1024;

// The largest ratio of the declared to the stored size of a dataset: deflate packs at most 1032
// bytes into one. `slack` allows for some declared data that was never written.
constexpr std::uint64_t most_expansion = 1100;
constexpr std::uint64_t slack = 65536;  // bytes

// Texts per read. It limits HDF5's memory, because a damaged file may declare any length.
constexpr std::size_t rows_at_once = 256;

File open_file(const char* path) {
  if (H5Fis_hdf5(path) == 0) throw Failure("it is not an HDF5 file");
  const Properties access(H5Pcreate(H5P_FILE_ACCESS), "opening the file");
  check(H5Pset_fclose_degree(access, H5F_CLOSE_STRONG), "opening the file");
#if H5_VERSION_GE(1, 12, 1) || (H5_VERSION_GE(1, 10, 7) && !H5_VERSION_GE(1, 12, 0))
  // Results do not change once they exist, and many network file systems have no locks.
  check(H5Pset_file_locking(access, false, true), "opening the file");
#endif
  return {H5Fopen(path, H5F_ACC_RDONLY, access), "opening the file"};
}

std::uint64_t size_of(hid_t file) {
  hsize_t bytes = 0;
  check(H5Fget_filesize(file, &bytes), "opening the file");
  return bytes;
}

// The order of links or attributes: by creation if the file records it, otherwise by name.
H5_index_t order_of(hid_t group, herr_t (*get_order)(hid_t, unsigned*)) {
  const Properties creation(H5Gget_create_plist(group), "opening the file");
  unsigned flags = 0;
  check(get_order(creation, &flags), "opening the file");
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
  Properties access(H5Pcreate(H5P_LINK_ACCESS), "opening the file");
  const auto refuse_all = [](const char*, const char*, const char*, const char*, unsigned*, hid_t,
                             void*) -> herr_t { return -1; };
  check(H5Pset_elink_cb(access, refuse_all, nullptr), "opening the file");
  return access;
}

// The names of the links in a group. Throws Failure for a link to another file: this file must not
// make bbsim open others.
std::vector<std::string> links_of(hid_t group, const std::string& path) {
  constexpr const char* doing = "listing the datasets";
  const H5_index_t order = order_of(group, H5Pget_link_creation_order);
  H5G_info_t info{};
  check(H5Gget_info(group, &info), doing);
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    names.push_back(name_from(
        [&](char* to, std::size_t size) {
          return H5Lget_name_by_idx(group, ".", order, H5_ITER_INC, i, to, size, H5P_DEFAULT);
        },
        doing));
    H5L_info_t link{};
    check(H5Lget_info_by_idx(group, ".", order, H5_ITER_INC, i, &link, H5P_DEFAULT), doing);
    if (link.type == H5L_TYPE_HARD || link.type == H5L_TYPE_SOFT) continue;
    throw Failure(shown(path + names.back()) +
                  " is a link to another file; allowed: data in the file itself");
  }
  return names;
}

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw Failure("dataset " + shown(path) + " is not a column: " + why);
}

bbsim_hdf5_kind kind_of(hid_t dataset, H5T_class_t held, int rank) {
  if (held == H5T_STRING) return BBSIM_HDF5_TEXT;
  if (rank == 2) return BBSIM_HDF5_SERIES;
  if (check(H5Aexists(dataset, axis_mark), "reading an attribute") > 0) return BBSIM_HDF5_AXIS;
  return held == H5T_INTEGER ? BBSIM_HDF5_INTEGER : BBSIM_HDF5_NUMBER;
}

// The longest fixed length that is reported. Longer strings count as strings of any length.
constexpr std::size_t longest_to_copy = 1024;

DatasetInfo info_of(hid_t dataset, const std::string& name, const std::string& path) {
  const std::string doing = "reading dataset " + shown(path);
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
  std::array<hsize_t, 2> size{};
  check(H5Sget_simple_extent_dims(space, size.data(), nullptr), doing);
  DatasetInfo info{name, attribute_of(dataset, "unit"), attribute_of(dataset, "description"),
                   kind_of(dataset, held, rank)};
  info.rows = size[0];
  if (info.kind == BBSIM_HDF5_SERIES) info.width = size[1];
  if (info.kind == BBSIM_HDF5_AXIS) info.width = size[0];
  if (info.kind == BBSIM_HDF5_TEXT && check(H5Tis_variable_str(type), doing) == 0) {
    const std::size_t length = H5Tget_size(type);
    if (length <= longest_to_copy) info.width = length;
  }
  return info;
}

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result) ? std::numeric_limits<std::uint64_t>::max() : result;
}
std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_add_overflow(a, b, &result) ? std::numeric_limits<std::uint64_t>::max() : result;
}

// Bytes of a chunk; 0 if the dataset is not chunked.
std::uint64_t chunk_bytes(hid_t dataset, hid_t creation, const char* doing) {
  if (H5Pget_layout(creation) != H5D_CHUNKED) return 0;
  std::array<hsize_t, 2> chunk{1, 1};  // info_of() refuses more dimensions
  check(H5Pget_chunk(creation, static_cast<int>(chunk.size()), chunk.data()), doing);
  const Datatype type(H5Dget_type(dataset), doing);
  return product(product(chunk[0], chunk[1]), H5Tget_size(type));
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

// Reads strings of any length. Returns their total bytes.
std::uint64_t add_strings(hid_t dataset, const Datatype& type, const Selection& selected,
                          std::size_t rows, const std::string& doing,
                          std::vector<std::string>& texts) {
  Strings strings(type, selected.memory, rows);
  check(H5Dread(dataset, type, selected.memory, selected.file, H5P_DEFAULT, strings.data()), doing);
  std::uint64_t bytes = 0;
  for (const char* text : strings.texts()) {
    texts.emplace_back(text == nullptr ? "" : text);  // null for an empty string
    bytes += texts.back().size();
  }
  return bytes;
}

// Reads strings of the type's fixed length.
void add_fixed_strings(hid_t dataset, const Datatype& type, const Selection& selected,
                       std::size_t rows, const std::string& doing,
                       std::vector<std::string>& texts) {
  const std::size_t size = H5Tget_size(type);
  std::vector<char> strings(rows * size);
  check(H5Dread(dataset, type, selected.memory, selected.file, H5P_DEFAULT, strings.data()), doing);
  for (std::size_t i = 0; i < rows; ++i) {
    const char* text = strings.data() + i * size;
    texts.emplace_back(text, std::find(text, text + size, '\0'));
  }
}

}  // namespace

Reader::Reader(const char* path, void (*got_on)())
    : got_on_(got_on), file_(open_file(path)), bytes_(size_of(file_)) {
  const Group root(H5Gopen2(file_, "/", H5P_DEFAULT), "opening the file");
  find_datasets(root, "");
  root_datasets_ = datasets_.size();
  find_attributes(root);
  find_inputs(root);
}

void Reader::find_datasets(hid_t group, const std::string& path) {
  const std::vector<std::string> links = links_of(group, path);
  for (const std::string& name : links) {
    const std::string shown_path = path + name;
    const std::string doing = "opening " + shown(shown_path);
    const Object object(H5Oopen(group, name.c_str(), within_file()), doing);
    if (H5Iget_type(object) != H5I_DATASET) continue;
    DatasetInfo info = info_of(object, name, shown_path);
    check_size(object, info, shown_path);
    const bool is_input = !path.empty();
    if (is_input) {
      const std::string title = attribute_of(object, input_title);
      if (!title.empty()) info.name = title;
    }
    got_on_();

    // Rows are mostly read front to back, so HDF5's default of 1 MiB per dataset is not needed. But
    // HDF5 reads and unpacks a chunk again for each access if the cache cannot hold all of it.
    const Properties creation(H5Dget_create_plist(object), doing);
    const auto chunk = static_cast<std::size_t>(chunk_bytes(object, creation, "opening the file"));
    const Properties access(H5Pcreate(H5P_DATASET_ACCESS), doing);
    const std::size_t most = std::max(least_cache, most_cache / links.size());
    check(H5Pset_chunk_cache(access, cache_slots, std::clamp(chunk, least_cache, most), 1.0),
          doing);
    datasets_.push_back(
        {std::move(info), shown_path, Dataset(H5Dopen2(group, name.c_str(), access), doing)});
  }
}

void Reader::find_attributes(hid_t root) {
  constexpr const char* doing = "reading an attribute";
  const H5_index_t order = order_of(root, H5Pget_attr_creation_order);
  const int count = check(H5Aget_num_attrs(root), doing);
  for (int i = 0; i < count; ++i) {
    const Attribute attribute(H5Aopen_by_idx(root, ".", order, H5_ITER_INC, static_cast<hsize_t>(i),
                                             H5P_DEFAULT, H5P_DEFAULT),
                              doing);
    Value value;
    if (!read_attribute(attribute, value)) continue;
    std::string name = name_from(
        [&](char* to, std::size_t size) { return H5Aget_name(attribute, size, to); }, doing);
    attributes_.emplace_back(std::move(name), std::move(value));
    got_on_();
  }
}

void Reader::find_inputs(hid_t root) {
  constexpr const char* doing = "listing the input tables";
  if (check(H5Lexists(root, inputs_group, H5P_DEFAULT), doing) == 0) return;
  const Object inputs(H5Oopen(root, inputs_group, within_file()), doing);
  if (H5Iget_type(inputs) != H5I_GROUP) return;  // a column with this name
  const std::string path = std::string(inputs_group) + "/";
  for (const std::string& name : links_of(inputs, path)) {
    const Object table(H5Oopen(inputs, name.c_str(), within_file()), doing);
    if (H5Iget_type(table) != H5I_GROUP) continue;
    const std::string file = attribute_of(table, input_file);
    const std::size_t first = datasets_.size();
    find_datasets(table, path + name + "/");
    inputs_.push_back({file.empty() ? name : file, first, datasets_.size() - first});
  }
}

void Reader::check_size(hid_t dataset, const DatasetInfo& info, const std::string& path) {
  const std::string doing = "reading dataset " + shown(path);
  const Properties creation(H5Dget_create_plist(dataset), doing);
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL || check(H5Pget_external_count(creation), doing) > 0) {
    refuse(path, "its numbers are in other files; allowed: data in the file itself");
  }
  const Datatype type(H5Dget_type(dataset), doing);
  const std::size_t numbers = info.kind == BBSIM_HDF5_SERIES ? info.width : 1;
  const std::uint64_t declared = product(product(info.rows, numbers), H5Tget_size(type));
  const bool packed = check(H5Pget_nfilters(creation), doing) > 0;
  const std::uint64_t stored = H5Dget_storage_size(dataset);
  const std::uint64_t possible =
      stored > bytes_ ? 0 : sum(slack, product(packed ? most_expansion : 1, stored));
  declared_ = sum(declared_, declared);
  const std::uint64_t together =
      sum(product(slack, datasets_.size() + 1), product(most_expansion, bytes_));
  if (declared <= possible && declared_ <= together) return;
  throw Failure("dataset " + shown(path) + " declares " + std::to_string(info.rows) +
                (info.rows == 1 ? " row" : " rows") +
                (numbers == 1 ? "" : " of " + std::to_string(numbers) + " numbers") + ", " +
                std::to_string(declared) + " bytes; the file has " + std::to_string(bytes_) +
                " bytes, " + std::to_string(stored) +
                " of them for it: it is damaged, or the dataset was never filled");
}

void Reader::read_numbers(std::size_t dataset, std::size_t first, std::size_t rows,
                          double* to) const {
  if (rows == 0) return;
  const auto& [info, path, from] = datasets_.at(dataset);
  const std::string doing = "reading dataset " + shown(path);
  const Selection selected = select(from, first, rows, doing);
  if (check(H5Sget_select_npoints(selected.file), doing) == 0) return;  // width 0
  check(H5Dread(from, H5T_NATIVE_DOUBLE, selected.memory, selected.file, H5P_DEFAULT, to), doing);
}

std::vector<std::string> Reader::read_texts(std::size_t dataset, std::size_t first,
                                            std::size_t rows) const {
  const auto& [info, path, from] = datasets_.at(dataset);
  const std::string doing = "reading dataset " + shown(path);
  const Datatype type(H5Dget_type(from), doing);  // HDF5 cannot convert character sets
  std::vector<std::string> texts;
  if (check(H5Tis_variable_str(type), doing) == 0) {
    add_fixed_strings(from, type, select(from, first, rows, doing), rows, doing, texts);
    return texts;
  }
  std::uint64_t bytes = 0;
  for (std::size_t done = 0; done < rows; done += rows_at_once) {
    const std::size_t now = std::min(rows_at_once, rows - done);
    const Selection selected = select(from, first + done, now, doing);
    bytes = sum(bytes, add_strings(from, type, selected, now, doing, texts));
    if (bytes > bytes_) throw Failure(doing + " failed: its texts are longer than the file");
  }
  return texts;
}

}  // namespace bbsim::hdf5
