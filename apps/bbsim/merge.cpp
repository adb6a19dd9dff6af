// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim merge`: joins the parts of a sweep.
#include <memory>
#include <string>
#include <vector>

#include "api/sweep.hpp"
#include "commands.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct MergeArguments {
  std::vector<std::string> parts;
  std::string output;
};

ExitCode merge(const MergeArguments& arguments, const Options& options) {
  Progress progress("merge", options.quiet);
  const api::MergeResult merged = api::merge(arguments.parts, arguments.output, progress);
  if (!merged.note.empty() && !options.quiet) say(merged.note);
  if (merged.code != ExitCode::done) {
    say("interrupted; nothing was written.");
    return merged.code;
  }
  if (!options.quiet) {
    say(name_of_output(arguments.output) + ": " + std::to_string(merged.cases) + " cases from " +
        std::to_string(arguments.parts.size()) + " parts");
  }
  return ExitCode::done;
}

}  // namespace

void add_merge(Command& command, const Options& options) {
  const auto arguments = std::make_shared<MergeArguments>();
  command.option("PARTS", arguments->parts, "the files of all shards, in any order").required();
  command
      .option("-o,--output", arguments->output,
              "write FILE.csv or FILE.h5, like the parts; - is CSV on standard output")
      .takes("FILE")
      .required();
  command.does([arguments, &options] { return merge(*arguments, options); });
}

}  // namespace bbsim::app
