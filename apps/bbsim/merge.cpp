#include "record/merge.hpp"

#include <CLI/App.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"
#include "record/outputs.hpp"
#include "signals.hpp"

namespace bbsim::app {
namespace {

struct MergeArguments {
  std::vector<std::string> parts;
  std::string output;
};

ExitCode merge(const MergeArguments& arguments, const Options& options) {
  record::Outputs outputs;
  for (const std::string& part : arguments.parts) {
    outputs.reads(part, "a part");
    if (const std::string plan = record::plan_of_part(part); !plan.empty()) {
      outputs.reads(plan, "the plan of " + part);
    }
  }
  outputs.writes(arguments.output, "-o");
  const record::Merged merged =
      record::merge_cases(arguments.parts, arguments.output, watch_signals());
  if (!merged.note.empty()) std::fprintf(stderr, "%s\n", merged.note.c_str());
  if (merged.interrupted) {
    if (!options.quiet) std::fprintf(stderr, "interrupted; nothing was written.\n");
    return ExitCode::interrupted;
  }
  if (!options.quiet) {
    std::fprintf(stderr, "%s: %zu cases from %zu parts\n", arguments.output.c_str(), merged.cases,
                 arguments.parts.size());
  }
  return ExitCode::done;
}

}  // namespace

void add_merge(CLI::App& app, const Options& options, Chosen& chosen) {
  CLI::App* command =
      app.add_subcommand("merge", "Put the parts of a sweep (bbsim sweep --shard) together");
  command->fallthrough();
  const auto arguments = std::make_shared<MergeArguments>();
  command->add_option("PARTS", arguments->parts, "files of all shards, in any order")->required();
  command
      ->add_option("-o,--output", arguments->output,
                   "FILE.csv or FILE.h5, as the parts; - for CSV on standard output")
      ->required();
  command->callback([arguments, &options, &chosen] {
    chosen = [arguments, &options] { return merge(*arguments, options); };
  });
}

}  // namespace bbsim::app
