#include "controller/library.hpp"

#include <bbsim/controller.h>
#include <dlfcn.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "base/error.hpp"
#include "base/number_text.hpp"
#include "base/shown.hpp"
#include "controller/foreign_code.hpp"

namespace bbsim::controller {

struct LibraryFunctions {
  decltype(&bbsim_controller_abi) abi = nullptr;
  decltype(&bbsim_controller_create) create = nullptr;
  decltype(&bbsim_controller_step) step = nullptr;
  decltype(&bbsim_controller_reset) reset = nullptr;  // may be missing
  decltype(&bbsim_controller_destroy) destroy = nullptr;
  decltype(&bbsim_controller_last_error) last_error = nullptr;
  decltype(&bbsim_controller_save) save = nullptr;  // these two may be missing
  decltype(&bbsim_controller_restore) restore = nullptr;
};

namespace {

// Bytes: more than a microcontroller has, by far.
constexpr std::size_t most_remembered = std::size_t{64} * 1024 * 1024;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw KeyError("controller.library.file", "found " + shown(path, uncut) + ", " + why);
}

template <class Function>
bool find(void* library, const char* name, Function*& function) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): as dlsym gives functions
  function = reinterpret_cast<Function*>(dlsym(library, name));
  return function != nullptr;
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
    if (find(library, name, function)) return;
    refuse(path, std::string("which has no function ") + name +
                     "; allowed: a shared library, as bbsim/controller.h says");
  };
  require("bbsim_controller_abi", functions->abi);
  const std::uint32_t abi = functions->abi();
  if (abi != BBSIM_CONTROLLER_ABI) {
    refuse(path, "which is of version " + std::to_string(abi) +
                     " of bbsim/controller.h; allowed: version " +
                     std::to_string(BBSIM_CONTROLLER_ABI) + ": compile it anew");
  }
  require("bbsim_controller_create", functions->create);
  require("bbsim_controller_step", functions->step);
  require("bbsim_controller_destroy", functions->destroy);
  require("bbsim_controller_last_error", functions->last_error);
  static_cast<void>(find(library, "bbsim_controller_reset", functions->reset));
  static_cast<void>(find(library, "bbsim_controller_save", functions->save));
  static_cast<void>(find(library, "bbsim_controller_restore", functions->restore));
  return functions;
}

// What a setup is for a library, as long as this stays.
class CSetup {
 public:
  explicit CSetup(const Setup& setup) {
    for (const Parameter& one : setup.parameters) {
      parameters_.push_back({one.name.c_str(), one.value});
    }
    for (const std::string& name : setup.columns) columns_.push_back(name.c_str());
    c_ = {BBSIM_CONTROLLER_ABI, setup.drives == Drives::acceleration ? 1U : 0U,
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
  // A name without a slash would be looked for among the system's libraries.
  return path.has_parent_path() ? path.string() : "./" + path.string();
}

Library::Library(const OwnController& own, const Setup& setup)
    : path_(path_of(own)), setup_(setup), functions_(open(path_)) {
  create();
}

Library::~Library() {
  if (controller_ != nullptr) functions_->destroy(controller_);
}

std::string Library::last_error(const void* controller) const {
  const char* const text = functions_->last_error(controller);
  return text == nullptr || *text == '\0' ? "it does not say why" : shown(text, longest_saying);
}

void Library::create() {
  if (controller_ != nullptr) functions_->destroy(controller_);
  controller_ = functions_->create(CSetup(setup_).get());
  if (controller_ == nullptr) {
    throw KeyError("controller.library",
                   "found " + shown(path_, uncut) +
                       ", which makes no controller for this scene: " + last_error(nullptr));
  }
  fresh_ = true;
}

void Library::renew(const Setup& setup) {
  setup_ = setup;
  fresh_ =
      functions_->reset != nullptr && functions_->reset(controller_, CSetup(setup_).get()) == 0;
  if (!fresh_) create();
}

void Library::begin() {
  if (!fresh_) renew(setup_);
  fresh_ = false;
}

model::ControllerFault Library::fault_of(const std::string& when, const std::string& why) const {
  return model::ControllerFault("the controller (" + shown(path_, uncut) + ") failed " + when +
                                ": " + why);
}

bool Library::can_save() const {
  return functions_->save != nullptr && functions_->restore != nullptr;
}

std::string Library::save() {
  const std::size_t size = functions_->save(controller_, nullptr, 0);
  if (size > most_remembered) {
    throw fault_of("to save its state", "it would take " + std::to_string(size) +
                                            " bytes; allowed: at most " +
                                            std::to_string(most_remembered));
  }
  std::string memory(size, '\0');
  if (memory.empty() ||
      functions_->save(controller_, memory.data(), memory.size()) != memory.size()) {
    throw fault_of("to save its state", last_error(controller_));
  }
  return memory;
}

void Library::restore(const std::string& memory) {
  begin();
  const int code = functions_->restore(controller_, memory.data(), memory.size());
  if (code == 0) return;
  throw fault_of("to go on from a state",
                 "it returned " + std::to_string(code) + ": " + last_error(controller_));
}

Pair Library::command(const model::ControllerSample& sample, double* own) {
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
                           {sample.servo[2], sample.servo[3]}};
  const auto fail = [&](const std::string& why) {
    return fault_of(
        "at sample " + std::to_string(sample.number) + " (t = " + number_text(sample.t) + " s)",
        why);
  };
  Pair command{std::nan(""), std::nan("")};
  const int code = functions_->step(controller_, &given, command.data(), own);
  if (code != 0) throw fail("it returned " + std::to_string(code) + ": " + last_error(controller_));
  for (const double one : command) {
    if (!std::isfinite(one)) {
      throw fail("its command is [" + number_text(command[0]) + ", " + number_text(command[1]) +
                 "]; allowed: finite numbers");
    }
  }
  return command;
}

}  // namespace bbsim::controller
