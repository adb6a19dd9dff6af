// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs another program to its end.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace bbsim::file {

struct Finished {
  int status = 0;  // from waitpid()
  std::string output, complaint;
  [[nodiscard]] bool well() const;  // it exited with code 0
};

// Runs the program words[0], from the PATH, with `input` as its standard input. Returns nothing if
// the program does not exist. Throws OutputError: "cannot `purpose`: why".
[[nodiscard]] std::optional<Finished> run_program(const std::vector<std::string>& words,
                                                  const std::string& input,
                                                  const std::string& purpose);

}  // namespace bbsim::file
