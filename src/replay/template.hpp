// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads templates of pages, which CMake assembles (src/replay/page), and fills them with data.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace bbsim::replay {

inline constexpr const char* replay_name = "replay.html";
inline constexpr const char* engine_name = "engine.html";  // scripts/build wasm makes it

// Inserts the title and the data, a JSON text, into the template. All texts appear as text in the
// page, whatever characters they have. Throws InputError for a damaged template.
[[nodiscard]] std::string filled(std::string_view page_template, const std::string& title,
                                 const std::string& json);

// Inserts the engine of a live page into its template. Throws InputError for a damaged template.
[[nodiscard]] std::string with_engine(std::string page_template, std::string_view engine);

// Reads a template, or the engine of live pages, from the first of these folders that has it;
// without folders, from share/bbsim beside the program or BBSIM_SHARE_PATH. Throws OutputError with
// advice if none has it.
[[nodiscard]] std::string read_template(const std::string& name,
                                        const std::vector<std::string>& folders = {});

// The file that read_template() reads; empty if it is not there.
[[nodiscard]] std::string file_of_template(const std::string& name);

}  // namespace bbsim::replay
