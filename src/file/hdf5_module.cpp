// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "file/hdf5_module.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string_view>

#include "file/share_folders.hpp"

namespace bbsim::file {
namespace {

constexpr const char* module_name = "libbbsim_hdf5.so";
constexpr const char* way_out = "; write or read .csv instead, ";

ForkMutex opening, turns;  // a forked process must not wait for a thread that it does not have
const Hdf5Module* the_module = nullptr;

}  // namespace

Hdf5Module open_hdf5_module(const std::vector<std::string>& folders) {
  std::string file, looked_in;
  for (const std::string& folder : folders) {
    file = folder + "/" + module_name;
    if (access(file.c_str(), F_OK) == 0) break;
    file.clear();
    looked_in.append(looked_in.empty() ? "" : " and ").append(folder);
  }
  if (file.empty()) {
    return {nullptr,
            std::string("the HDF5 module ") + module_name + " is not in " + looked_in + way_out +
                "or install all of bbsim, or set BBSIM_MODULE_PATH to the module's folder"};
  }
  // Never closed, because the open files of any thread may need it.
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    return {nullptr, std::string("the HDF5 module cannot be loaded: ") + dlerror() + way_out +
                         "or install the HDF5 library that it was built with"};
  }
  auto* functions = static_cast<hdf5::Module*>(dlsym(library, hdf5::module_symbol));
  if (functions == nullptr || std::string_view(functions->build) != hdf5::this_build) {
    return {nullptr, "the HDF5 module " + file + " belongs to another version of bbsim" + way_out +
                         "or install the two together"};
  }
  functions->turns = &turns;
  return {functions, ""};
}

std::vector<std::string> hdf5_module_folders() {
  if (const char* folder = std::getenv("BBSIM_MODULE_PATH"); folder != nullptr && *folder != '\0') {
    return {folder};
  }
  // Covers a library in PREFIX/lib and a Python module in PREFIX/lib/python3/dist-packages/bbsim.
  const std::filesystem::path library = own_library();
  return library.empty() ? folders_of_prefix("lib", BBSIM_INSTALL_LIBDIR)
                         : folders_above(library, 4, "bbsim");
}

const Hdf5Module& hdf5_module() {
  const std::lock_guard lock(opening);
  // Never destroyed, because a thread may write until the process ends.
  if (the_module == nullptr) the_module = new Hdf5Module(open_hdf5_module(hdf5_module_folders()));
  return *the_module;
}

}  // namespace bbsim::file
