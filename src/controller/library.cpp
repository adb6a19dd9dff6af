// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "controller/library.hpp"

#include <bbsim/wiring.h>
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/text.hpp"
#include "controller/foreign_code.hpp"

namespace bbsim::controller {

struct LibraryFunctions {
  decltype(&bbsim_controller_abi) abi = nullptr;
  decltype(&bbsim_controller_create) create = nullptr;
  decltype(&bbsim_controller_create_wired) create_wired = nullptr;  // may be missing
  decltype(&bbsim_controller_step) step = nullptr;
  decltype(&bbsim_controller_reset) reset = nullptr;  // may be missing
  decltype(&bbsim_controller_destroy) destroy = nullptr;
  decltype(&bbsim_controller_last_error) last_error = nullptr;
  // Only sketches have these.
  decltype(&bbsim_sketch_printed) printed = nullptr;
  decltype(&bbsim_sketch_unheard) unheard = nullptr;
  decltype(&bbsim_sketch_send) send = nullptr;
  decltype(&bbsim_sketch_receive) receive = nullptr;
  decltype(&bbsim_sketch_line) line = nullptr;
};

namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw KeyError("controller.library.file", "found " + shown(path, uncut) + ", " + why);
}

template <class Function>
void find(void* library, const char* name, Function*& function) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as dlsym gives functions
  function = reinterpret_cast<Function*>(dlsym(library, name));
}

std::shared_ptr<const LibraryFunctions> open(const std::string& path) {
  std::string error;
  void* const library = open_library(path, error);
  if (library == nullptr) {
    refuse(path, "which cannot be opened: " + shown(error, longest_saying) +
                     "; allowed: a shared library, as bbsim/controller.h says");
  }
  const auto functions = std::make_shared<LibraryFunctions>();
  const auto require = [&](const char* name, auto*& function) {
    find(library, name, function);
    if (function != nullptr) return;
    refuse(path, std::string("which has no function ") + name +
                     "; allowed: a shared library, as bbsim/controller.h says");
  };
  require("bbsim_controller_abi", functions->abi);
  const std::uint32_t abi = functions->abi();
  if (abi != BBSIM_CONTROLLER_ABI) {
    refuse(path, "which is of version " + std::to_string(abi) +
                     " of bbsim/controller.h; allowed: version " +
                     std::to_string(BBSIM_CONTROLLER_ABI) + ": compile it again");
  }
  require("bbsim_controller_create", functions->create);
  require("bbsim_controller_step", functions->step);
  require("bbsim_controller_destroy", functions->destroy);
  require("bbsim_controller_last_error", functions->last_error);
  find(library, "bbsim_controller_create_wired", functions->create_wired);
  find(library, "bbsim_controller_reset", functions->reset);
  find(library, "bbsim_sketch_printed", functions->printed);
  find(library, "bbsim_sketch_unheard", functions->unheard);
  find(library, "bbsim_sketch_send", functions->send);
  find(library, "bbsim_sketch_receive", functions->receive);
  find(library, "bbsim_sketch_line", functions->line);
  return functions;
}

// The values of bbsim_setup::drives_acceleration, in the order of Drives.
constexpr std::uint32_t c_drives[] = {1, 0, 2, 3, 4};
static_assert(std::size(c_drives) == static_cast<std::size_t>(Drives::legs) + 1);

// A setup for a library, valid as long as this object.
class CSetup {
 public:
  explicit CSetup(const Setup& setup) {
    for (const Parameter& parameter : setup.parameters) {
      parameters_.push_back({parameter.name.c_str(), parameter.value});
    }
    for (const std::string& name : setup.columns) columns_.push_back(name.c_str());
    c_ = {BBSIM_CONTROLLER_ABI, c_drives[static_cast<std::size_t>(setup.drives)],
          setup.period,         setup.delay,
          setup.resolution,     setup.derivative_filter,
          setup.limit,          setup.end,
          parameters_.size(),   parameters_.empty() ? nullptr : parameters_.data(),
          columns_.size(),      columns_.empty() ? nullptr : columns_.data()};
  }
  CSetup(const CSetup&) = delete;
  CSetup& operator=(const CSetup&) = delete;
  [[nodiscard]] const bbsim_setup* get() const { return &c_; }

 private:
  std::vector<bbsim_parameter> parameters_;
  std::vector<const char*> columns_;
  bbsim_setup c_{};
};

}  // namespace

std::string Library::path_of(const OwnController& own) {
  const std::filesystem::path path =
      std::filesystem::path(own.folder) / std::get<ControllerLibrary>(own.by).file;
  // dlopen() would search the system's libraries for a name without a slash.
  return path.has_parent_path() ? path.string() : "./" + path.string();
}

