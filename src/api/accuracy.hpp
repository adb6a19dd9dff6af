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

using study::AccuracyStudy;

// Leaves out the resolutions of commands and sensors. Throws InputError for a scene with a
// controller of the user's.
[[nodiscard]] AccuracyStudy accuracy(const Scenario& scenario, const std::vector<Method>& methods,
                                     const std::vector<double>& rtols, Watch& watch);

// Values from "FIRST:LAST", such as "1e-3:1e-13", a decade apart; or one value. Throws InputError.
[[nodiscard]] std::vector<double> tolerance_ladder(const std::string& text);

// Whether any run reached the end of the scene.
[[nodiscard]] bool any_complete(const AccuracyStudy& study);

using study::accuracy_csv;
using study::accuracy_table;

using study::Verification;

// Runs checks with known answers. Needs no files.
[[nodiscard]] Verification verify(Watch& watch);

using study::FullModelStudy;
using study::require_comparable;
using study::SimplerModel;

// Compares the full model of a scene with simpler ones. Throws InputError as require_comparable()
// does.
[[nodiscard]] FullModelStudy compare_simpler(const Scenario& scenario, Watch& watch);

using study::paper_scenes;

}  // namespace bbsim::api
