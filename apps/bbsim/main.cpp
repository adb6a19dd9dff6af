// bbsim: a table of contents. Each subcommand has a file of its own; one ladder turns errors into
// exit codes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <string_view>

#include "base/error.hpp"
#include "command_line.hpp"
#include "commands.hpp"
#include "file/temporaries.hpp"
#include "help.hpp"
#include "model/control/external_controller.hpp"
#include "signals.hpp"
#include "simd/instruction_set.hpp"
#include "terminal.hpp"

namespace {

using bbsim::ExitCode;

int code(ExitCode exit_code) {
  return static_cast<int>(exit_code);
}

// Needs no memory of its own: there may be none where this is called.
ExitCode say(const char* message, ExitCode exit_code) {
  bbsim::app::say(message);
  return exit_code;
}

template <class Command>
ExitCode run(const Command& command) {
  try {
    return command();
  } catch (const bbsim::InputError& error) {
    return say(error.what(), ExitCode::input_at_fault);
  } catch (const bbsim::ReaderGone&) {
    return ExitCode::output_failed;  // quietly: whoever reads has seen enough, as of `| head`
  } catch (const bbsim::model::ControllerFault& error) {
    return say(error.what(), error.interrupted() ? ExitCode::interrupted : ExitCode::ended_early);
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

// Where there is no memory even for an exception, as may be before main() begins, or where it ends
// in a destructor (those of nlohmann::json take some), the program would end by a signal. In all
// other cases that is as it should be: it is a fault of ours.
[[gnu::constructor(101)]] void say_when_memory_ends() {
  std::set_terminate([] {
    try {
      if (const std::exception_ptr thrown = std::current_exception())
        std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      bbsim::file::remove_temporaries();
    } catch (...) {
      std::abort();
    }
    std::fputs("out of memory: end other programs, or give this one more\n", stderr);
    std::_Exit(code(ExitCode::ended_early));
  });
}

std::string version() {
  return std::string("bbsim " BBSIM_VERSION "\ninstruction set: ") +
         bbsim::simd::name_of(bbsim::simd::chosen_instruction_set());
}

ExitCode command_line(int argc, char** argv) {
  CLI::App app("bbsim simulates a ball that rolls on a plane which a two-axis gimbal tips.",
               "bbsim");
  app.formatter(std::make_shared<bbsim::app::HelpFormatter>());
  app.set_help_flag("-h,--help", "print this help and exit");
  app.set_version_flag("--version", version, "print the version and exit");
  app.require_subcommand(1);
  app.footer(
      "A SCENARIO of - is read from standard input.\n"
      "Exit codes: 0 done; 1 the run ended early or files differ; 2 the command line or the "
      "scenario is at fault; 3 the output could not be written; 130 interrupted.");

  bbsim::app::Options options;
  bbsim::app::add_quiet(app, options);
  std::function<ExitCode()> chosen;
  struct Command {
    const char *name, *description;
    std::function<void(CLI::App&)> add_options;
  };
  using namespace bbsim::app;
  const Command commands[] = {
      {"run", "Simulate a scenario", [&](CLI::App& command) { add_run(command, options, chosen); }},
      {"check", "Validate a scenario; print what is modelled and why, poles, and the solver",
       [&](CLI::App& command) { add_check(command, chosen); }},
      {"linearize", "A, B, C, D, poles, zeros and margins of a scenario about a point",
       [&](CLI::App& command) { add_linearize(command, chosen); }},
      {"measure", "Measure a stored run: step metrics, extremes, crossings",
       [&](CLI::App& command) { add_measure(command, chosen); }},
      {"sweep", "Simulate a scenario at many values of its keys",
       [&](CLI::App& command) { add_sweep(command, options, chosen); }},
      {"merge", "Put the parts of a sweep (bbsim sweep --shard) together",
       [&](CLI::App& command) { add_merge(command, options, chosen); }},
      {"summarise", "Count, mean, deviation and quantiles of a sweep's measures, by group",
       [&](CLI::App& command) { add_summarise(command, chosen); }},
      {"plot", "Draw runs and sweeps",
       [&](CLI::App& command) { add_plot(command, options, chosen); }},
      {"replay", "Show runs and sweeps: one HTML file that replays them",
       [&](CLI::App& command) { add_replay(command, options, chosen); }},
      {"compare", "Compare two results, of runs or of sweeps: CSV or HDF5",
       [&](CLI::App& command) { add_compare(command, chosen); }},
      {"verify", "Check this build against known answers; show what the full model buys",
       [&](CLI::App& command) { add_verify(command, options, chosen); }},
      {"columns", "List the output columns, their units and meaning",
       [&](CLI::App& command) { add_columns(command, chosen); }},
      {"accuracy", "Error and time of each method over a ladder of tolerances",
       [&](CLI::App& command) { add_accuracy(command, options, chosen); }},
  };
  // Options are made of those that are named: all of them take longer than many a run.
  char** const words = argv + std::min(argc, 1);
  for (const auto& [name, description, add_options] : commands) {
    CLI::App* const command = app.add_subcommand(name, description);
    if (std::find(words, argv + argc, std::string_view(name)) != argv + argc) {
      add_options(*command);
    }
  }
  add_help(app, chosen);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return bbsim::app::parsing_ended(app, error);
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
