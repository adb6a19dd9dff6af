// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim --licenses, the notices in pages, and CITATION.cff.
#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "catch.hpp"
#include "process.hpp"

namespace bbsim_test::test_licenses {

TEST_CASE("option --licenses prints the license and the notices of all libraries") {
  const Result result = expect(0, call("--licenses"));
  CHECK(result.err.empty());
  CHECK(result.out.starts_with("BSD 3-Clause License\n\nCopyright (c) 2026, the bbsim authors"));
  for (const char* copyright :
       {"2006-2013 Benoit Jacob", "Lawrence Livermore National Security\nand Southern Methodist",
        "2008-2015 Jesse Beder", "2017-2021 University of Cincinnati", "2013-2022 Niels Lohmann",
        "2006-2018, The HDF Group", "2010-2019 three.js authors", "2017 Dan Vanderkam",
        "GCC Runtime Library Exception", "\nMozilla Public License Version 2.0\n===="}) {
    CAPTURE(copyright);
    CHECK(count(result.out, copyright) == 1);
  }
  CHECK(count(result.out, "Permission is hereby granted, free of charge") == 4);
  CHECK_FALSE(contains(result.out.substr(result.out.size() - 50), "\n\n"));

  // Each library that --version names is there.
  const std::string named = lines(call("--version").out).at(3);
  REQUIRE(named.starts_with("libraries: "));
  const std::vector<std::string> libraries = split(named.substr(10), ',');
  CHECK(libraries.size() == 6);
  for (const std::string& library : libraries) {
    std::string name = split(library, ' ').at(1);
    if (name == "nlohmann-json") name = "JSON for Modern C++";
    CAPTURE(name);
    CHECK((contains(result.out, "\n\n" + name + ", https://") ||
           contains(result.out, "\n\n" + name + " (")));
  }
}

TEST_CASE("a run's page has the notices of exactly its libraries, once each") {
  const Folder folder;
  expect(0, "replay @fig2a.yaml -q -o a.html", folder);
  const std::string page = folder.read("a.html");
  for (const char* notice :
       {"three.js, https://threejs.org, MIT license\n\nCopyright (c) 2010-2019 "
        "three.js authors\n\nPermission is hereby granted",
        "dygraphs, https://dygraphs.com, MIT license\n\nCopyright (c) 2006,"}) {
    CAPTURE(notice);
    CHECK(count(page, notice) == 1);
  }
  CHECK(count(page, "copies or substantial portions of the Software.\n\nTHE SOFTWARE") == 2);

  expect(0, "sweep @fig2a.yaml --vary ball.radius=list:0.02,0.03 -q -o s.csv", folder);
  expect(0, "replay s.csv -q -o s.html", folder);
  CHECK(count(folder.read("s.html"), "MIT license") == 0);
}

TEST_CASE("CITATION.cff names this version and the paper") {
  const YAML::Node citation = YAML::LoadFile(BBSIM_SOURCE_DIR "/CITATION.cff");
  CHECK(citation["version"].as<std::string>() == BBSIM_VERSION);
  CHECK(citation["license"].as<std::string>() == "BSD-3-Clause");
  CHECK(citation["references"][0]["title"].as<std::string>() ==
        "On the Dynamics of a Ball Rolling on a Tipping Plane");
}

}  // namespace bbsim_test::test_licenses
