// bbsim: a table of contents. Each subcommand has a file of its own; one ladder turns errors into
// exit codes.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <new>

#include "base/error.hpp"
#include "commands.hpp"
#include "signals.hpp"
#include "solve/collocation/radau.hpp"

namespace {

using bbsim::ExitCode;

int code(ExitCode exit_code) {
  return static_cast<int>(exit_code);
}

// Of text that is there: where memory has run out there is none for another.
ExitCode say(const char* message, ExitCode exit_code) {
  std::fprintf(stderr, "%s\n", message);
  return exit_code;
}
ExitCode say(const std::string& message, ExitCode exit_code) {
  return say(message.c_str(), exit_code);
}

template <class Command>
ExitCode run(const Command& command) {
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
    std::fputs("internal error: ", stderr);
    return say(error.what(), ExitCode::ended_early);
  }
}

// Where there is no memory even for an exception, as may be before main() begins, the program would
// end by a signal. In all other cases that is as it should be: it is a fault of ours.
[[gnu::constructor(101)]] void say_when_memory_ends() {
  std::set_terminate([] {
    if (std::current_exception()) std::abort();
    std::fputs("out of memory: end other programs, or give this one more\n", stderr);
    std::_Exit(code(ExitCode::ended_early));
  });
}

// Help and the version end parsing well; all else is a mistake on the command line.
ExitCode parsing_ended(const CLI::App& app, const CLI::ParseError& error) {
  const bool names_a_command = app.remaining().empty() || !app.get_subcommands().empty();
  if (error.get_name() == "RequiredError" && !names_a_command) {
    std::string known;
    for (const CLI::App* command : app.get_subcommands({})) known += " " + command->get_name();
    return say("unknown command " + app.remaining().front() + "; known:" + known +
                   "\nRun with --help for more information.",
               ExitCode::input_at_fault);
  }
  return app.exit(error) == 0 ? ExitCode::done : ExitCode::input_at_fault;
}

std::string version() {
  return std::string("bbsim " BBSIM_VERSION "\ninstruction set: ") +
         bbsim::solve::collocation::choose_kernels().name;
}

ExitCode command_line(int argc, char** argv) {
  CLI::App app("bbsim simulates a ball that rolls on a plane which a two-axis gimbal tips.",
               "bbsim");
  app.set_version_flag("--version", version);
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
  return chosen();
}

}  // namespace

int main(int argc, char** argv) {
  // A reader that goes away, or a file at its size limit, is an error like any other, not a
  // sudden end.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  bbsim::app::end_at_signals();
  return code(run([&] { return command_line(argc, argv); }));
}
