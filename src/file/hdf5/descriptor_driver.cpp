// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5/descriptor_driver.hpp"

#include <unistd.h>

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <new>

namespace bbsim::hdf5 {
namespace {

struct OpenFile : H5FD_t {  // HDF5 owns and fills the base
  DescriptorTarget target;
  pid_t owner = getpid();
  haddr_t allocated = 0;  // end of the addresses that HDF5 has allocated
  haddr_t size = 0;       // end of the written bytes
};

OpenFile& self(H5FD_t* file) {
  return *static_cast<OpenFile*>(file);
}
const OpenFile& self(const H5FD_t* file) {
  return *static_cast<const OpenFile*>(file);
}

// A process that was forked meanwhile has a copy of the caches, and must not write it to the file,
// as HDF5 would when that process ends.
bool is_copy(const OpenFile& file) {
  return file.owner != getpid();
}

void note_error(const OpenFile& file) {
  if (*file.target.system_error == 0) *file.target.system_error = errno;
}

H5FD_t* open_file(const char* /*name*/, unsigned /*flags*/, hid_t access, haddr_t /*maxaddr*/) {
  const void* target = H5Pget_driver_info(access);
  if (target == nullptr) return nullptr;
  auto* file = new (std::nothrow) OpenFile{};
  if (file != nullptr) file->target = *static_cast<const DescriptorTarget*>(target);
  return file;
}

herr_t close_file(H5FD_t* file) {
  delete &self(file);  // the caller keeps the descriptor open
  return 0;
}

herr_t query(const H5FD_t* /*file*/, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

haddr_t get_allocated(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return self(file).allocated;
}

herr_t set_allocated(H5FD_t* file, H5FD_mem_t /*type*/, haddr_t address) {
  self(file).allocated = address;
  return 0;
}

haddr_t get_size(const H5FD_t* file, H5FD_mem_t /*type*/) {
  return self(file).size;
}

herr_t read_bytes(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                  std::size_t size, void* buffer) {
  auto* to = static_cast<char*>(buffer);
  while (size > 0) {
    const ssize_t got = pread(self(base).target.descriptor, to, size, static_cast<off_t>(address));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) note_error(self(base));
    if (got <= 0) {  // end of file or failure: reads as zeros
      std::memset(to, 0, size);
      return 0;
    }
    to += got;
    address += static_cast<haddr_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return 0;
}

herr_t write_bytes(H5FD_t* base, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                   std::size_t size, const void* buffer) {
  OpenFile& file = self(base);
  if (is_copy(file)) return 0;
  file.size = std::max(file.size, address + size);
  const auto* from = static_cast<const char*>(buffer);
  while (size > 0 && *file.target.system_error == 0) {
    const ssize_t put = pwrite(file.target.descriptor, from, size, static_cast<off_t>(address));
    if (put < 0) {
      if (errno != EINTR) note_error(file);
      continue;
    }
    from += put;
    address += static_cast<haddr_t>(put);
    size -= static_cast<std::size_t>(put);
  }
  return 0;
}

herr_t truncate_file(H5FD_t* base, hid_t /*transfer*/, hbool_t /*closing*/) {
  OpenFile& file = self(base);
  if (is_copy(file) || file.size == file.allocated) return 0;
  if (ftruncate(file.target.descriptor, static_cast<off_t>(file.allocated)) != 0) note_error(file);
  file.size = file.allocated;
  return 0;
}

// Registered once; HDF5 keeps the class until the process ends.
hid_t driver() {
  static const hid_t id = [] {
    H5FD_class_t driver_class{};
#if H5_VERSION_GE(1, 13, 0)
    driver_class.version = H5FD_CLASS_VERSION;
    driver_class.value = 600;  // from the range that HDF5 reserves for users' drivers
#endif
    driver_class.name = "bbsim-descriptor";
    driver_class.maxaddr = INT64_MAX;
    driver_class.fc_degree = H5F_CLOSE_STRONG;
    driver_class.fapl_size = sizeof(DescriptorTarget);
    driver_class.open = open_file;
    driver_class.close = close_file;
    driver_class.query = query;
    driver_class.get_eoa = get_allocated;
    driver_class.set_eoa = set_allocated;
    driver_class.get_eof = get_size;
    driver_class.read = read_bytes;
    driver_class.write = write_bytes;
    driver_class.truncate = truncate_file;
    return H5FDregister(&driver_class);
  }();
  return id;
}

}  // namespace

void use_descriptor(const Properties& file_access, DescriptorTarget target) {
  check(driver(), "registering the file driver");
  check(H5Pset_driver(file_access, driver(), &target), "choosing the file driver");
}

}  // namespace bbsim::hdf5
