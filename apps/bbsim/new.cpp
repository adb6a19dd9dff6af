// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "embedded.hpp"
#include "file/share_folders.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

namespace fs = std::filesystem;

struct NewArguments {
  std::string what, language, output;
  bool force = false;
};

// A folder with bbsim/controller.h, for C compilers.
std::string header_folder() {
  for (const std::string& share : file::share_folders()) {
    const fs::path folder = fs::path(share) / "arduino";
    std::error_code error;
    if (fs::exists(folder / "bbsim/controller.h", error)) return folder.string();
  }
  return "PREFIX/include";
}

// How the controller in `file` is run.
std::string how_to_run(const std::string& language, const std::string& file,
                       const std::string& wiring) {
  const std::string library = fs::path(file).stem().string() + ".so";
  std::string build, key;
  if (language == "python") {
    key = "controller.program.command=[python3, " + file + "]";
  } else if (language == "c") {
    build = "cc -O2 -fPIC -shared -I " + header_folder() + " " + file + " -o " + library;
    key = "controller.library.file=" + library;
  } else {
    build = "bbsim sketch " + file;
    key = "controller.library={file: " + library + ", wiring: " + wiring + "}";
  }
  return (build.empty() ? "" : "  " + build + '\n') +
         "  bbsim examples step\n  bbsim run step.yaml --set controller.pid=null --set \"" + key +
         '"';
}

ExitCode make(const NewArguments& arguments, const Options& options) {
  const std::string& language = arguments.language;
  const std::string name = language == "python" ? "controller.py"
                           : language == "c"    ? "controller.c"
                                                : "controller.ino";
  const bool named = !arguments.output.empty();
  const std::string output = named ? arguments.output : name;
  std::vector<Copy> copies{{output, text_of(template_files(), name)}};
  std::string wiring = "WIRING.yaml";
  if (language == "arduino" && output != "-") {
    wiring = (fs::path(output).parent_path() / fs::path(output).stem()).string() + "-wiring.yaml";
    copies.push_back({wiring, text_of(template_files(), "controller-wiring.yaml")});
  }
  write_copies(copies, named, arguments.force);
  if (options.quiet || output == "-") return ExitCode::done;
  std::string message = output + ": a controller";
  if (copies.size() > 1) message += "; " + wiring + ": what its pins are connected to";
  say(message + ". To run it:\n" + how_to_run(language, output, wiring));
  return ExitCode::done;
}

}  // namespace

void add_new(Command& command, const Options& options) {
  const auto arguments = std::make_shared<NewArguments>();
  command.option("WHAT", arguments->what, "controller").required().takes_one_of({"controller"});
  command.option("LANGUAGE", arguments->language, "python, c or arduino")
      .required()
      .takes_one_of({"python", "c", "arduino"});
  command
      .option("-o,--output", arguments->output,
              "write it to FILE; default: controller.py, controller.c or controller.ino, in the "
              "current folder; - is standard output")
      .takes("FILE");
  command.flag("--force", arguments->force,
               "replace files that -o does not name, whatever they hold");
  command.footer(
      "The controller balances the ball of the scenario that `bbsim examples step` writes. That of "
      "an Arduino comes with a wiring, FILE-wiring.yaml.");
  command.does([arguments, &options] { return make(*arguments, options); });
}

}  // namespace bbsim::app
