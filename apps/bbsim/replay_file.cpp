// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay_file.hpp"

#include <cstdio>

#include "base/error.hpp"
#include "file/format.hpp"
#include "removed.hpp"
#include "replay/page.hpp"
#include "replay/template.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

std::string size_text(std::size_t bytes) {
  char text[40];
  std::snprintf(text, sizeof text, "%.2f MB", static_cast<double>(bytes) / 1e6);
  return text;
}

std::string count_text(std::size_t count, const char* singular, const char* plural) {
  return std::to_string(count) + ' ' + (count == 1 ? singular : plural);
}

std::string content_text(const replay::Scene& scene) {
  std::size_t rows = 0, cases = 0;
  for (const replay::Run& run : scene.runs) rows += replay::rows_of_file(run);
  for (const replay::Sweep& sweep : scene.sweeps) cases += sweep.status.size();
  if (scene.runs.empty()) return count_text(cases, "case", "cases");
  const std::string text = count_text(rows, "row", "rows");
  return scene.runs.size() == 1 ? text : std::to_string(scene.runs.size()) + " runs, " + text;
}

}  // namespace

void require_replay_ending(const std::string& file, const std::string& option) {
  if (file == "-" || file::lower_ending(file) == ".html") return;
  const std::string gone = removed_ending(file::lower_ending(file));
  if (!gone.empty()) throw InputError(option + ": found " + file + ": " + gone);
  throw InputError(option + ": found " + file + "; allowed: a name that ends in .html");
}

void declare_replay(file::Outputs& outputs, const std::string& file, const std::string& what) {
  outputs.reads(replay::file_of_template(replay::replay_name), "the template of pages");
  outputs.reads(replay::file_of_template(replay::engine_name), "the engine of live pages");
  outputs.writes(file, what);
}

ReplayFile::ReplayFile(const std::string& target, bool live)
    : target_(target),
      template_(replay::read_template(replay::replay_name)),
      engine_(live ? replay::read_template(replay::engine_name) : ""),
      file_(target) {}

void ReplayFile::write(const replay::Scene& scene, bool quiet) {
  const std::string content = replay::page(scene, template_, engine_);
  file_.write(content);
  file_.commit();
  if (quiet || target_ == "-") return;
  say(target_ + ": " + content_text(scene) + ", " + size_text(content.size()));
}

}  // namespace bbsim::app
