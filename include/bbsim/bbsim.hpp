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
// All numbers are in SI units and radians. Several threads may use objects of their own at once,
// and a Scenario that none of them changes.
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

// The version of the library: "0.3.0".
[[nodiscard]] BBSIM_API std::string_view library_version() noexcept;

// Any error of bbsim.
class BBSIM_API Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  ~Error() override;
};

// A fault of a scenario or an argument.
struct Fault {
  std::string place;    // "file:line:column", or the setting; may be empty
  std::string message;  // the key, what was found, and what is allowed
  std::string key;      // such as ball.radius; empty if no key is at fault
  std::string hint;     // what to write instead; may be empty
};

// The scenario or an argument is wrong. what() has a line for each fault.
class BBSIM_API ScenarioError : public Error {
 public:
  ScenarioError(const std::string& text, std::vector<Fault> faults);
  ~ScenarioError() override;
  // At least one, in the order of the scenario.
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

// A controller that is not built in does not begin.
class BBSIM_API ControllerError : public Error {
 public:
  using Error::Error;
  ~ControllerError() override;
};

// Commands for phi and theta, in the unit that the scenario drives.
using Command = std::array<double, 2>;

// What a controller is told at a sample.
struct Sample {
  std::size_t number = 0;
  double t = 0;                               // s
  std::optional<std::array<double, 2>> ball;  // m; nothing if the sensor missed it
  std::array<double, 2> reference{}, reference_rate{}, reference_acceleration{};
  std::array<double, 2> servo{}, servo_rate{};
};

// A scenario's text and the keys set in it. Reading and checking comes with its use.
class BBSIM_API Scenario {
 public:
  // Throws ScenarioError if the file cannot be read or is no tree of keys.
  [[nodiscard]] static Scenario from_file(const std::string& file);
  // YAML text; `name` is the file's name in messages, and its folder has the table files.
  [[nodiscard]] static Scenario from_text(const std::string& text,
                                          const std::string& name = "scenario");
  Scenario(const Scenario&);
  Scenario(Scenario&&) noexcept;
  Scenario& operator=(const Scenario&);
  Scenario& operator=(Scenario&&) noexcept;
  ~Scenario();

  // Sets a key, as --set KEY=VALUE does: "2 cm", "[0, 0.05]"; "null" removes it.
  Scenario& set(const std::string& key, const std::string& value);
  Scenario& set(const std::string& key, double value);

  // What is modelled and why: the text of `bbsim check`. Throws ScenarioError.
  [[nodiscard]] std::string check() const;

  struct State;
  [[nodiscard]] const State& state() const { return *state_; }

 private:
  explicit Scenario(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct RunOptions {
  std::vector<std::string> measures{};  // names, such as "max_tilt" or "rms_x from 5 s"
  std::string file{};                   // .csv or .h5, which gets the rows; empty: none
  bool keep_rows = true;                // in the result
  // Called with each row, in the order of the columns.
  std::function<void(std::span<const double> row)> sink{};
  // Called now and then with the fraction done; false ends the run soon.
  std::function<bool(double fraction)> goes_on{};
};

enum class Status { done, stopped, failed, interrupted };

struct Result {
  Status status = Status::done;
  std::string reason;  // why the run ended early; empty if it did not
  std::vector<std::string> columns, units;
  std::vector<std::vector<double>> values;  // a vector for each column, if rows are kept
  std::vector<std::pair<std::string, double>> measures;
  std::vector<std::string> warnings;
  std::string summary;  // JSON, as `bbsim run --summary` writes it

  // Throws ScenarioError if there is no such column, or if rows are not kept.
  [[nodiscard]] BBSIM_API const std::vector<double>& column(std::string_view name) const;
};

// Throws ScenarioError, FileError, ControllerError, and what the options' functions throw.
[[nodiscard]] BBSIM_API Result run(const Scenario& scenario, const RunOptions& options = {});

// A run that waits at each sample for its commands, which take the place of the scenario's law.
class BBSIM_API Stepper {
 public:
  // Goes to the first sample. Throws as run() does, and ScenarioError without controller.sampling.
  explicit Stepper(const Scenario& scenario, const RunOptions& options = {});
  ~Stepper();
  Stepper(Stepper&&) noexcept;
  Stepper& operator=(Stepper&&) noexcept;

  [[nodiscard]] bool is_over() const;
  // The sample that waits for commands; of a run that is over, the last one.
  [[nodiscard]] const Sample& sample() const;
  // Goes to the next sample, or to the end. Throws ScenarioError for commands that are not finite,
  // and if the run is over.
  void step(const Command& command);
  // Throws ScenarioError if the run is not over.
  [[nodiscard]] Result result() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

struct SweepOptions {
  // KEY and SPEC of `bbsim sweep --vary KEY=SPEC`; none: the scenario's own sweep.
  std::vector<std::pair<std::string, std::string>> vary{};
  std::vector<std::string> measures{};  // none: the usual ones
  bool zip = false;                     // first values together, then second ones; else a grid
  std::optional<std::size_t> samples{}, seed{};
  std::size_t threads = 0;  // 0: as many as there are processors
  std::function<bool(double fraction)> goes_on{};
};

// A row for each case: case, the keys, status, reason, end_time, the measures.
struct Table {
  struct Column {
    std::string name, unit;
    std::vector<double> numbers;     // of a column of numbers
    std::vector<std::string> texts;  // of a column of texts
  };
  std::vector<Column> columns;
  bool complete = true;  // false if it was ended

  // Throws ScenarioError if there is no such column.
  [[nodiscard]] BBSIM_API const Column& column(std::string_view name) const;
};

// Throws as run() does.
[[nodiscard]] BBSIM_API Table sweep(const Scenario& scenario, const SweepOptions& options = {});

// dz = A z + B u, y = C z + D u; dz is z', or with a period z a period later. Matrices by rows.
struct LinearSystem {
  std::vector<std::string> states, inputs, outputs;
  std::vector<std::vector<double>> a, b, c, d;
  std::optional<double> period;  // s
  std::string json;              // all that `bbsim linearize -o FILE.json` writes
};

// `kind`: "plant", "loop", "sampled", or empty for what is usual; `at`: "home", "equilibrium" or a
// time. Throws ScenarioError.
[[nodiscard]] BBSIM_API LinearSystem linearize(const Scenario& scenario,
                                               const std::string& kind = "",
                                               const std::string& at = "home");

}  // namespace v0
}  // namespace bbsim
