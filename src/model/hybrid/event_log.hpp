// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The events that occurred in a run.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/events/occurrence.hpp"
#include "model/hybrid/part.hpp"
#include "model/hybrid/sampling.hpp"

namespace bbsim::model {

class EventLog {
 public:
  EventLog(const SwitchedModel& model, const std::optional<Sampling>& sampling)
      : model_(model), sampling_(sampling) {}

  // Notes an event at t with states z.
  Effect note(std::string name, OnEvent action, double t, const double* z) {
    Sample now = model_.sample(t, z, Detail::all);
    now.gamma = model_.get().gamma_not_integrated();
    if (sampling_) now.measured = sampling_->measured();
    const bool stops = action == OnEvent::stop;
    occurrences_.push_back(
        {t, std::move(name), stops, now, sampling_ ? sampling_->own() : std::vector<double>{}});
    return stops ? Effect::stop : Effect::none;
  }

  // Sets the rotation of the ball in the occurrences since the last call. `integral` is that of
  // u = r gamma' until now, m.
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

}  // namespace bbsim::model
