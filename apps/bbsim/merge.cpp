// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/merge.hpp"

#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "file/outputs.hpp"
#include "signals.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct MergeArguments {
  std::vector<std::string> parts;
  std::string output;
};

ExitCode merge(const MergeArguments& arguments, const Options& options) {
  file::Outputs outputs;
  for (const std::string& part : arguments.parts) {
    outputs.reads(part, "a part");
    if (const std::string plan = sweep::plan_of_part(part); !plan.empty()) {
      outputs.reads(plan, "the plan of " + part);
    }
  }
  outputs.writes(arguments.output, "-o");
  const sweep::Merged merged =
      sweep::merge_cases(arguments.parts, arguments.output, watch_signals());
  if (!merged.note.empty() && !options.quiet) say(merged.note);
  if (merged.interrupted) {
    say("interrupted; nothing was written.");
    return ExitCode::interrupted;
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
