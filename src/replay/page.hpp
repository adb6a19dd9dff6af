// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes one HTML file that replays a scene. It opens offline and requests nothing.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::replay {

// Puts the scene into the page's template. Times and keys of sweeps are doubles, other numbers of
// runs are floats, and orientations have steps of 1/32767. Long runs keep the rows of kept_rows(),
// at most 20,000 rows and 2.4 MB of numbers in all runs together; sweeps keep cases_kept(). Every
// text of the scene appears as text in the page, whatever characters it has. Throws InputError as
// check_scene() does, and for a damaged template.
//
// With an `engine` (template.hpp), the page is live: it can run the scene's scenario again.
[[nodiscard]] std::string page(const Scene& scene, std::string_view page_template,
                               std::string_view engine = {});

// The data of the same page, for one that is open already (wasm/engine.cpp): JSON in which each
// list of numbers is the place of one of `arrays`. Throws InputError as check_scene() does.
[[nodiscard]] std::string scene_json(const Scene& scene, std::vector<std::vector<double>>& arrays);

// The same for the open loops of a live page; null if there are none.
[[nodiscard]] std::string loops_json(const std::optional<Live::Loops>& loops,
                                     std::vector<std::vector<double>>& arrays);

// Identifies a page of bbsim; found at the beginning of the template.
inline constexpr const char* page_mark = "A replay made by bbsim";

// The most rows that each run of a page may keep.
[[nodiscard]] std::size_t rows_allowed(const Scene& scene);

}  // namespace bbsim::replay
