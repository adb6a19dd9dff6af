// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Checks CITATION.cff against the required fields of the Citation File Format 1.2.0, and against
// the program's version and license.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "catch.hpp"

namespace bbsim_test::test_citation {

namespace {

constexpr std::array known_keys{"abstract",
                                "authors",
                                "cff-version",
                                "commit",
                                "contact",
                                "date-released",
                                "doi",
                                "identifiers",
                                "keywords",
                                "license",
                                "license-url",
                                "message",
                                "preferred-citation",
                                "references",
                                "repository",
                                "repository-artifact",
                                "repository-code",
                                "title",
                                "type",
                                "url",
                                "version"};

std::string text_of(const YAML::Node& node) {
  return node && node.IsScalar() ? node.Scalar() : "";
}

// Faults of a list of persons and entities; both kinds need a name.
std::vector<std::string> faults_of_authors(const YAML::Node& authors) {
  if (!authors || !authors.IsSequence() || authors.size() == 0) return {"no authors"};
  std::vector<std::string> faults;
  for (const YAML::Node& author : authors) {
    const bool is_entity = !text_of(author["name"]).empty();
    const bool is_person =
        !text_of(author["given-names"]).empty() && !text_of(author["family-names"]).empty();
    if (is_entity == is_person) faults.emplace_back("an author is neither person nor entity");
  }
  return faults;
}

std::vector<std::string> faults_of(const YAML::Node& citation) {
  std::vector<std::string> faults = faults_of_authors(citation["authors"]);
  if (text_of(citation["cff-version"]) != "1.2.0") faults.emplace_back("cff-version");
  for (const char* key : {"message", "title"}) {
    if (text_of(citation[key]).empty()) faults.emplace_back(key);
  }
  for (const auto& entry : citation) {
    const std::string key = text_of(entry.first);
    if (std::ranges::find(known_keys, std::string_view(key)) == known_keys.end()) {
      faults.push_back("unknown key " + key);
    }
  }
  std::vector<YAML::Node> references;
  for (const YAML::Node& reference : citation["references"]) references.push_back(reference);
  if (citation["preferred-citation"]) references.push_back(citation["preferred-citation"]);
  for (const YAML::Node& reference : references) {
    for (const char* key : {"title", "type"}) {
      if (text_of(reference[key]).empty()) faults.push_back(std::string("reference: ") + key);
    }
    for (const std::string& fault : faults_of_authors(reference["authors"])) {
      faults.push_back("reference: " + fault);
    }
  }
  return faults;
}

std::string source_file(const std::string& name) {
  return std::string(BBSIM_SOURCE_DIR) + "/" + name;
}

}  // namespace

TEST_CASE("CITATION.cff conforms to its format and names this version and the paper") {
  const YAML::Node citation = YAML::LoadFile(source_file("CITATION.cff"));
  CHECK(faults_of(citation).empty());
  CHECK(text_of(citation["version"]) == BBSIM_VERSION);
  CHECK(text_of(citation["license"]) == "BSD-3-Clause");
  REQUIRE(citation["references"].size() == 1);
  CHECK(text_of(citation["references"][0]["title"]) ==
        "On the Dynamics of a Ball Rolling on a Tipping Plane");
}

TEST_CASE("faults of a citation file are found") {
  CHECK(faults_of(YAML::Load("{cff-version: 1.2.0, message: a, title: b, authors: [{name: c}]}"))
            .empty());
  const char* const faulty[] = {
      "{cff-version: 1.1.0, message: a, title: b, authors: [{name: c}]}",
      "{cff-version: 1.2.0, title: b, authors: [{name: c}]}",
      "{cff-version: 1.2.0, message: a, authors: [{name: c}]}",
      "{cff-version: 1.2.0, message: a, title: b, authors: []}",
      "{cff-version: 1.2.0, message: a, title: b, authors: [{family-names: c}]}",
      "{cff-version: 1.2.0, message: a, title: b, autors: [], authors: [{name: c}]}",
      "{cff-version: 1.2.0, message: a, title: b, authors: [{name: c}], references: [{title: d}]}",
  };
  for (const char* text : faulty) {
    CAPTURE(text);
    CHECK_FALSE(faults_of(YAML::Load(text)).empty());
  }
}

}  // namespace bbsim_test::test_citation
