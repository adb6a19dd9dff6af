// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Another program, run to its end.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bbsim::file {

struct Finished {
  int status = 0;  // as of waitpid
  std::string output, complaint;
  [[nodiscard]] bool well() const;  // it ended by itself, with exit code 0
};

// Runs words[0], looked for on the PATH, with `input` at its standard input; nothing if there is no
// such program. Throws OutputError: "cannot `purpose`: why".
[[nodiscard]] std::optional<Finished> run_program(const std::vector<std::string>& words,
                                                  const std::string& input,
                                                  const std::string& purpose);

}  // namespace bbsim::file
