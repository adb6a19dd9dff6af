// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/host.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <utility>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "controller/library.hpp"
#include "controller/program.hpp"
#include "scenario/columns.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::controller {
namespace {

Setup setup_of(const Scenario& scenario) {
  const Controller& controller = *scenario.controller;
  const Sampling& sampling = *controller.sampling;
  Setup setup;
  setup.drives = controller.drives;
  setup.period = sampling.period;
  setup.delay = sampling.delay;
  setup.resolution = sampling.resolution;
  setup.derivative_filter = sampling.derivative_filter;
  // The tighter limit, if those of the axes differ.
  setup.limit = std::numeric_limits<double>::infinity();
  for (const std::size_t axis : {0U, 1U}) {
    setup.limit = std::min(setup.limit, controller.limit_of(axis).value_or(setup.limit));
  }
  if (controller.sensor) setup.seed = controller.sensor->seed;
  for (std::size_t i = 0; scenario.gimbal.servo && i < setup.commands(); ++i) {
    const auto& stepper = scenario.gimbal.servo_of(i).stepper;
    if (stepper) setup.microstep[i] = stepper->microstep();
  }
  setup.end = scenario.time.end;
  setup.parameters = controller.own->parameters;
  setup.columns = scenario::own_columns(scenario);
  return setup;
}

// The setup of a program at a sketch's serial line, which the scene must have.
Setup serial_setup_of(const Scenario& scenario) {
  const SerialProgram& serial = *serial_program(*scenario.controller->own);
  Setup setup = setup_of(scenario);
  setup.serial = true;
  if (serial.period > 0) setup.period = serial.period;
  setup.delay = serial.delay;
  setup.parameters = serial.parameters;
  return setup;
}

}  // namespace

// A program and a sketch that speak over the serial line of the sketch's board.
class SerialLine : public model::ExternalController {
 public:
  // The setups are those of the two. Each column belongs to the program if its answer to the hello
  // names it, and else to the sketch, whose setup gets the rest.
  SerialLine(std::shared_ptr<Program> program, Setup of_program)
      : program_(std::move(program)), setup_(std::move(of_program)) {
    for (const auto& [name, unit] :
         program_->ready().columns.value_or(std::vector<std::pair<std::string, std::string>>{})) {
      if (std::ranges::find(setup_.columns, name) != setup_.columns.end()) {
        program_columns_.push_back(name);
      }
    }
    numbers_.resize(program_columns_.size());
    sketch_numbers_.resize(setup_.columns.size() - program_columns_.size());
  }

  // Throws KeyError.
  void connect(std::shared_ptr<Library> sketch) {
    sketch_ = std::move(sketch);
    sketch_->require_line();
  }

  // A sketch's setup with the columns that are not the program's.
  [[nodiscard]] Setup without_columns(Setup of_sketch) const {
    std::erase_if(of_sketch.columns, [&](const std::string& name) {
      return std::ranges::find(program_columns_, name) != program_columns_.end();
    });
    return of_sketch;
  }

  void begin() override {
    program_->begin();
    sketch_->begin();
    std::ranges::fill(numbers_, std::nan(""));
    arrived_.clear();
    samples_ = sent_ = 0;
    due_ = baud_ = 0;
  }

  model::Commands command(const model::ControllerSample& sample, double* own) override {
    sketch_->receive(arrived_);
    sketch_->send(answer(sample), setup_.delay);
    const model::Commands command = sketch_->command(sample, sketch_numbers_.data());
    std::size_t of_sketch = 0;
    for (std::size_t i = 0; i < setup_.columns.size(); ++i) {
      const auto its = std::ranges::find(program_columns_, setup_.columns[i]);
      own[i] = its == program_columns_.end()
                   ? sketch_numbers_[of_sketch++]
                   : numbers_[static_cast<std::size_t>(its - program_columns_.begin())];
    }
    return command;
  }

  // After samples: that no byte reached the sketch, or some were lost, as a sentence; may be empty.
  [[nodiscard]] std::string remark() const {
    const bbsim_line line = sketch_->line();
    if (sent_ == 0) return "the program at the serial line sent no byte to the sketch";
    if (line.baud == 0) {
      return "the sketch received nothing at its serial line: it never calls Serial.begin()";
    }
    if (line.read == 0) return "the sketch read no byte of its serial line";
    if (line.overrun == 0) return "";
    return "the serial line lost " + std::to_string(line.overrun) + " of " + std::to_string(sent_) +
           " bytes: the sketch's buffer of 64 bytes was full; it reads too rarely, or the program "
           "sends too much";
  }

 private:
  // What the program sends at a sample of the board.
  std::string answer(const model::ControllerSample& sample) {
    // Times are rounded; a sample that is due a moment later is this one.
    const double periods = sample.t / setup_.period + 1e-6;
    if (periods < due_) return {};
    due_ = std::floor(periods) + 1;
    const model::ControllerSample its{samples_++,   sample.t,          sample.seen,
                                      sample.servo, sample.servo_rate, sample.reference};
    SerialAnswer said = program_->exchange(its, arrived_, program_columns_, numbers_.data());
    arrived_.clear();
    sent_ += said.bytes.size();
    baud_ = said.baud.value_or(baud_);
    const double theirs = sketch_->line().baud;
    constexpr double tolerated = 0.04;  // receivers sample the tenth bit half a bit too late
    if (!said.bytes.empty() && baud_ > 0 && theirs > 0 &&
        std::abs(baud_ / theirs - 1) > tolerated) {
      throw program_->refuse(its, "it opened the line at " + short_number(baud_) +
                                      " baud, and the sketch at " + rounded(theirs, 4) +
                                      "; allowed: the same");
    }
    return std::move(said.bytes);
  }

