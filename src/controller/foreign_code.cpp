// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/foreign_code.hpp"

#include <dlfcn.h>

namespace bbsim::controller {

pid_t start_program(const file::NewProcess& program, int& error) {
  return file::start_process(program, error);
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
