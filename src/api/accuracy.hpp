// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Accuracy of this build: methods and tolerances over a scene, known answers, simpler models.
#pragma once

#include <string>
#include <vector>

#include "api/watch.hpp"
#include "scenario/scenario.hpp"
#include "study/accuracy.hpp"
#include "study/verify.hpp"

namespace bbsim::api {

// Without `methods`: all except `auto`, which is one of the others. Leaves out the resolutions of
// commands and sensors. Throws InputError for a scene with a controller of the user's.
[[nodiscard]] study::AccuracyStudy accuracy(const Scenario& scenario, std::vector<Method> methods,
                                            const std::vector<double>& rtols, Watch& watch);

// Values from "FIRST:LAST", such as "1e-3:1e-13", a decade apart; or one value. Throws InputError.
[[nodiscard]] std::vector<double> tolerance_ladder(const std::string& text);

// Runs checks with known answers. Needs no files.
[[nodiscard]] study::Verification verify(Watch& watch);

// Compares the full model of a scene with simpler ones. Throws InputError as require_comparable()
// does.
[[nodiscard]] study::FullModelStudy compare_simpler(const Scenario& scenario, Watch& watch);

}  // namespace bbsim::api
