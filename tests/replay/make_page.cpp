// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes a page of results for browser tests.
//
//   make_page [--title TEXT] [--template FILE] -o FILE RUN...
//   make_page [--title TEXT] [--template FILE] -o FILE --sweep SWEEP.csv SCENARIO.yaml
//
// RUN is RESULT.csv[,SCENARIO.yaml[,SUMMARY.json[,CHECK.txt]]].
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "file/atomic_file.hpp"
#include "make_scene.hpp"
#include "replay/page.hpp"
#include "support/folder.hpp"

namespace {

void make(const std::vector<std::string>& arguments) {
  bbsim::replay::Scene scene;
  scene.version = "0.0.0-test";
  std::string output, page_template;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "-o") {
      output = arguments.at(++i);
    } else if (arguments[i] == "--title") {
      scene.title = arguments.at(++i);
    } else if (arguments[i] == "--template") {
      page_template = content_of(arguments.at(++i));
    } else if (arguments[i] == "--sweep") {
      const std::string& table = arguments.at(++i);
      scene.sweeps.push_back(bbsim_test::sweep_of(table, arguments.at(++i)));
    } else {
      scene.runs.push_back(bbsim_test::run_of(arguments[i]));
    }
  }
  if (scene.title.empty() && !scene.runs.empty()) scene.title = scene.runs.front().title;
  if (scene.title.empty() && !scene.sweeps.empty()) scene.title = scene.sweeps.front().title;
  bbsim::file::write_file(output, bbsim::replay::page(scene, page_template));
}

}  // namespace

int main(int count, char** values) {
  try {
    make(std::vector<std::string>(values + 1, values + count));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_page: %s\n", error.what());
    return 1;
  }
}
