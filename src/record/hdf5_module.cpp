#include "record/hdf5_module.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

namespace bbsim::record {
namespace {

constexpr const char* file_name = "libbbsim_hdf5.so";

}  // namespace

Hdf5Module open_hdf5_module(const std::vector<std::string>& folders) {
  const std::string advice = "; write or read .csv instead, ";
  std::string looked_in;
  for (const std::string& folder : folders) {
    const std::string file = folder + "/" + file_name;
    looked_in.append(looked_in.empty() ? "" : " and ").append(folder);
    if (access(file.c_str(), F_OK) != 0) continue;
    // Never closed: HDF5 cleans up when the process ends.
    void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      return {nullptr, std::string("the HDF5 module does not open: ") + dlerror() + advice +
                           "or install the HDF5 library that it was built with"};
    }
    const auto entry =
        reinterpret_cast<bbsim_hdf5_entry_function>(dlsym(library, BBSIM_HDF5_ENTRY));
    const bbsim_hdf5_module* functions = entry == nullptr ? nullptr : entry();
    if (functions == nullptr || functions->interface_version != BBSIM_HDF5_INTERFACE) {
      std::string trouble = "the HDF5 module ";
      trouble.append(file).append(" belongs to another version of bbsim").append(advice);
      return {nullptr, trouble.append("or install the two together")};
    }
    return {functions, ""};
  }
  return {nullptr, std::string("the HDF5 module ") + file_name + " is not in " + looked_in +
                       advice +
                       "or install bbsim whole, or set BBSIM_MODULE_PATH to the module's folder"};
}

std::vector<std::string> hdf5_module_folders() {
  if (const char* folder = std::getenv("BBSIM_MODULE_PATH"); folder != nullptr && *folder != '\0') {
    return {folder};
  }
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path prefix = program.parent_path().parent_path();
  std::vector<std::string> result{prefix / "lib" / "bbsim"};
  const std::string installed = prefix / BBSIM_INSTALL_LIBDIR / "bbsim";
  if (installed != result.front()) result.push_back(installed);
  return result;
}

const Hdf5Module& hdf5_module() {
  static const Hdf5Module module = open_hdf5_module(hdf5_module_folders());
  return module;
}

}  // namespace bbsim::record
