// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim sketch`: compiles an Arduino sketch as a controller.
#include <filesystem>
#include <string>

#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "sketch/compile.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct SketchArguments {
  sketch::Job job;
  std::string output;
  bool force = false;
};

// Remedy that the compiler's messages do not name.
std::string hint(const std::string& messages) {
  const std::size_t end = messages.find(": No such file or directory");
  if (end == std::string::npos) return "";
  const std::size_t begin = messages.rfind(' ', end) + 1;
  return "\n" + messages.substr(begin, end - begin) +
         " belongs to a library: name the library's folder with -I";
}

ExitCode compile(const SketchArguments& arguments, const Options& options) {
  const std::string& first = arguments.job.files.front();
  const std::string output = arguments.output.empty()
                                 ? std::filesystem::path(first).stem().string() + ".so"
                                 : arguments.output;
  file::Outputs outputs;
  for (const std::string& name : sketch::files_of(arguments.job)) {
    outputs.reads(name, "a source of the sketch");
  }
  outputs.writes(output, "-o");
  if (arguments.output.empty() && !arguments.force) {
    file::require_like(output, {"a library of bbsim sketch", "", sketch::library_mark});
  }
  const sketch::Compiled compiled = sketch::compile(arguments.job);
  if (compiled.library.empty()) {
    throw InputError(compiled.messages + first + " does not compile" + hint(compiled.messages));
  }
  file::write_file(output, compiled.library);
  if (!options.quiet) say(compiled.messages + name_of_output(output) + ": a controller.library");
  return ExitCode::done;
}

}  // namespace

void add_sketch(Command& command, const Options& options) {
  SketchArguments& arguments = command.does(compile, options);
  command.option("FILES", arguments.job.files, "the sketch: one .ino, or several, in their order")
      .required();
  command.option("-o,--output FILE", arguments.output,
                 "write the library to FILE.so; default: the first file's name with .so, in the "
                 "current folder");
  command.option("-I,--libraries FOLDER", arguments.job.folders,
                 "look for libraries in FOLDER, which holds one library or several; repeatable");
  add_force(command, arguments.force);
  command.footer(
      "The compiler is $CXX, c++ or g++. A scenario names the library, and the wiring of its "
      "pins:\n"
      "controller: {library: {file: FILE.so, wiring: FILE.yaml}, ...}");
}

}  // namespace bbsim::app
