// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenarios that are refused: refused/*.yaml lists them, each with what its messages name. Each
// problem has a place, and says what is allowed.
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "catch.hpp"
#include "support/folder.hpp"
#include "support/reading.hpp"

namespace bbsim_test::test_refused {

using namespace bbsim;

namespace {

using Words = std::vector<std::string>;

// A text, or a list of texts.
Words words_of(const YAML::Node& node) {
  return node.IsSequence() ? node.as<Words>() : Words{node.as<std::string>()};
}

// Whether `text` contains the parts of `wanted`, which "..." separates, in this order.
bool contains(const std::string& text, const std::string& wanted) {
  const std::string gap = " ... ";
  std::size_t at = 0;
  for (std::size_t begin = 0; begin <= wanted.size();) {
    const std::size_t end = std::min(wanted.find(gap, begin), wanted.size());
    const std::string part = wanted.substr(begin, end - begin);
    at = text.find(part, at);
    if (at == std::string::npos) return false;
    at += part.size();
    begin = end + gap.size();
  }
  return true;
}

// [BASE, CHANGES, SAYS, FILES]. BASE is a name or a text; a change is KEY=VALUE for --set, or text
// behind the base after a "+".
struct Refused {
  Refused(const YAML::Node& bases, const YAML::Node& one) : text(one[0].as<std::string>()) {
    if (bases[text]) text = bases[text].as<std::string>();
    for (const std::string& change : words_of(one[1])) {
      if (change.starts_with('+')) {
        text += change.substr(1) + '\n';
      } else if (!change.empty()) {
        overrides.push_back(change);
      }
    }
    says = words_of(one[2]);
  }

  // The problems found; places in the scenario without its folder.
  [[nodiscard]] std::vector<Problem> problems(const Folder& folder) const {
    try {
      static_cast<void>(parse_scenario(text, folder / "scenario.yaml", overrides));
    } catch (const InputError& error) {
      std::vector<Problem> found = error.problems();
      for (Problem& one : found) {
        const std::size_t path = one.where.find(folder / "");
        if (path == 0) one.where.erase(0, (folder / "").size());
      }
      return found;
    }
    return {};
  }

  [[nodiscard]] bool is_place(const std::string& where) const {
    if (where.starts_with("scenario.yaml:")) return true;
    return std::ranges::any_of(overrides,
                               [&](const std::string& one) { return where == "--set " + one; });
  }

  std::string text;
  Words overrides, says;
};

// Only faults of YAML itself, which have no key, and of files may leave that out.
bool says_what_is_allowed(const std::string& message) {
  if (message.starts_with("found ")) return true;
  return std::ranges::any_of(
      Words{"allowed: ", "did you mean ", "known keys here: ", "cannot read "},
      [&](const std::string& part) { return message.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("bad scenarios are refused at their place, with what is allowed") {
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(BBSIM_SOURCE_DIR "/tests/scenario/refused")) {
    const YAML::Node page = YAML::LoadFile(entry.path());
    const Folder folder;
    for (const YAML::Node& one : page["refused"]) {
      const Refused refused(page["bases"], one);
      for (const YAML::Node& files : {page["files"], one[3]}) {
        if (!files) continue;
        for (const auto& file : files) {
          folder.put(file.first.as<std::string>(), file.second.as<std::string>());
        }
      }
      CAPTURE(entry.path().filename(), refused.text, refused.overrides);
      const std::vector<Problem> found = refused.problems(folder);
      CHECK(found.size() == refused.says.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        const std::string line = found[i].where + ": " + found[i].message;
        CAPTURE(line);
        CHECK(refused.is_place(found[i].where));
        CHECK(says_what_is_allowed(found[i].message));
        CHECK(contains(line, i < refused.says.size() ? refused.says[i] : "nothing"));
      }
      ++count;
    }
  }
  CHECK(count > 300);
}

}  // namespace bbsim_test::test_refused
