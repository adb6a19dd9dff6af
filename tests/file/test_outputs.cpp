// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// No output of a command may be another of its files, whatever its name.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/error.hpp"
#include "catch.hpp"
#include "file/outputs.hpp"
#include "support/child.hpp"
#include "support/folder.hpp"

namespace bbsim_test::test_outputs {

using bbsim::InputError;
using bbsim::file::Outputs;
using Catch::Matchers::Contains;

namespace {

// Why an output is refused, given one input and another output.
std::string refusal(const std::string& read, const std::string& written, const std::string& file) {
  return message_of<InputError>([&] {
    Outputs outputs;
    if (!read.empty()) outputs.reads(read, "the scenario");
    if (!written.empty()) outputs.writes(written, "-o");
    outputs.writes(file, "--summary");
  });
}

}  // namespace

TEST_CASE("two outputs to standard output are refused, whatever it is connected to") {
  CHECK_THAT(refusal("", "-", "-"), Contains("it is the same file as standard output (-o)"));
  CHECK(refusal("", "/dev/null", "-").empty());
}

TEST_CASE("an output that is an input is refused, by any path and through any link") {
  const Folder folder;
  const std::string file = folder.put("a.yaml", "x");
  std::filesystem::create_directory(folder / "sub");
  std::filesystem::create_symlink("a.yaml", folder / "link");
  std::filesystem::create_symlink("../link", folder / "sub/link");
  std::filesystem::create_symlink("/dev/stdin", folder / "input");
  REQUIRE(link(file.c_str(), (folder / "hard").c_str()) == 0);
  const std::string text = refusal(file, "", file);
  CHECK(text == "cannot write " + file + " (--summary): it is the same file as " + file +
                    " (the scenario), which is read here; allowed: a file of its own");
  for (const char* name : {"link", "sub/link", "hard", "sub/../a.yaml", "./a.yaml"}) {
    CHECK_THAT(refusal(file, "", folder / name), Contains("the same file as " + file));
    CHECK_THAT(refusal(folder / name, "", file), Contains("which is read here"));
  }
  CHECK(refusal(file, "", folder / "b.yaml").empty());
  CHECK(refusal(file, "", folder / "sub/a.yaml").empty());
}

TEST_CASE("two outputs into one file are refused, existing or not") {
  const Folder folder;
  std::filesystem::create_directory(folder / "sub");
  std::filesystem::create_symlink("sub/new.csv", folder / "link.csv");
  CHECK_THAT(refusal("", folder / "new.csv", folder / "new.csv"),
             Contains("(-o), which is written here, too"));
  CHECK_THAT(refusal("", folder / "new.csv", folder / "sub/../new.csv"), Contains("same file"));
  CHECK_THAT(refusal("", folder / "link.csv", folder / "sub/new.csv"), Contains("same file"));
  CHECK(refusal("", folder / "new.csv", folder / "sub/new.csv").empty());
  CHECK(refusal("", folder / "new.csv", folder / "new.json").empty());
  CHECK(refusal("", folder / "none/a.csv", folder / "none/a.csv").empty());  // cannot be written
}

TEST_CASE("devices and pipes never conflict") {
  const Folder folder;
  REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
  for (const std::string& name : {std::string("/dev/null"), folder / "fifo"}) {
    CHECK(refusal(name, name, name).empty());
  }
}

TEST_CASE("a standard stream redirected to a file counts as that file") {
  const Folder folder;
  const std::string file = folder.put("a.yaml", "x");
  CHECK(status_of_child([&] {
          dup2(open(file.c_str(), O_WRONLY | O_APPEND), STDOUT_FILENO);
          for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
            if (refusal(file, "", name).find("same file") == std::string::npos) return 1;
          }
          return refusal("", "-", "/dev/stdout").find("standard output (-o)") == std::string::npos
                     ? 2
                     : 0;
        }) == 0);
  CHECK(status_of_child([&] {
          dup2(open(file.c_str(), O_RDONLY), STDIN_FILENO);
          return refusal("-", "", file).find("standard input (the scenario)") == std::string::npos
                     ? 1
                     : 0;
        }) == 0);
}

}  // namespace bbsim_test::test_outputs
