// bbsim: a table of contents. Each subcommand has a file of its own; one ladder turns errors into
// exit codes.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <functional>
#include <new>

#include "base/error.hpp"
#include "commands.hpp"

namespace {

using bbsim::ExitCode;

int code(ExitCode exit_code) {
  return static_cast<int>(exit_code);
}

ExitCode say(const std::string& message, ExitCode exit_code) {
  std::fprintf(stderr, "%s\n", message.c_str());
  return exit_code;
}

ExitCode run(const std::function<ExitCode()>& command) {
  try {
    const ExitCode result = command();
    if (std::fflush(stdout) != 0) {
      return say("cannot write to standard output", ExitCode::output_failed);
    }
    return result;
  } catch (const bbsim::InputError& error) {
    return say(error.what(), ExitCode::input_at_fault);
  } catch (const bbsim::OutputError& error) {
    return say(error.what(), ExitCode::output_failed);
  } catch (const std::bad_alloc&) {
    return say("out of memory: ask for fewer output rows, or end other programs",
               ExitCode::ended_early);
  } catch (const std::exception& error) {
    return say(std::string("internal error: ") + error.what(), ExitCode::ended_early);
  }
}

// Help and the version end parsing well; all else is a mistake on the command line.
int parsing_ended(const CLI::App& app, const CLI::ParseError& error) {
  const bool names_a_command = app.remaining().empty() || !app.get_subcommands().empty();
  if (error.get_name() == "RequiredError" && !names_a_command) {
    std::string known;
    for (const CLI::App* command : app.get_subcommands({})) known += " " + command->get_name();
    return code(say("unknown command " + app.remaining().front() + "; known:" + known +
                        "\nRun with --help for more information.",
                    ExitCode::input_at_fault));
  }
  return app.exit(error) == 0 ? code(ExitCode::done) : code(ExitCode::input_at_fault);
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that goes away, or a file at its size limit, is an error like any other, not a
  // sudden end.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);

  CLI::App app("bbsim simulates a ball that rolls on a plane which a two-axis gimbal tips.",
               "bbsim");
  app.set_version_flag("--version", "bbsim " BBSIM_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 the run ended early or files differ; 2 the command line or the\n"
      "scenario is at fault; 3 the output could not be written; 130 interrupted.");

  bbsim::app::Options options;
  app.add_flag("-q,--quiet", options.quiet, "Print no messages and no progress, only results");
  std::function<ExitCode()> chosen;
  bbsim::app::add_run(app, options, chosen);
  bbsim::app::add_check(app, chosen);
  bbsim::app::add_sweep(app, options, chosen);
  bbsim::app::add_merge(app, options, chosen);
  bbsim::app::add_compare(app, chosen);
  bbsim::app::add_verify(app, options, chosen);
  bbsim::app::add_columns(app, chosen);
  bbsim::app::add_accuracy(app, options, chosen);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return parsing_ended(app, error);
  }
  return code(run(chosen));
}
