// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Malicious input is refused quickly and with little memory.
#include <sys/stat.h>

#include <algorithm>
#include <random>

#include "catch.hpp"
#include "support/folder.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_hostile {

using namespace bbsim;
using namespace bbsim::test;
using Catch::Matchers::Contains;

namespace {

std::string repeated(const std::string& text, int count) {
  std::string result;
  for (int i = 0; i < count; ++i) result += text;
  return result;
}

std::string file_error(const std::string& file) {
  return message_of<InputError>([&] { static_cast<void>(read_scenario(file)); });
}

}  // namespace

TEST_CASE("endless nesting") {
  const std::string refused = "found nesting deeper than 32 levels; allowed: at most 32";
  const int depth = 100'000;
  std::string block;
  for (int i = 0; i < 1000; ++i) block += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  for (const std::string& text :
       {"a: " + repeated("[", 50) + repeated("]", 50),
        "a: " + repeated("[", depth) + repeated("]", depth),
        "a: " + repeated("{a: ", depth) + repeated("}", depth), repeated("- ", depth), block}) {
    CHECK_THAT(errors(text), Contains(refused));
  }
  for (const char* open : {"[", "{", "? "}) CHECK_FALSE(errors(repeated(open, depth)).empty());
  CHECK_THAT(errors(open_loop, {"a=" + repeated("[", 50) + repeated("]", 50)}), Contains(refused));
}

TEST_CASE("aliases that multiply") {
  std::string bomb = open_loop + "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 25; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + below +
            repeated(", " + below, 9) + "]\n";
  }
  CHECK_THAT(errors(bomb), Contains("a24: unknown key"));

  std::string chain = "a0: &a0 [x]\n";
  for (int i = 1; i < 20'000; ++i) {
    const std::string name = "a" + std::to_string(i);
    chain.append(name).append(": &").append(name);
    chain.append(" [*a").append(std::to_string(i - 1)).append("]\n");
  }
  CHECK_THAT(errors(chain), Contains("found nesting deeper than 32 levels"));
}

TEST_CASE("more values than a scenario has") {
  CHECK_THAT(errors("a: [" + repeated("1,", 400'000) + "]"), Contains("more than 100000 values"));
  CHECK_THAT(errors("a: [" + repeated("+,", 400'000) + "]"), Contains("more than 100000 values"));
  CHECK_THAT(errors(repeated("gravity: 1\n", 80'000)), Contains("and 79953 more problems"));
  CHECK_THAT(errors(repeated("{", 1'000'000)), Contains("scenario.yaml:1:1: "));
}

TEST_CASE("files that are not scenarios") {
  const Folder folder;
  CHECK(file_error(folder / "absent") ==
        (folder / "absent") + ": cannot be read: No such file or directory");
  CHECK(file_error(folder / "") == (folder / "") + ": found a folder; allowed: a scenario file");
  CHECK(file_error("/dev/zero") ==
        "/dev/zero: found more than 1048576 bytes; allowed: a scenario of at most 1048576 bytes");
  CHECK(file_error("/dev/null").starts_with("/dev/null:1:1: found an empty file;"));

  const std::string sparse = folder.put("sparse", "");
  std::filesystem::resize_file(sparse, 200'000'000);
  CHECK(file_error(sparse) ==
        sparse + ": found 200000000 bytes; allowed: a scenario of at most 1048576 bytes");

  const std::string pipe = folder / "pipe";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  CHECK(file_error(pipe) == pipe + ": found nothing within 5 s; allowed: a file, or a pipe in use");
}

TEST_CASE("the largest file") {
  const Folder folder;
  const std::string padding(1048576 - open_loop.size() - 1, '#');
  CHECK(file_error(folder.put("largest", open_loop + padding + "\n")).empty());
  CHECK_THAT(file_error(folder.put("larger", open_loop + padding + "#\n")),
             Contains("found 1048577 bytes"));
}

TEST_CASE("damaged files are read or refused, never worse") {
  std::mt19937 random(20240229);  // fixed, so that failures are reproducible
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random()) % n; };
  const std::string alphabet = "{}[]:,-?&*!|>'\"%@`# \n\t\\0123456789.eE+abcxyz~<=\r\x01\xC2\xA0";

  std::vector<std::string> files;
  for (const auto& entry :
       std::filesystem::directory_iterator(BBSIM_SOURCE_DIR "/tests/data/scenarios")) {
    std::ifstream in(entry.path());
    files.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  std::ranges::sort(files);
  REQUIRE(files.size() >= 8);

  int refused = 0;
  const int runs = 4000;
  for (int run = 0; run < runs; ++run) {
    std::string text = files[below(files.size())];
    const std::size_t damages = 1 + below(6);
    for (std::size_t i = 0; i < damages && !text.empty(); ++i) {
      const std::size_t at = below(text.size());
      switch (below(5)) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text[at] = alphabet[below(alphabet.size())];
          break;
        case 2:
          text.insert(at, 1, alphabet[below(alphabet.size())]);
          break;
        case 3:
          text.erase(at, 1 + below(8));
          break;
        default:
          text.insert(at, text.substr(below(text.size()), below(40)));
      }
    }
    if (!errors(text).empty()) ++refused;
  }
  // Some damage, inside the title, leaves a valid scenario; most does not.
  CHECK(refused > runs / 4);
  CHECK(refused < runs);
}

}  // namespace bbsim_test::test_hostile
