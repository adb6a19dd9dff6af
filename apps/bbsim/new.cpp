// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim new`: writes the template of a controller or a rig; `bbsim examples`: lists and writes the
// scenarios in the program.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "embedded.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/outputs.hpp"
#include "file/share_folders.hpp"
#include "new_rig.hpp"
#include "terminal.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::app {
namespace {

namespace fs = std::filesystem;

struct NewArguments {
  std::string what, language, output;
  RigWords rig{};
  bool force = false;
};

struct Copy {
  std::string file;
  std::string_view text;
};

// Writes the copies. Unless `force`, they must be new files, except that the first one may replace
// a file if -o names it (`named`), and the others may exist with the same text.
void write_copies(const std::vector<Copy>& copies, bool named, bool force) {
  file::Outputs outputs;
  for (const Copy& copy : copies) {
    const bool first = &copy == &copies.front();
    outputs.writes(copy.file, first && named ? "-o" : "its name by default");
    if (force || (first && named)) continue;
    file::require_new(copy.file, first ? nullptr : &copy.text);
  }
  for (const Copy& copy : copies) file::write_file(copy.file, copy.text);
}

// Folder that contains bbsim/controller.h, for C compilers.
std::string header_folder() {
  for (const std::string& share : file::share_folders()) {
    const fs::path folder = fs::path(share) / "arduino";
    std::error_code error;
    if (fs::exists(folder / "bbsim/controller.h", error)) return folder.string();
  }
  return "PREFIX/include";
}

// Tells how to run the controller in `file`.
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

ExitCode make_controller(const NewArguments& arguments, const Options& options) {
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

// Name of the first option that was given; empty if none was.
std::string first_of(const RigWords& words) {
  for (const char* const option :
       {"--plate", "--ball", "--actuator", "--servo", "--camera", "--touch", "--legs"}) {
    if (!words.at(option).empty()) return option;
  }
  return "";
}

ExitCode make_rig(const NewArguments& arguments, const Options& options) {
  const bool named = !arguments.output.empty();
  const std::string output = named ? arguments.output : "my-rig.yaml";
  RigWords words = arguments.rig;
  if (first_of(words).empty() && !options.quiet && can_ask()) ask(words);
  const std::string file = output == "-" ? "my-rig.yaml" : output;
  const std::string scenario = rig_scenario(words, file);
  write_copies({{output, scenario}}, named, arguments.force);
  if (options.quiet || output == "-") return ExitCode::done;
  say(output + ": a scenario of a rig. Its comments say how to find your rig's numbers. Next:\n" +
      "  bbsim check " + file + "\n  bbsim run " + file + "\n  bbsim replay " + file);
  return ExitCode::done;
}

ExitCode make(const NewArguments& arguments, const Options& options) {
  const bool rig = arguments.what == "rig";
  const std::string help = "\nRun bbsim new --help for more information.";
  if (rig && !arguments.language.empty()) {
    throw InputError("found " + arguments.language + ", which bbsim new rig does not take." + help);
  }
  if (rig) return make_rig(arguments, options);
  if (const std::string option = first_of(arguments.rig); !option.empty()) {
    throw InputError(option + ": an option of bbsim new rig" + help);
  }
  if (arguments.language.empty()) throw InputError("LANGUAGE is required" + help);
  return make_controller(arguments, options);
}

constexpr std::string_view ending = ".yaml";

struct ExampleArguments {
  std::string name, output;
  bool force = false;
};

// First sentence of the comment at the start of a scenario.
std::string first_sentence(std::string_view text) {
  std::string sentence;
  while (text.starts_with("# ")) {
    const std::size_t end = text.find('\n');
    sentence += (sentence.empty() ? "" : " ") + std::string(text.substr(2, end - 2));
    text.remove_prefix(end + 1);
  }
  for (std::size_t i = 0; i + 2 < sentence.size(); ++i) {
    const bool ends = sentence[i] == '.' && sentence[i + 1] == ' ';
    if (ends && std::isdigit(static_cast<unsigned char>(sentence[i + 2])) == 0) {  // not "Fig. 2"
      sentence.resize(i + 1);
    }
  }
  if (sentence.ends_with(':')) sentence.back() = '.';
  return sentence;
}

ExitCode list() {
  constexpr std::size_t width = 16;
  std::string report;
  for (const EmbeddedFile& file : example_files()) {
    if (!file.name.ends_with(ending)) continue;
    std::string name(file.name.substr(0, file.name.size() - ending.size()));
    name.resize(std::max(width, name.size()), ' ');
    report += name + ' ' + first_sentence(file.text) + '\n';
  }
  print(report);
  return ExitCode::done;
}

// Finds a scenario, with or without its ending, or a table.
const EmbeddedFile& example(const std::string& name) {
  const auto files = example_files();
  const auto found = std::ranges::find_if(files, [&](const EmbeddedFile& file) {
    return file.name == name || file.name == name + std::string(ending);
  });
  if (found != files.end()) return *found;
  std::vector<std::string_view> known;
  for (const EmbeddedFile& file : files) known.push_back(file.name.substr(0, file.name.find('.')));
  const std::string near(yaml::nearest_name(name, known));
  throw InputError("unknown example " + name +
                   (near.empty() ? "; bbsim examples lists them" : "; did you mean " + near + "?"));
}

ExitCode copy(const ExampleArguments& arguments, const Options& options) {
  const EmbeddedFile& scenario = example(arguments.name);
  const bool named = !arguments.output.empty();
  const std::string output = named ? arguments.output : std::string(scenario.name);
  std::vector<Copy> copies{{output, scenario.text}};
  std::string tables;
  for (const EmbeddedFile& file : example_files()) {
    if (file.name.ends_with(ending) || scenario.text.find(file.name) == std::string_view::npos) {
      continue;
    }
    tables += (tables.empty() ? "" : ", ") + std::string(file.name);
    if (output == "-") continue;
    const auto folder = std::filesystem::path(output).parent_path();
    copies.push_back({(folder / file.name).string(), file.text});
  }
  write_copies(copies, named, arguments.force);
  if (options.quiet) return ExitCode::done;
  if (output != "-") {
    say(output + ": written" + (tables.empty() ? "" : ", with its table " + tables));
  } else if (!tables.empty()) {
    say("it reads " + tables + ": bbsim examples " + tables);
  }
  return ExitCode::done;
}

ExitCode examples(const ExampleArguments& arguments, const Options& options) {
  if (!arguments.name.empty()) return copy(arguments, options);
  if (arguments.output.empty()) return list();
  throw InputError("-o: found without an example's NAME; bbsim examples lists them");
}

}  // namespace

void add_new(Command& command, const Options& options) {
  NewArguments& arguments = command.does(make, options);
  command.option("WHAT", arguments.what, "controller or rig")
      .required()
      .takes_one_of({"controller", "rig"});
  command.option("LANGUAGE", arguments.language, "for a controller: python, c or arduino")
      .takes_one_of({"python", "c", "arduino"});
  command.option("-o,--output FILE", arguments.output,
                 "write it to FILE; default: controller.py, controller.c, controller.ino or "
                 "my-rig.yaml, in the current folder; - is standard output");
  command.flag("--force", arguments.force,
               "replace files that -o does not name, whatever they contain");
  RigWords& rig = arguments.rig;
  command.option(
      "--plate SIZE", rig["--plate"],
      "for a rig: sides along x and y, or the diameter of a disc; default: \"300 mm x 200 mm\"");
  command.option("--ball BALL", rig["--ball"],
                 "for a rig: ping-pong (default), steel, rubber, golf, or diameter and mass, such "
                 "as \"40 mm 2.7 g\"; hollow or solid may follow");
  command
      .option("--actuator", rig["--actuator"],
              "for a rig: servo (default), or stepper: stepper motors")
      .takes_one_of({"servo", "stepper"});
  command
      .option("--servo", rig["--servo"],
              "for a rig: hobby-standard (default), hobby-micro or smart-serial; of stepper "
              "motors: nema14, nema17 or nema23")
      .takes_one_of(servo_classes());
  const Option camera = command.option("--camera RATE", rig["--camera"],
                                       "for a rig: frames per second; default: \"30 Hz\"");
  command
      .option("--touch RATE", rig["--touch"],
              "for a rig: a touch screen instead of a camera, and its readings per second")
      .excludes(camera);
  command
      .option("--legs", rig["--legs"],
              "for a rig: 2 servos with push rods on a gimbal (default), or 3 under the plate")
      .takes_one_of({"2", "3"});
  command.footer(
      "The controller balances the ball of the scenario that `bbsim examples step` writes. An "
      "Arduino sketch comes with a wiring, FILE-wiring.yaml.\n"
      "The rig is a scenario whose comments say how to find the numbers of yours; its gains suit "
      "its delays. On a terminal, bbsim asks for each option of the rig if you give none.\n"
      "\n"
      "Examples:\n"
      "  bbsim new controller python\n"
      "  bbsim new rig\n"
      "  bbsim new rig --plate \"250 mm\" --ball steel --touch \"50 Hz\" -o disc.yaml");
}

void add_examples(Command& command, const Options& options) {
  ExampleArguments& arguments = command.does(examples, options);
  command.option("NAME", arguments.name, "the scenario to write; default: list all");
  command.option("-o,--output FILE", arguments.output,
                 "write it to FILE.yaml, and its table beside it; default: NAME.yaml in the "
                 "current folder; - is standard output");
  command.flag("--force", arguments.force,
               "replace files that -o does not name, whatever they contain");
}

}  // namespace bbsim::app
