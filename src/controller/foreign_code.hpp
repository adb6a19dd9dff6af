// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The two functions that start foreign code. Fuzz targets replace them with functions that refuse,
// because their scenarios are random.
#pragma once

#include <sys/types.h>

#include <string>

#include "file/start_process.hpp"

namespace bbsim::controller {

// file::start_process() for programs of the user.
[[nodiscard]] pid_t start_program(const file::NewProcess& program, int& error);

// Opens a shared library. Returns null, with the reason in `error`, if that fails.
[[nodiscard]] void* open_library(const std::string& path, std::string& error);

}  // namespace bbsim::controller
