// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// One HTML file that replays a scene: it opens offline, and asks for nothing.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "replay/scene.hpp"

namespace bbsim::replay {

// The page's template with the scene in it. Times are kept as doubles, all other numbers of runs as
// floats, orientations in steps of 1/32767, sweeps' keys as doubles. Long runs keep the rows that
// kept_rows() says, at most 20,000 and 2.4 MB of numbers in all runs together; sweeps keep
// cases_kept(). Every text of the scene arrives in the page as text, whatever is in it. Throws
// InputError for a scene that cannot be shown (check_scene()) or a template that is none.
[[nodiscard]] std::string page(const Scene& scene, std::string_view page_template);

// The template, which CMake puts together: read from share/bbsim beside the program, or from
// BBSIM_SHARE_PATH. Throws OutputError if it is not there, with what to do.
[[nodiscard]] std::string page_template();

// Reads the template as above, from one of these folders.
[[nodiscard]] std::string page_template(const std::vector<std::string>& folders);

// By which a page of bbsim's is known: it stands at the beginning of the template.
inline constexpr const char* page_mark = "A replay made by bbsim";

// The file of the template, as page_template() finds it; empty if it is not there.
[[nodiscard]] std::string template_file();

// Rows that each run of a page may keep.
[[nodiscard]] std::size_t rows_allowed(const Scene& scene);

// page(scene, page_template()), whole or not at all; "-" is standard output.
void write_page(const std::string& file, const Scene& scene);

}  // namespace bbsim::replay
