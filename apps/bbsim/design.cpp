// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim design`: the motion whose log determines the keys of a rig best.
#include "api/design.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/format.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

struct DesignArguments {
  ScenarioArguments scenario;
  std::vector<std::string> free, noise;
  std::string length, window, tilt, tilt_rate, margin;
  std::optional<double> rate;
  FoundFiles files;
  std::string table, sketch;
  std::size_t threads = 0;

  // A report goes to standard output unless a file does.
  [[nodiscard]] bool reports() const { return files.reports() && table != "-" && sketch != "-"; }
};

// Default: beside the scenario that plays the table.
std::string table_file_of(const DesignArguments& arguments) {
  const std::string& scenario = arguments.files.scenario;
  std::string table = arguments.table;
  if (!table.empty() && table != "-" && file::lower_ending(table) != ".csv") {
    throw InputError("--table: found " + table + "; allowed: FILE.csv, or - for standard output");
  }
  if (!scenario.empty() && (table == "-" || (table.empty() && scenario == "-"))) {
    throw InputError(
        "--table: found no file, and the scenario of -o must name one; allowed: FILE.csv");
  }
  if (table.empty() && !scenario.empty()) {
    // A run of FILE.yaml writes FILE.csv, so choose another name.
    table = std::filesystem::path(scenario).replace_extension().string() + "-motion.csv";
  }
  return table;
}

// Path of the table relative to the scenario's folder.
std::string name_from(const std::string& scenario, const std::string& table) {
  const auto whole = [](const std::string& file) {
    return std::filesystem::absolute(file).lexically_normal();
  };
  return whole(table).lexically_relative(whole(scenario).parent_path()).string();
}

ExitCode design(const DesignArguments& arguments, const Options& options) {
  const auto& [file, overrides] = arguments.scenario;
  say_if_waiting(file, "a scenario", options.quiet);
  const ScenarioFamily family(file, overrides);
  const std::string table = table_file_of(arguments);
  file::Outputs outputs;
  outputs.reads(file, "the scenario");
  if (!arguments.files.scenario.empty()) outputs.writes(arguments.files.scenario, "-o");
  if (!arguments.files.json.empty()) outputs.writes(arguments.files.json, "--json");
  if (!table.empty()) outputs.writes(table, arguments.table.empty() ? "the table" : "--table");
  if (!arguments.sketch.empty()) outputs.writes(arguments.sketch, "--sketch");
  if (arguments.reports()) prints(outputs);

  api::DesignRequest request{family, arguments.free};
  request.length = arguments.length;
  request.rate = arguments.rate;
  request.noise = arguments.noise;
  request.window = arguments.window;
  request.tilt = arguments.tilt;
  request.tilt_rate = arguments.tilt_rate;
  request.margin = arguments.margin;
  request.threads = arguments.threads;
  const bool with_scenario = !arguments.files.scenario.empty();
  if (with_scenario) request.table = name_from(arguments.files.scenario, table);
  Progress progress(family.source().file, options.quiet);
  const api::DesignResult made =
      api::design(request, {with_scenario, !arguments.sketch.empty()}, progress);
  if (made.code != ExitCode::done) {
    say("design: interrupted; nothing is written");
    return made.code;
  }
  // Write the table first: the scenario refers to it.
  if (!table.empty()) file::write_file(table, made.table);
  if (with_scenario) file::write_file(arguments.files.scenario, made.scenario);
  if (!arguments.sketch.empty()) file::write_file(arguments.sketch, made.sketch);
  if (!arguments.files.json.empty()) file::write_file(arguments.files.json, made.json);
  if (arguments.reports()) print(made.text);
  return ExitCode::done;
}

}  // namespace

void add_design(Command& command, const Options& options) {
  command.footer(
      "bbsim chooses sums of sines for both axes such that their log determines the free keys "
      "best: the determinant of Fisher's information is greatest. The ball stays on the plate, and "
      "tilts and their rates stay within limits. bbsim prints the standard deviations to expect "
      "from a fit, beside those of a circle and of a step of the same length within the same "
      "limits.\n"
      "With gimbal.motion or controller.commands, it chooses tilts: each axis plays a table, whose "
      "scale, offset and delay may be free. With another controller, it chooses the reference.\n"
      "The limits are those of servos, commands and events.tilt; --max-tilt and --max-tilt-rate "
      "replace them.\n"
      "\n"
      "Examples:\n"
      "  bbsim design rig.yaml --free ball.inertia_factor \\\n"
      "      --free gimbal.motion.phi.table.scale --length \"10 s\" -o designed.yaml\n"
      "  bbsim design rig.yaml --free gimbal.motion.phi.table.delay --max-tilt \"6 deg\" \\\n"
      "      --noise x=0.5mm --noise y=0.5mm --table motion.csv --sketch play.ino");
  const auto arguments = std::make_shared<DesignArguments>();
  add_scenario(command, arguments->scenario);
  command
      .option("--free", arguments->free,
              "a key that the log should determine, as in `bbsim fit`; repeatable")
      .takes("KEY[=FROM:TO]")
      .may_be_repeated()
      .required();
  command
      .option("--length", arguments->length, "length of the log; default: the scenario's time.end")
      .takes("TIME");
  command
      .option("--rate", arguments->rate,
              "rows of the log per second; default: the sensor's, or else 50")
      .takes("HZ");
  command
      .option("--noise", arguments->noise,
              "standard deviation of a column's noise, such as x=0.5mm; a column other than x and "
              "y is added to the log; default: the sensor's, or else 1 mm; repeatable")
      .takes("COLUMN=SIZE")
      .may_be_repeated();
  command
      .option("--window", arguments->window,
              "length of the fit's windows; default: as in `bbsim fit`")
      .takes("TIME");
  command.option("--max-tilt", arguments->tilt, "the largest phi and theta").takes("ANGLE");
  command.option("--max-tilt-rate", arguments->tilt_rate, "the largest rates of phi and theta")
      .takes("RATE");
  command
      .option("--margin", arguments->margin,
              "distance that the ball keeps from the edge; default: a tenth of the plate")
      .takes("LENGTH");
  command
      .option("-o,--output", arguments->files.scenario,
              "write the scenario that plays the motion to FILE.yaml, or - for standard output")
      .takes("FILE");
  command
      .option("--table", arguments->table,
              "write the motion to FILE.csv: t, and phi and theta or x and y; default with -o: its "
              "name with -motion.csv")
      .takes("FILE");
  command
      .option("--json", arguments->files.json,
              "write the results to FILE.json, or - for standard output, in place of the report")
      .takes("FILE");
  command
      .option("--sketch", arguments->sketch,
              "write an Arduino sketch that plays the tilts and prints a log")
      .takes("FILE");
  add_threads(command, arguments->threads);
  command.does([arguments, &options] { return design(*arguments, options); });
}

}  // namespace bbsim::app
