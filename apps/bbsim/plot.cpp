// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim plot`: pictures of runs and sweeps, by gnuplot.
#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "api/inputs.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "file/default_name.hpp"
#include "file/format.hpp"
#include "file/outputs.hpp"
#include "fonts.hpp"
#include "gnuplot.hpp"
#include "plot/run_picture.hpp"
#include "plot/script.hpp"
#include "plot/sweep_picture.hpp"
#include "results/read_result.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

namespace fs = std::filesystem;

struct PlotArguments {
  std::vector<std::string> files;
  std::string output, format;
  bool overlay = false, force = false;
  std::vector<std::string> columns, over;
  results::Beside beside;
  results::LogChoice log;
};

struct NamedFormat {
  std::string_view name;
  plot::Format format;
};
constexpr std::array formats = {NamedFormat{"svg", plot::Format::svg},
                                NamedFormat{"png", plot::Format::png},
                                NamedFormat{"pdf", plot::Format::pdf}};

// Format from --format, else from the ending of --output.
NamedFormat format_of(const PlotArguments& arguments) {
  std::string name = arguments.format;
  if (name.empty()) {
    if (arguments.output.empty() || arguments.output == "-") return formats[0];
    name = file::lower_ending(arguments.output);
    if (!name.empty()) name.erase(0, 1);
  }
  const auto found = std::ranges::find(formats, name, &NamedFormat::name);
  if (found != formats.end()) return *found;
  throw InputError(arguments.format.empty()
                       ? "--output: found " + arguments.output +
                             "; allowed: a name that ends in .svg, .png or .pdf"
                       : "--format: found " + name + "; allowed: svg, png and pdf");
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0; start != std::string::npos;) {
    const std::size_t end = text.find(separator, start);
    std::string part = text.substr(start, end - start);
    part.erase(0, part.find_first_not_of(' '));
    part.erase(part.find_last_not_of(' ') + 1);
    parts.push_back(part);
    start = end == std::string::npos ? end : end + 1;
  }
  return parts;
}

// "x,y;phi" means two panels, as does giving the option twice.
plot::Asked asked_columns(const std::vector<std::string>& given) {
  plot::Asked asked;
  for (const std::string& panels : given) {
    for (const std::string& panel : split(panels, ';')) asked.push_back(split(panel, ','));
  }
  return asked;
}

plot::Picture picture_of(const std::vector<results::Result>& results,
                         const PlotArguments& arguments) {
  const plot::Asked asked = asked_columns(arguments.columns);
  const auto is_sweep = [](const results::Result& result) { return result.is_sweep(); };
  if (std::ranges::none_of(results, is_sweep)) {
    if (!arguments.over.empty()) {
      throw InputError("--over: " + results.front().file +
                       " is not a sweep; bbsim draws a run over time");
    }
    return plot::run_picture(results, asked);
  }
  if (results.size() > 1)
    throw InputError("--overlay: found a sweep; allowed: runs, since a sweep has its own picture");
  plot::SweepChoice choice;
  for (const std::vector<std::string>& panel : asked) {
    choice.measures.insert(choice.measures.end(), panel.begin(), panel.end());
  }
  for (const std::string& keys : arguments.over) {
    const std::vector<std::string> parts = split(keys, ',');
    choice.over.insert(choice.over.end(), parts.begin(), parts.end());
  }
  return plot::sweep_picture(results.front(), choice);
}

// Files drawn in one picture.
struct Task {
  std::vector<std::string> files;
  std::string output;
};

std::vector<Task> tasks_of(const PlotArguments& arguments, std::string_view ending) {
  const std::vector<std::string>& files = arguments.files;
  const bool several = files.size() > 1;
  if (several && !arguments.overlay && !arguments.output.empty()) {
    throw InputError(
        "--output: found " + arguments.output +
        " for several files; allowed: with --overlay, which draws them in one picture");
  }
  const auto named_after = [&](const std::string& file, const char* more) {
    if (!arguments.output.empty()) return arguments.output;
    if (file == "-")
      throw InputError("--output: missing; standard input (-) gives the picture no name");
    return fs::path(file).replace_extension().string() + more + '.' + std::string(ending);
  };
  if (several && arguments.overlay) return {{files, named_after(files.front(), "-overlay")}};
  std::vector<Task> tasks;
  for (const std::string& file : files) tasks.push_back({{file}, named_after(file, "")});
  return tasks;
}

std::string option_of(const Task& task, const PlotArguments& arguments) {
  return arguments.output.empty() ? "the picture of " + task.files.front() + ", without -o" : "-o";
}

// Call it before any of the files is opened.
void declare_files(const std::vector<Task>& tasks, const PlotArguments& arguments) {
  file::Outputs outputs;
  for (const std::string& file : arguments.files) {
    outputs.reads(file, "what is drawn");
    const std::string summary = results::summary_beside(file);
    if (!summary.empty()) outputs.reads(summary, "the summary of " + file);
  }
  if (!arguments.beside.summary.empty()) outputs.reads(arguments.beside.summary, "--summary");
  if (!arguments.beside.scenario.empty()) outputs.reads(arguments.beside.scenario, "--scenario");
  for (const Task& task : tasks) outputs.writes(task.output, option_of(task, arguments));
}

