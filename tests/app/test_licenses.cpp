// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim --licenses, and the notices in pages.
#include <string>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_licenses {

using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++times;
  }
  return times;
}

}  // namespace

TEST_CASE("option --licenses prints the license and the notices of all libraries") {
  const Result result = bbsim({"--licenses"});
  REQUIRE(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK_THAT(result.out,
             StartsWith("BSD 3-Clause License\n\nCopyright (c) 2026, the bbsim authors"));
  for (const char* copyright :
       {"2006-2013 Benoit Jacob", "Lawrence Livermore National Security\nand Southern Methodist",
        "2008-2015 Jesse Beder", "2017-2021 University of Cincinnati", "2013-2022 Niels Lohmann",
        "2006-2018, The HDF Group", "2010-2019 three.js authors", "2017 Dan Vanderkam",
        "GCC Runtime Library Exception"}) {
    CAPTURE(copyright);
    CHECK(count(result.out, copyright) == 1);
  }
  CHECK(count(result.out, "Permission is hereby granted, free of charge") == 4);
  CHECK(count(result.out, "\nMozilla Public License Version 2.0\n====") == 1);
  CHECK(result.out.substr(result.out.size() - 50).find("\n\n") == std::string::npos);
}

TEST_CASE("option --licenses covers every library that --version names") {
  const std::string version = bbsim({"--version"}).out;
  const std::string licenses = bbsim({"--licenses"}).out;
  const std::string mark = "libraries: ";
  REQUIRE(version.find(mark) != std::string::npos);
  std::string rest = version.substr(version.find(mark) + mark.size());
  int libraries = 0;
  while (!rest.empty()) {
    std::string name = rest.substr(0, rest.find(' '));
    if (name == "nlohmann-json") name = "JSON for Modern C++";
    CAPTURE(name);
    CHECK_THAT(licenses, Contains("\n\n" + name + ", https://") || Contains("\n\n" + name + " ("));
    ++libraries;
    const std::size_t comma = rest.find(", ");
    rest = comma == std::string::npos ? "" : rest.substr(comma + 2);
  }
  CHECK(libraries == 6);
}

TEST_CASE("a run's page has the notices of exactly its libraries, once each") {
  const Folder folder;
  REQUIRE(bbsim({"replay", config("fig2a.yaml"), "-q", "-o", "a.html"}, folder.path()).exit_code ==
          0);
  const std::string page = folder.read("a.html");
  for (const char* notice :
       {"<script>\n/*!\nthree.js, https://threejs.org, MIT license\n\nCopyright (c) 2010-2019 "
        "three.js authors\n\nPermission is hereby granted",
        "<script>\n/*!\ndygraphs, https://dygraphs.com, MIT license\n\nCopyright (c) 2006,"}) {
    CAPTURE(notice);
    CHECK(count(page, notice) == 1);
  }
  CHECK(count(page, "copies or substantial portions of the Software.\n\nTHE SOFTWARE") == 2);
  CHECK(count(page, "SPDX") == 0);

  REQUIRE(bbsim({"sweep", config("fig2a.yaml"), "--vary", "ball.radius=list:0.02,0.03", "-q", "-o",
                 "s.csv"},
                folder.path())
              .exit_code == 0);
  REQUIRE(bbsim({"replay", "s.csv", "-q", "-o", "s.html"}, folder.path()).exit_code == 0);
  CHECK(count(folder.read("s.html"), "/*!\n") == 0);
}

}  // namespace bbsim_test::test_licenses
