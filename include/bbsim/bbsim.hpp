// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// bbsim as a C++20 library: find_package(bbsim), target bbsim::bbsim.
//
//   #include <bbsim/bbsim.hpp>
//
//   bbsim::Scenario scene = bbsim::Scenario::from_file("configs/fig2b.yaml");
//   scene.set("ball.radius", "2 cm");
//   bbsim::Result result = bbsim::run(scene);
//   result.column("x").back();  // m
//
// All numbers are in SI units and radians. Threads may run at the same time, each with its own
// objects or with a shared Scenario that none of them changes.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#if defined(__GNUC__)
#define BBSIM_API __attribute__((visibility("default")))
#else
#define BBSIM_API
#endif

namespace bbsim {
inline namespace v0 {

// Version of the library, such as "0.4.0".
[[nodiscard]] BBSIM_API std::string_view library_version() noexcept;

// Base class of the exceptions of bbsim.
class BBSIM_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

// One mistake in a scenario or an argument.
struct Fault {
  std::string place;    // "file:line:column", or the setting at fault; may be empty
  std::string message;  // the key, what was found, and what is allowed
  std::string key;      // such as ball.radius; empty if no key is at fault
  std::string hint;     // what to write instead; may be empty
};

// The scenario or an argument is wrong. what() has one line per fault.
class BBSIM_API ScenarioError : public Error {
 public:
  ScenarioError(const std::string& text, std::vector<Fault> faults);
  ~ScenarioError() override;
  // At least one fault, in the order of the scenario.
  [[nodiscard]] const std::vector<Fault>& faults() const noexcept { return faults_; }

 private:
  std::vector<Fault> faults_;
};

// A file could not be written.
class BBSIM_API FileError : public Error {
 public:
  using Error::Error;
  ~FileError() override;
};

// The scenario's own controller (a program or a library) did not start.
class BBSIM_API ControllerError : public Error {
 public:
  using Error::Error;
  ~ControllerError() override;
};

// Commands for phi and theta: rad, rad/s^2, N m or V, depending on controller.drives.
using Command = std::array<double, 2>;

// Input of the controller at a sample, in SI units. Pairs are (x, y) or (phi, theta).
struct Sample {
  std::size_t number = 0;
  double t = 0;                               // s
  std::optional<std::array<double, 2>> ball;  // m; empty if the sensor missed it
  std::array<double, 2> reference{}, reference_rate{}, reference_acceleration{};
  std::array<double, 2> servo{}, servo_rate{};
};

// A scenario's text and the keys set in it. The functions that use it check its values. After a
// move from it, they throw ScenarioError until it is assigned to.
class BBSIM_API Scenario {
 public:
  // Throws ScenarioError if the file cannot be read or is not a YAML tree of keys.
  [[nodiscard]] static Scenario from_file(const std::string& file);
  // Takes YAML text. Messages call it `name`; table files are relative to the folder of `name`.
  [[nodiscard]] static Scenario from_text(const std::string& text,
                                          const std::string& name = "scenario");
  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(const Scenario&);
  Scenario& operator=(Scenario&&) noexcept;
  ~Scenario();

  // Sets a key like --set KEY=VALUE, with values such as "2 cm" or "[0, 0.05]". "null" removes it.
  Scenario& set(const std::string& key, const std::string& value);
  Scenario& set(const std::string& key, double value);

  // Returns the text of `bbsim check`: what is modeled and why. Throws ScenarioError.
  [[nodiscard]] std::string check() const;

  struct State;
  [[nodiscard]] const State& state() const;

 private:
  explicit Scenario(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct RunOptions {
  std::vector<std::string> measures{};  // names, such as "max_tilt" or "rms_x from 5 s"
  std::string file{};                   // .csv or .h5 file for the rows; empty: none
  bool keep_rows = true;                // keep the rows in the result
  // Called with each row. Its values are in the order of Result::columns.
  std::function<void(std::span<const double> row)> sink{};
  // run() calls it occasionally with the fraction done. Returning false ends the run soon.
  std::function<bool(double fraction)> goes_on{};
};

enum class Status { done, stopped, failed, interrupted, refused };  // refused: only cases

struct Result {
  Status status = Status::done;
  std::string reason;  // why the run ended early; empty otherwise
  std::vector<std::string> columns, units;
  std::vector<std::vector<double>> values;  // one vector per column, if rows are kept
  std::vector<std::pair<std::string, double>> measures;
  std::vector<std::string> warnings;
  std::string summary;  // JSON, as `bbsim run --summary` writes it

  // Throws ScenarioError if the column does not exist or rows are not kept.
  [[nodiscard]] BBSIM_API const std::vector<double>& column(std::string_view name) const;
};

// Throws ScenarioError, FileError, ControllerError, and whatever options.sink or goes_on throws.
[[nodiscard]] BBSIM_API Result run(const Scenario& scenario, const RunOptions& options = {});

// A run that waits at each sample for your commands. They replace the scenario's control law. After
// a move from it, its functions throw ScenarioError.
class BBSIM_API Stepper {
 public:
  // Runs to the first sample. Throws like run(). The scenario must have controller.sampling and
  // must not drive legs.
  explicit Stepper(const Scenario& scenario, const RunOptions& options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  [[nodiscard]] bool is_over() const;
  // The sample that waits for commands, or the last one if the run is over.
  [[nodiscard]] const Sample& sample() const;
  // Runs to the next sample or to the end. Throws like run(). Throws ScenarioError if a command is
  // not finite, if the run is over, and in the run's own sink, which must not destroy the Stepper.
  void step(const Command& command);
  // Throws ScenarioError if the run is not over.
  [[nodiscard]] Result result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct SweepOptions {
  // KEY and SPEC of `bbsim sweep --vary KEY=SPEC`; empty: the scenario's own sweep.
  std::vector<std::pair<std::string, std::string>> vary{};
  std::vector<std::string> measures{};  // empty: the scenario's or the default ones
  bool zip = false;                     // for `vary`: pair the values by position; false: a grid
  std::optional<std::size_t> samples{}, seed{};
  std::size_t threads = 0;  // at most 1024; 0: one per processor
  std::function<bool(double fraction)> goes_on{};
};

// One row per case. Columns, also of a sweep that was ended: case, the keys, status, reason,
// end_time, the measures.
struct Table {
  struct Column {
    std::string name, unit;
    std::vector<double> numbers;     // empty in a text column
    std::vector<std::string> texts;  // empty in a column of numbers
  };
  std::vector<Column> columns;
  bool complete = true;  // false if `goes_on` ended the sweep

  // Throws ScenarioError if the column does not exist.
  [[nodiscard]] BBSIM_API const Column& column(std::string_view name) const;
};

// Throws like run().
[[nodiscard]] BBSIM_API Table sweep(const Scenario& scenario, const SweepOptions& options = {});

// A key with a value for each case: numbers (SI), or texts such as "2 cm".
struct CaseKey {
  std::string key;
  std::vector<double> numbers{};
  std::vector<std::string> texts{};  // an empty one leaves the scenario's own value
};

// x, y, vx, vy, phi, theta, phi_rate, theta_rate, spin (SI). The angles are those of gimbal.start;
// they count only if a controller or torques move the gimbal.
using State = std::array<double, 9>;

struct SimulateOptions {
  std::vector<std::string> columns{}, measures{};
  // Times at which the columns are wanted (s), which do not decrease; by default the scenario's
  // output times. `own_times`: a list for each case, all of one length, one after the other.
  std::optional<std::vector<double>> times{};
  bool own_times = false;
  // For each case: the part of the scenario's time that it covers (s), by default all, and the
  // state at its begin, by default the scenario's.
  std::vector<double> begin{}, end{};
  std::vector<State> start{};
  bool events = true;       // false: without events that stop a run or only observe it
  std::size_t threads = 0;  // at most 1024; 0: one per processor
  std::function<bool(double fraction)> goes_on{};
};

// For each column a value for each time of each case, one case after the other; for each measure
// one for each case. NaN where a case has none.
struct Cases {
  std::size_t times = 0;  // of a case
  std::vector<std::vector<double>> columns, measures;
  std::vector<Status> status;
  std::vector<std::string> reason;  // why a case is not done, or a measure is not finite
};

// Runs a scenario `count` times, in SIMD lanes where these carry it. Throws like run().
// If only some cases have bad values, those are refused, and it does not throw.
[[nodiscard]] BBSIM_API Cases simulate(const Scenario& scenario, std::size_t count,
                                       const std::vector<CaseKey>& keys,
                                       const SimulateOptions& options = {});

// dz = A z + B u, y = C z + D u; dz is z', or z one `period` later. Matrices are lists of rows.
struct LinearSystem {
  std::vector<std::string> states, inputs, outputs;
  std::vector<std::vector<double>> a, b, c, d;
  std::optional<double> period;  // s
  std::string json;              // what `bbsim linearize -o FILE.json` writes
};

// `kind`: "plant", "loop", "sampled", or empty for the default. `at`: "home", "equilibrium" or a
// time such as "2 s". Throws ScenarioError.
[[nodiscard]] BBSIM_API LinearSystem linearize(const Scenario& scenario,
                                               const std::string& kind = "",
                                               const std::string& at = "home");

}  // namespace v0
}  // namespace bbsim