void draw(const Task& task, plot::Format format, const PlotArguments& arguments,
          const Options& options) {
  std::vector<results::Result> results;
  file::Outputs outputs;
  for (const std::string& file : task.files) {
    say_if_waiting(file, "a CSV", options.quiet);
    std::vector<std::string> notes;
    results.push_back(results::read_result(file, arguments.beside, arguments.log, &notes));
    for (const std::string& note : notes) {
      if (!options.quiet) say(note);
    }
    api::reads_with_result(outputs, results.back());
    if (!options.quiet && !results.back().left_out.empty()) say(results.back().left_out);
    results::add_end_row(results.back());
  }
  outputs.writes(task.output, option_of(task, arguments));
  if (arguments.output.empty() && !arguments.force) {
    file::require_like(task.output, {.what = "a picture of bbsim's", .mark = plot::picture_mark});
  }
  const plot::Picture picture = picture_of(results, arguments);
  const std::string drawn = run_gnuplot(plot::gnuplot_script(picture, format, some_font_has));
  file::write_file(task.output, plot::marked(plot::mended(drawn, format), format));
  if (options.quiet || task.output == "-") return;
  std::size_t rows = 0;
  for (const results::Result& result : results) rows += result.rows - (result.has_end_row ? 1 : 0);
  const std::size_t panels = picture.panels.size();
  say(task.output + ": " + std::to_string(rows) +
      (results.front().is_sweep() ? " cases, " : " rows, ") + std::to_string(panels) +
      (panels == 1 ? " panel" : " panels"));
}

ExitCode plot_files(const PlotArguments& arguments, const Options& options) {
  const NamedFormat format = format_of(arguments);
  const std::vector<Task> tasks = tasks_of(arguments, format.name);
  if (arguments.files.size() > 1 && !arguments.beside.summary.empty()) {
    throw InputError(
        "--summary: found several files; allowed: one run, to which the summary belongs");
  }
  if (!arguments.beside.overrides.empty() && arguments.beside.scenario.empty()) {
    throw InputError("--set: allowed with --scenario, in which it sets a key");
  }
  results::refuse_auto(arguments.log);
  declare_files(tasks, arguments);
  require_gnuplot();
  // Draw what can be drawn, even if other files have faults.
  std::vector<Problem> problems;
  for (const Task& task : tasks) {
    try {
      draw(task, format.format, arguments, options);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return ExitCode::done;
}

}  // namespace

void add_plot(Command& command, const Options& options) {
  command.footer(
      "The picture of a run has its path on the plate and its columns over time; that of a sweep "
      "has its measures over the keys that vary. Title, plate, events and friction coefficient "
      "come from the .h5 file. For a .csv they come from its summary (NAME.json beside NAME.csv, "
      "or --summary) or from --scenario. Without these, bbsim draws the columns without units, as "
      "for tables of other programs.\n"
      "\n"
      "Examples:\n"
      "  bbsim run configs/rig.yaml --summary rig.json && bbsim plot rig.csv\n"
      "  bbsim plot rig.csv --columns 'path;x,x_reference;phi,phi_command' -o rig.pdf\n"
      "  bbsim plot --overlay slow.csv fast.csv -o both.png\n"
      "  bbsim plot fig2b-sweep.csv --columns end_x,max_tilt");
  const auto arguments = std::make_shared<PlotArguments>();
  command
      .option("FILES", arguments->files,
              "CSV or HDF5 files of runs and sweeps; - is CSV on standard input")
      .required();
  command.option("-o,--output", arguments->output,
                 "write FILE.svg, .png or .pdf, or - for standard output; default: FILE with .svg");
  add_force(command, arguments->force);
  command.option("--format", arguments->format, "svg, png or pdf; default: the ending of -o")
      .takes("FORMAT");
  command.flag("--overlay", arguments->overlay,
               "draw all files in one picture; default name: FIRST-overlay.svg");
  command
      .option("--columns", arguments->columns,
              "columns to draw: commas separate the columns of a panel, semicolons separate "
              "panels; path is the path on the plate. For a sweep: measures")
      .may_be_repeated();
  command.option("--over", arguments->over, "KEY[,KEY]: draw a sweep's measures over these keys")
      .may_be_repeated();
  command.option("--summary", arguments->beside.summary,
                 "FILE.json: the summary of the run, from `bbsim run --summary`");
  command.option("--scenario", arguments->beside.scenario, "FILE.yaml: the scenario that was run");
  command
      .option("--set", arguments->beside.overrides,
              "key.path=value that was set in that scenario; repeatable")
      .may_be_repeated();
  add_log_options(command, arguments->log);
  command.does([arguments, &options] { return plot_files(*arguments, options); });
}

}  // namespace bbsim::app
