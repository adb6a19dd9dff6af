// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The events of a run: a log of those that occurred, and monitors for those that only observe the
// motion or end the run.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/hybrid/part.hpp"
#include "model/hybrid/sampling.hpp"
#include "model/sample.hpp"

namespace bbsim::model {

class EventLog {
 public:
  EventLog(const SwitchedModel& model, const std::optional<Sampling>& sampling)
      : model_(model), sampling_(sampling) {}

  // Logs an event at t with states z.
  Effect note(std::string name, OnEvent action, double t, const double* z) {
    Sample now = model_.sample(t, z, Detail::all);
    now.gamma = model_.get().gamma_not_integrated();
    if (sampling_) now.measured = sampling_->measured();
    const bool stops = action == OnEvent::stop;
    occurrences_.push_back(
        {t, std::move(name), stops, now, sampling_ ? sampling_->own() : std::vector<double>{}});
    return stops ? Effect::stop : Effect::none;
  }

  // Sets the rotation of the ball in the occurrences since the last call. `integral` is the
  // integral of u = r gamma' from the start until now, m.
  void note_turned(double integral) {
    const Model& model = model_.get();
    for (; with_gamma_ < occurrences_.size(); ++with_gamma_) {
      if (model.gamma) occurrences_[with_gamma_].sample.gamma = integral / model.radius;
    }
  }

  [[nodiscard]] const std::vector<Occurrence>& occurrences() const { return occurrences_; }

 private:
  const SwitchedModel& model_;
  const std::optional<Sampling>& sampling_;  // of a sampled rig
  std::vector<Occurrence> occurrences_;
  std::size_t with_gamma_ = 0;  // number of occurrences with gamma set
};

class Monitors : public Part {
 public:
  Monitors(const SwitchedModel& model, EventLog& log)
      : model_(model), log_(log), occurring_(of().size(), 0) {}

  // One guard per monitor, with the opposite sign while the event holds.
  [[nodiscard]] std::size_t guards() const { return occurring_.size(); }
  void append_scales(std::vector<double>& scales) const {
    for (const Monitor& monitor : of()) scales.push_back(monitor.scale);
  }
  void evaluate(const GuardContext& now, double* values) const {
    margins(now.t, now.z, values);
    for (std::size_t m = 0; m < occurring_.size(); ++m) {
      if (occurring_[m] != 0) values[m] = -values[m];
    }
  }
  // Handles a crossing of guard m: its event begins or ends.
  Effect change(std::size_t m, double t, const double* z) {
    if (occurring_[m] == 0) return begin(m, t, z);
    occurring_[m] = 0;
    return Effect::none;
  }
  // Checks for events that a jump skipped.
  Effect check(double t, const double* z) {
    std::vector<double> values(occurring_.size());
    margins(t, z, values.data());
    for (std::size_t m = 0; m < occurring_.size(); ++m) {
      const bool beyond = values[m] < 0;
      if (beyond && occurring_[m] == 0 && begin(m, t, z) == Effect::stop) return Effect::stop;
      if (!beyond) occurring_[m] = 0;
    }
    return Effect::none;
  }

  // For each monitor, whether its event holds at present.
  [[nodiscard]] const std::vector<char>& occurring() const { return occurring_; }
  // Whether guard m stops the run when it crosses.
  [[nodiscard]] bool stops(std::size_t m) const {
    return occurring_[m] == 0 && of()[m].action == OnEvent::stop;
  }

 private:
  [[nodiscard]] const std::vector<Monitor>& of() const { return model_.get().events->monitors; }
  void margins(double t, const double* z, double* values) const {
    model_.get().events->margins(model_.sample(t, z, Detail::motion), values);
  }
  Effect begin(std::size_t m, double t, const double* z) {
    occurring_[m] = 1;
    return log_.note(of()[m].name(), of()[m].action, t, z);
  }

  const SwitchedModel& model_;
  EventLog& log_;
  std::vector<char> occurring_;
};

}  // namespace bbsim::model
