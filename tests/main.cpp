// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Catch2 3 brings its own main (Catch2::Catch2WithMain); this one is built for Catch2 2 only.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
