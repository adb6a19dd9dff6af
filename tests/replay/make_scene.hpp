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

// A ball on a tilting plate that moves around a circle of 5 cm in `rows` rows of 10 ms.
bbsim::replay::Run circling(std::size_t rows);

// A sweep of 41 x 21 cases over two keys, with some failed cases.
bbsim::replay::Sweep swept();

}  // namespace bbsim_test
