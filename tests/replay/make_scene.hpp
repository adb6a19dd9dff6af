// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenes for tests.
#pragma once

#include <string>

#include "replay/scene.hpp"

namespace bbsim_test {

// `files` is RESULT.csv[,SCENARIO.yaml[,SUMMARY.json[,CHECK.txt]]].
bbsim::replay::Run run_of(const std::string& files);

bbsim::replay::Sweep sweep_of(const std::string& table, const std::string& scenario);

// A ball that goes round a circle of 5 cm in `rows` rows of 10 ms, on a plate that tilts.
bbsim::replay::Run circling(std::size_t rows);

// From 41 x 21 cases of a sweep over two keys, of which some failed.
bbsim::replay::Sweep swept();

}  // namespace bbsim_test
