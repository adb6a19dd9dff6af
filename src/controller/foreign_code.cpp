// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/foreign_code.hpp"

#include <dlfcn.h>

#include "file/start_process.hpp"

namespace bbsim::controller {

pid_t start_program(const std::vector<std::string>& words, const std::string& folder,
                    const Streams& streams, int& error) {
  return file::start_process({words, streams.input, streams.output, streams.error, folder, true},
                             error);
}

void* open_library(const std::string& path, std::string& error) {
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const why = dlerror();
    error = why == nullptr ? "it cannot be opened" : why;
  }
  return library;
}

}  // namespace bbsim::controller