std::string Library::wiring_path_of(const OwnController& own) {
  const std::string& file = std::get<ControllerLibrary>(own.by).wiring;
  return file.empty() ? "" : (std::filesystem::path(own.folder) / file).string();
}

std::vector<std::string> Library::files_of(const OwnController& own) {
  std::vector<std::string> files{path_of(own)};
  if (const std::string wiring = wiring_path_of(own); !wiring.empty()) {
    const std::vector<std::string> its = sketch::Wiring(wiring).files();
    files.insert(files.end(), its.begin(), its.end());
  }
  return files;
}

Library::Library(const OwnController& own, const Setup& setup, Report report)
    : path_(path_of(own)),
      wiring_path_(wiring_path_of(own)),
      setup_(setup),
      report_(std::move(report)) {
  if (!wiring_path_.empty()) wiring_.emplace(wiring_path_);
  functions_ = open(path_);
  if (wiring_ && functions_->create_wired == nullptr) {
    throw KeyError("controller.library.wiring",
                   "found beside " + shown(path_, uncut) +
                       ", which is not a sketch; allowed: with a library that bbsim sketch made");
  }
  create();
}

Library::~Library() {
  destroy();
}

void Library::destroy() {
  if (controller_ != nullptr) functions_->destroy(controller_);
  controller_ = nullptr;
}

std::string Library::last_error() const {
  const char* const text = functions_->last_error(controller_);
  return text == nullptr || *text == '\0' ? "it does not say why" : shown(text, longest_saying);
}

// Gives the wiring's steppers the microsteps of the scenario's. Throws KeyError if one has a
// stepper where the other has a servo.
void Library::fit_steppers(bbsim_wiring& wired) const {
  for (std::size_t i = 0; i < setup_.microstep.size(); ++i) {
    const bool stepper = wired.steppers[i].step >= 0;
    const bool servo = wired.servos[i].pin >= 0 || wired.servos[i].channel >= 0;
    if ((stepper && setup_.microstep[i] == 0) || (servo && setup_.microstep[i] > 0)) {
      throw KeyError("controller.library.wiring",
                     "found " + shown(wiring_path_, uncut) + ", which wires a " +
                         (stepper ? "stepper" : "servo") + " where the scenario has a " +
                         (stepper ? "servo; allowed: with gimbal.servo.stepper"
                                  : "stepper; allowed: a wiring with steppers"));
    }
    wired.steppers[i].angle *= setup_.microstep[i];
  }
}

void Library::create() {
  destroy();
  fresh_ = true;
  const CSetup setup(setup_);
  if (wiring_) {
    bbsim_wiring wired = *wiring_->get();
    wired.reader = this;
    // Called on the sketch's small stack: it only keeps the line.
    wired.print = [](void* reader, const char* line) {
      static_cast<Library*>(reader)->printed_.emplace_back(line);
    };
    if (wiring_->print() == sketch::Wiring::Print::off) wired.print = nullptr;
    wired.seed = setup_.seed;
    fit_steppers(wired);
    controller_ = functions_->create_wired(setup.get(), &wired);
  } else {
    controller_ = functions_->create(setup.get());
  }
  if (controller_ == nullptr) {
    throw KeyError("controller.library",
                   "found " + shown(path_, uncut) +
                       ", which makes no controller for this scenario: " + last_error());
  }
}

void Library::renew(const Setup& setup) {
  setup_ = setup;
  fresh_ = false;
  if (controller_ != nullptr && functions_->reset != nullptr) {
    const CSetup its(setup_);
    fresh_ = functions_->reset(controller_, its.get()) == 0;
  }
  if (!fresh_) create();
}

void Library::require_line() const {
  if (functions_->send == nullptr || functions_->receive == nullptr ||
      functions_->line == nullptr) {
    throw KeyError("controller.library.file",
                   "found " + shown(path_, uncut) +
                       ", which an earlier bbsim sketch made, without a serial line; allowed: "
                       "compile it again");
  }
  if (wiring_->get()->camera.port >= 0) {
    throw KeyError("controller.library.serial",
                   "found beside the camera of " + shown(wiring_path_, uncut) +
                       "; allowed: one of the two, since the program gives the ball's place");
  }
}

void Library::send(std::string_view bytes, double delay) {
  functions_->send(controller_, bytes.data(), bytes.size(), delay);
}

