// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "catch.hpp"
#include "file/descriptor.hpp"
#include "file/leftovers.hpp"
#include "file/start_process.hpp"

namespace bbsim_test::test_start_process {

using namespace bbsim::file;

namespace {

// Standard output of a shell command; its standard input is empty.
std::string said(const std::string& command, const std::string& folder = "",
                 bool leads_group = false) {
  std::array<int, 2> input{}, output{};
  REQUIRE(pipe(input.data()) == 0);
  REQUIRE(pipe(output.data()) == 0);
  const Descriptor reads(input[0]), says(output[0]);
  Descriptor its_end(output[1]), nothing(input[1]);
  nothing.close();
  int error = 0;
  const std::vector<std::string> words{"sh", "-c", command};
  const pid_t id =
      start_process({words, reads.get(), its_end.get(), -1, folder, leads_group}, error);
  REQUIRE(id > 0);
  its_end.close();
  std::string text;
  std::array<char, 256> part{};
  for (ssize_t got = 0; (got = read(says.get(), part.data(), part.size())) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(got));
  }
  const auto status = wait_for_child(id);
  REQUIRE(status.has_value());
  CHECK(WEXITSTATUS(*status) == 0);
  return text;
}

}  // namespace

TEST_CASE("a process has its streams, its folder and no other descriptor") {
  CHECK(said("cat; echo lost >&2; pwd", "/usr") == "/usr\n");
  CHECK(said("for f in 3 4 5 6 7 8 9; do test -e /proc/$$/fd/$f && echo $f; done; true").empty());
}

TEST_CASE("a process may lead a group") {
  const std::string question =
      "set -- $(cut -d' ' -f5 /proc/$$/stat); test $1 = $$ && echo leads; true";
  CHECK(said(question, "", true) == "leads\n");
  CHECK(said(question).empty());
}

TEST_CASE("a process that cannot be started has a reason") {
  int error = 0;
  CHECK(start_process({{"no-such-program-as-this"}, 0, 1}, error) == 0);
  CHECK(error == ENOENT);
}

}  // namespace bbsim_test::test_start_process
