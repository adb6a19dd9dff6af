// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The scenario of a rig that `bbsim new rig` writes.
#include <string>
#include <vector>

#include "catch.hpp"
#include "shell.hpp"

namespace bbsim_test::test_new_rig {

TEST_CASE("on a terminal, a rig without options is set up by questions") {
  const Folder folder;
  const std::string ball = "[ping-pong]: ", servo = "[hobby-standard]: ";
  const auto check = [&](const std::string& words, const std::string& typed,
                         const std::vector<std::string>& shown,
                         const std::vector<std::string>& written) {
    const std::string screen = on_terminal("new rig -o my.yaml --force" + words, 120, folder, 20,
                                           "bbsim replay", "xterm", typed);
    expect(0, Result{words, 0, folder.read("my.yaml"), screen, 0}, shown, written);
  };
  // An invalid answer is asked again; Enter takes the default.
  check("", "250\n250 mm\n\nsmart-serial\ntouch 50 Hz\n3\n",
        {"for a disc [300 mm x 200 mm]: ", "--plate: found 250; allowed: two sides", ball, servo,
         "[camera 30 Hz]: ", "[2]: "},
        {"diameter: \"250 mm\"", "mass: \"2.7 g\"", "model: smart-serial ", "period: \"50 Hz\"",
         "of a step", "three_servos: "});
  // Ctrl-D takes all remaining defaults.
  check("", "250 mm\n\x04", {"!" + servo},
        {"diameter: \"250 mm\"", "model: hobby-standard ", "period: \"30 Hz\""});
  // With enough options, nothing is asked.
  check(" --legs 3", "", {"!" + ball}, {"three_servos: "});
}

}  // namespace bbsim_test::test_new_rig
