// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The program bbsim: its commands, and one place that turns errors into exit codes.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>

#include "api/run.hpp"
#include "base/error.hpp"
#include "commands.hpp"
#include "file/leftovers.hpp"
#include "terminal.hpp"

namespace {

using bbsim::ExitCode;

int code(ExitCode exit_code) {
  return static_cast<int>(exit_code);
}

// Takes a C string, because there may be no memory left for a std::string.
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
    return ExitCode::output_failed;  // quiet: the reader has seen enough, as with `| head`
  } catch (const bbsim::api::ControllerFault& error) {
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

// Memory may run out where no handler can catch it: before main() begins, or in a destructor, such
// as nlohmann::json's. This reports it; otherwise the program would end by a signal, as it still
// does for other exceptions, which are bugs.
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
    _exit(code(ExitCode::ended_early));
  });
}

constexpr const char *running = "Run and check", *rigs = "Rigs", *sweeps = "Sweeps",
                     *analysis = "Analysis", *pictures = "Pictures", *setup = "Setup";

constexpr bbsim::app::NamedCommand commands[] = {
    {running, "run", "Simulate a scenario", bbsim::app::add_run},
    {running, "check", "Validate a scenario; explain the model; print the poles and the solver",
     bbsim::app::add_check},
    {running, "measure", "Measure a stored run: step metrics, extremes, crossings",
     bbsim::app::add_measure},
    {running, "compare", "Compare two results of runs or sweeps, CSV or HDF5",
     bbsim::app::add_compare},
    {rigs, "new", "Write a controller or the scenario of a rig to start from", bbsim::app::add_new},
    {rigs, "sketch", "Compile an Arduino sketch into a controller", bbsim::app::add_sketch},
    {rigs, "design", nullptr, bbsim::app::add_beside},
    {rigs, "fit", nullptr, bbsim::app::add_beside},
    {rigs, "tune", nullptr, bbsim::app::add_beside},
    {sweeps, "sweep", "Simulate a scenario at many values of its keys", bbsim::app::add_sweep},
    {sweeps, "merge", "Join the parts of a sweep that `bbsim sweep --shard` wrote",
     bbsim::app::add_merge},
    {sweeps, "summarize",
     "Print statistics of a sweep's measures: count, mean, deviation, quantiles",
     bbsim::app::add_summarize, "summarise"},
    {analysis, "linearize", "Linearize a scenario about a point: A, B, C, D, poles, zeros, margins",
     bbsim::app::add_linearize},
    {analysis, "accuracy", "Measure error and time of every method over a range of tolerances",
     bbsim::app::add_accuracy},
    {pictures, "plot", nullptr, bbsim::app::add_beside},
    {pictures, "replay", "Write one HTML file that replays runs or sweeps", bbsim::app::add_replay},
    {setup, "examples", "List example scenarios, or write one", bbsim::app::add_examples},
    {setup, "columns", "List the output columns with unit and meaning", bbsim::app::add_columns},
    {setup, "verify", "Check this build against known answers; print the error of simpler models",
     bbsim::app::add_verify},
};

}  // namespace

int main(int argc, char** argv) {
  // A reader that goes away, or a file at its size limit, is then an ordinary error instead of a
  // signal that ends the program.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  bbsim::app::end_at_signals();
  return code(run([&] { return bbsim::app::run_command(argc, argv, commands); }));
}
