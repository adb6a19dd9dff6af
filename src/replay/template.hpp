// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Templates of pages, which CMake assembles (src/replay/page), and how data are put into one.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bbsim::replay {

// The template with the title and the data, a JSON text, in it. All texts appear as text in the
// page, whatever characters they have. Throws InputError for a damaged template.
[[nodiscard]] std::string filled(std::string_view page_template, const std::string& title,
                                 const std::string& json);

// Reads a template from the first of these folders that has it. Throws OutputError with advice if
// none does.
[[nodiscard]] std::string read_template(const std::string& name,
                                        const std::vector<std::string>& folders);
// From share/bbsim beside the program or from BBSIM_SHARE_PATH.
[[nodiscard]] std::string read_template(const std::string& name);

// The file that read_template() reads; empty if it is not there.
[[nodiscard]] std::string file_of_template(const std::string& name);

}  // namespace bbsim::replay