  std::shared_ptr<Program> program_;
  std::shared_ptr<Library> sketch_;
  Setup setup_;
  std::vector<std::string> program_columns_;
  std::vector<double> numbers_, sketch_numbers_;  // of each one's columns
  std::string arrived_;                           // at the program, since its last sample
  std::size_t samples_ = 0, sent_ = 0;            // of the program; bytes
  double due_ = 0;                                // the time of its next sample, in its periods
  double baud_ = 0;                               // that it named, or 0
};

Host::Host(Report report, const std::atomic<bool>* stop)
    : report_(std::move(report)), stop_(stop) {}

Host::~Host() {
  try {
    finish();
  } catch (...) {  // nobody is left to be told
  }
}

void Host::finish() {
  if (program_) program_->finish();
}

void Host::attach(const Scenario& scenario, model::Model& model) {
  if (!scenario.controller || !scenario.controller->own) return;
  const OwnController& own = *scenario.controller->own;
  const Setup setup = setup_of(scenario);
  std::shared_ptr<model::ExternalController>& place = model.rig->sampled->external;
  if (const auto* factory = std::get_if<ControllerFactory>(&own.by)) {
    place = factory->make(scenario);
    return;
  }
  if (serial_program(own) != nullptr) {
    const Setup its = serial_setup_of(scenario);
    start_program(own, its);
    line_ = std::make_shared<SerialLine>(program_, its);
    open_library(own, line_->without_columns(setup));
    line_->connect(library_);
    place = line_;
  } else if (std::holds_alternative<ControllerLibrary>(own.by)) {
    open_library(own, setup);
    place = library_;
  } else {
    start_program(own, setup);
    require_columns(setup.columns);
    place = program_;
  }
}

void Host::start_program(const OwnController& own, const Setup& setup) {
  if (program_ && program_->is(own)) return program_->renew(setup);
  if (program_) program_->finish();
  program_ = std::make_shared<Program>(own, setup, report_, stop_);
}

void Host::open_library(const OwnController& own, const Setup& setup) {
  if (library_ && library_->is(own)) return library_->renew(setup);
  library_ = std::make_shared<Library>(own, setup, report_);
}

void Host::require_columns(const std::vector<std::string>& asked) const {
  const auto& given = program_->ready().columns;
  if (!given) return;  // each answer is checked instead
  std::vector<std::string_view> names;
  for (const auto& [name, unit] : *given) names.push_back(name);
  for (const std::string& name : asked) {
    if (std::ranges::find(names, name) != names.end()) continue;
    const auto allowed = joined(names, [](std::string_view its) { return shown(its); });
    for (const scenario::Column& column : scenario::catalogue) names.push_back(column.name);
    throw KeyError("output.columns",
                   "found " + name + ", which neither bbsim nor the controller gives" +
                       yaml::hint(name, names) + "; allowed: those of bbsim columns" +
                       (allowed.empty() ? "" : ", and the controller's " + allowed));
  }
}

std::optional<std::string> Host::unit_of(std::string_view own_column) const {
  if (!program_ || !program_->ready().columns) return {};
  for (const auto& [name, unit] : *program_->ready().columns) {
    if (name == own_column) return unit;
  }
  return {};
}

void Host::require_printed() const {
  if (library_) library_->require_columns();
}

std::string Host::line_remark() const {
  return line_ ? line_->remark() : "";
}

std::string Host::unheard() const {
  return library_ ? library_->unheard() : "";
}

std::vector<std::string> Host::describe() const {
  std::vector<std::string> lines;
  if (library_) lines.emplace_back("the library opens, and makes a controller for this scenario");
  if (!program_) return lines;
  if (program_->fault()) throw model::ControllerFault(*program_->fault());
  const Ready& ready = program_->ready();
  lines.emplace_back("the program starts, and answers");
  lines.emplace_back(ready.reset ? "it can reset: a sweep starts one per thread"
                                 : "it does not declare a reset: a sweep starts one per case");
  if (ready.columns && !ready.columns->empty()) {
    lines.push_back((line_ ? "besides its bytes it gives " : "besides its commands it gives ") +
                    joined(*ready.columns, [](const auto& column) {
                      return shown(column.first) + " (" + shown(column.second) + ")";
                    }));
  }
  return lines;
}

std::vector<std::string> files_of(const Scenario& scenario) {
  if (!scenario.controller || !scenario.controller->own) return {};
  const OwnController& own = *scenario.controller->own;
  if (std::holds_alternative<ControllerFactory>(own.by)) return {};
  std::vector<std::string> files;
  std::vector<std::string> words;
  if (std::holds_alternative<ControllerLibrary>(own.by)) {
    files = Library::files_of(own);
    if (const SerialProgram* const serial = serial_program(own)) words = serial->program.command;
  } else {
    words = std::get<ControllerProgram>(own.by).command;
  }
  for (const std::string& word : words) {
    const std::filesystem::path path = std::filesystem::path(own.folder) / word;
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) files.push_back(path.string());
  }
  return files;
}

}  // namespace bbsim::controller
