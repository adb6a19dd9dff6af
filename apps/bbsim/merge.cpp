#include "record/merge.hpp"

#include <CLI/App.hpp>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "commands.hpp"

namespace bbsim::app {
namespace {

struct MergeArguments {
  std::vector<std::string> parts;
  std::string output;
};

ExitCode merge(const MergeArguments& arguments, const Options& options) {
  const std::size_t cases = record::merge_cases(arguments.parts, arguments.output);
  if (!options.quiet) {
    std::fprintf(stderr, "%s: %zu cases from %zu parts\n", arguments.output.c_str(), cases,
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