void Library::receive(std::string& bytes) {
  char some[4096];
  for (;;) {
    const std::size_t size = functions_->receive(controller_, some, sizeof some);
    bytes.append(some, size);
    if (size < sizeof some) return;
  }
}

bbsim_line Library::line() const {
  return controller_ == nullptr ? bbsim_line{} : functions_->line(controller_);
}

void Library::begin() {
  if (!fresh_) renew(setup_);
  fresh_ = false;
}

model::Commands Library::command(const model::ControllerSample& sample, double* own) {
  const auto& [x, y] = sample.reference;
  const Pair ball = sample.seen.value_or(Pair{0, 0});
  const bbsim_sample given{sample.number,
                           sample.t,
                           sample.seen ? 1.0 : 0.0,
                           {ball[0], ball[1]},
                           {x.value, y.value},
                           {x.rate, y.rate},
                           {x.acceleration, y.acceleration},
                           {sample.servo[0], sample.servo[1]},
                           {sample.servo_rate[0], sample.servo_rate[1]},
                           sample.servo.size() == 3 ? sample.servo[2] : 0,
                           sample.servo.size() == 3 ? sample.servo_rate[2] : 0};
  const auto fail = [&](const std::string& why) {
    return model::ControllerFault("the controller (" + shown(path_, uncut) + ") failed at sample " +
                                  std::to_string(sample.number) + " (t = " + number_text(sample.t) +
                                  " s): " + why);
  };
  model::Commands command;
  command.fill(std::nan(""));
  const int code = functions_->step(controller_, &given, command.data(), own);
  pass_on_prints();
  if (wiring_ && code == BBSIM_WIRING_AT_FAULT) {
    throw KeyError("controller.library.wiring", shown(wiring_path_, uncut) + ": " + last_error());
  }
  if (code != 0) throw fail("it returned " + std::to_string(code) + ": " + last_error());
  const std::span<const double> given_back(command.data(), sample.servo.size());
  if (!std::ranges::all_of(given_back, [](double value) { return std::isfinite(value); })) {
    // Commands that the library does not write stay NaN.
    const bool lacks_third =
        given_back.size() == 3 && std::isnan(given_back[2]) && std::isfinite(given_back[1]);
    throw fail("its command is [" + joined(given_back, number_text) + "]; allowed: finite numbers" +
               (lacks_third ? ", and three of them: define BBSIM_CONTROLLER_COMMANDS 3 and write "
                              "command[2]"
                            : ""));
  }
  for (std::size_t i = 0; i < setup_.columns.size(); ++i) {
    if (std::isfinite(own[i]) || !is_printed(i)) continue;
    throw fail("its column " + shown(setup_.columns[i]) + " is " + number_text(own[i]) +
               "; allowed: a finite number");
  }
  return command;
}

// A sketch may print at each sample, so only the first lines are shown unless the wiring asks for
// all.
void Library::pass_on_prints() {
  constexpr std::size_t first_lines = 10;
  for (const std::string& line : printed_) {
    ++shown_;
    if (wiring_->print() == sketch::Wiring::Print::all || shown_ <= first_lines) {
      report_(line);
    } else if (shown_ == first_lines + 1) {
      report_("... (the sketch prints more; print: all in its wiring shows all)");
    }
  }
  printed_.clear();
}

bool Library::is_printed(std::size_t column) const {
  return functions_->printed == nullptr || functions_->printed(controller_, column) != 0;
}

void Library::require_columns() const {
  if (controller_ == nullptr) return;
  for (std::size_t i = 0; i < setup_.columns.size(); ++i) {
    if (is_printed(i)) continue;
    const std::string name = shown(setup_.columns[i]);
    throw KeyError("output.columns", "found " + name +
                                         ", which the sketch never printed; allowed: "
                                         "those of bbsim columns, and numbers that it prints after "
                                         "their names, as \"" +
                                         name + ":0.5\"");
  }
}

std::string Library::unheard() const {
  if (functions_->unheard == nullptr || controller_ == nullptr) return "";
  std::string pins;
  for (std::size_t n = 0;; ++n) {
    const int pin = functions_->unheard(controller_, n);
    if (pin < 0) break;
    pins += (pins.empty() ? "" : ", ") + sketch::pin_name(pin);
  }
  if (pins.empty()) return "";
  return "the sketch drives " +
         std::string(pins.find(',') == std::string::npos ? "pin " : "pins ") + pins +
         ", to which nothing is wired; name in the wiring what is there, or, if it does not "
         "move the plate, in " +
         (wiring_ && wiring_->has_steppers() ? "steppers" : "servos") + ".ignored: [" + pins + "]";
}

}  // namespace bbsim::controller
