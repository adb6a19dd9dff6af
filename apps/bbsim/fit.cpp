// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// `bbsim fit`: keys of a rig from its logs.
#include "api/fit.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/fit_report.hpp"
#include "commands.hpp"
#include "file/atomic_file.hpp"
#include "progress.hpp"
#include "replay/template.hpp"
#include "terminal.hpp"

namespace bbsim::app {
namespace {

// Opened before the fit, so that a missing file or template is reported at once.
class FitPage {
 public:
  explicit FitPage(const std::string& target) {
    if (target.empty()) return;
    template_ = replay::read_template(api::fit_template);
    file_.emplace(target);
  }

  [[nodiscard]] bool is_asked_for() const { return file_.has_value(); }

  // Writes the whole page or nothing. Throws OutputError.
  void write(const api::FitRequest& request, const fit::Fitted& fitted) {
    if (!file_) return;
    file_->write(api::fit_page(request, fitted, template_));
    file_->commit();
  }

 private:
  std::string template_;
  std::optional<file::AtomicFile> file_;
};

struct FitArguments {
  ScenarioArguments scenario;
  std::vector<std::string> logs, free;
  results::LogChoice choice;
  std::string window;
  FoundFiles files;
  std::optional<double> hold_out;
  std::size_t threads = 0;
  std::size_t starts = 1;
  std::string loss = "squares";
  bool continuity = false;
};

ExitCode fit(const FitArguments& arguments, const Options& options) {
  const auto& [file, overrides] = arguments.scenario;
  say_if_waiting(file, "a scenario", options.quiet);
  const ScenarioFamily family(file, overrides);
  file::Outputs outputs;
  outputs.reads(file, "the scenario");
  for (const std::string& log : arguments.logs) outputs.reads(log, "the log");
  if (!arguments.files.page.empty()) {
    outputs.reads(replay::file_of_template(api::fit_template), "the template of pages");
  }
  arguments.files.declare(outputs);
  FitPage page(arguments.files.page);

  api::FitRequest request{family, arguments.logs, arguments.choice, arguments.free,
                          arguments.window};
  request.with_series = page.is_asked_for();
  request.hold_out = arguments.hold_out.value_or(0);
  request.threads = arguments.threads;
  request.starts = arguments.starts;
  request.loss = arguments.loss;
  request.continuity = arguments.continuity;
  Progress progress(family.source().file, options.quiet);
  const api::FitResult made = api::fit(request, !arguments.files.scenario.empty(), progress);
  if (!options.quiet) {
    for (const std::string& warning : made.warnings) say(warning);
  }
  if (made.text.empty()) {
    say("fit: interrupted before the first iteration; nothing is written");
    return made.code;
  }
  page.write(request, made.fitted);
  arguments.files.write(family, made.scenario, made.json, made.text, options.quiet);
  return made.code;
}

}  // namespace

void add_fit(Command& command, const Options& options) {
  command.footer(
      "bbsim cuts each log into windows, fits the ball's position and velocity at the start of "
      "each, and finds the values of the free keys at which the runs are closest to the logs. It "
      "prints estimates, standard deviations, 95 % intervals and residuals. It names keys that the "
      "logs do not determine; the exit code is then 0, too. Ctrl+C ends a fit with the best values "
      "so far.\n"
      "A sensor's scale, offset and delay can be free keys, too: log.x.scale, log.x.offset, "
      "log.delay. The log then shows offset + scale x(t - delay).\n"
      "If a table of the scenario is one of several logs, each log is fitted with itself as that "
      "table.\n"
      "\n"
      "Examples:\n"
      "  bbsim fit rig.yaml log.csv --free ball.inertia_factor \\\n"
      "      --free gimbal.motion.phi.table.scale --free gimbal.motion.phi.table.offset\n"
      "  bbsim fit rig.yaml log.csv --map t=millis:ms,x=Ballx:mm,y=Bally:mm \\\n"
      "      --free \"gimbal.motion.phi.table.delay=0:200 ms\" --hold-out 0.3 -o fitted.yaml");
  const auto arguments = std::make_shared<FitArguments>();
  add_scenario(command, arguments->scenario);
  command.option("LOG", arguments->logs, "logs of the rig: CSV with a header").required();
  command
      .option("--free", arguments->free,
              "a key to fit, and its bounds; the fit starts at the scenario's value; repeatable")
      .takes("KEY[=FROM:TO]")
      .may_be_repeated()
      .required();
  add_log_options(command, arguments->choice);
  command
      .option("--window", arguments->window,
              "length of a window; default: 2 s, or the whole log with a controller and without "
              "--hold-out or --continuity")
      .takes("TIME");
  command
      .option("--hold-out", arguments->hold_out,
              "keep this share of the windows out of the fit, and print their residuals")
      .takes("F");
  command.flag("--continuity", arguments->continuity,
               "join windows that follow one another without a gap: each then begins where the one "
               "before ends, as in one long window");
  command
      .option("--loss", arguments->loss,
              "squares, or huber, which gives outliers less weight; default: squares")
      .takes("LOSS");
  command
      .option("--starts", arguments->starts,
              "try N sets of starting values, drawn within the bounds, or else near the "
              "scenario's, and continue from the best; default: 1")
      .takes("N");
  add_found_files(command, arguments->files, "the estimates");
  command
      .option("--report", arguments->files.page,
              "also write FILE.html, a page with the tables and plots of log and model, or - for "
              "standard output")
      .takes("FILE");
  add_threads(command, arguments->threads);
  command.does([arguments, &options] { return fit(*arguments, options); });
}

}  // namespace bbsim::app
