// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which cases a sweep has: what its keys vary over, combined and numbered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenario/family.hpp"
#include "scenario/variation.hpp"

namespace bbsim::sweep {

// One key that varies. Keys may be tied: all but the first then take its values times a factor, and
// add no cases of their own.
struct Axis {
  std::string key;
  std::size_t lead = 0;  // the axis whose values it takes; its own number if it is tied to none
  double factor = 1;     // by which it takes them
  scenario::VariationSpec::Kind kind = scenario::VariationSpec::Kind::list;
  bool numeric = true;      // single numbers, in SI units; otherwise texts in YAML
  std::size_t count = 1;    // of values; 1 of what is drawn
  double from = 0, to = 0;  // of linear, log and uniform; mean and standard deviation of normal
  std::vector<double> numbers{};     // of a list
  std::vector<std::string> texts{};  // of a list that is not numeric
  std::uint64_t stream = 0;          // tells its draws from those of other keys
  // No rule relates the number at any of the varied keys to another key: for all axes or none.
  bool independent = false;

  [[nodiscard]] bool random() const {  // of a lead
    return kind == scenario::VariationSpec::Kind::uniform ||
           kind == scenario::VariationSpec::Kind::normal;
  }
};

// Cases are numbered from 0. In a grid the first key varies slowest; zipped, all keys go on
// together from case to case; either way each combination comes `samples` times in a row, with
// other draws.
class SweepPlan {
 public:
  // Reads all values that are listed, and so checks them. Throws InputError, which names the case
  // that a value is refused in; so does check().
  SweepPlan(const ScenarioFamily& family, const Sweep& sweep);

  [[nodiscard]] std::size_t cases() const { return cases_; }
  [[nodiscard]] const std::vector<Axis>& axes() const { return axes_; }

  // Whether no rule relates the number at any of the varied keys to another key.
  [[nodiscard]] bool independent() const { return axes_.front().independent; }

  // Whether all cases have one motion or reference, at the same times.
  [[nodiscard]] bool shares_signals() const;

  // The number of each axis in a case, or the position of its text in the list.
  void values(std::size_t number, double* values) const;

  // The values of a case as settings of a scenario.
  [[nodiscard]] std::vector<ScenarioFamily::Setting> settings(std::size_t number) const;

  // Settings of which no number is 0 if its key takes any that is not: of a scene that is symmetric
  // only if every case is. Of keys that are independent(); no case need have them.
  [[nodiscard]] std::vector<ScenarioFamily::Setting> general_settings() const;

  // Puts cases first ... last - 1 to the scenario's checks: one by one where keys depend on each
  // other, by the extremes where they do not. `goes_on` is told how far it is, from 0 to 1, and may
  // end it by returning false; check() then returns false. Throws InputError.
  [[nodiscard]] bool check(const ScenarioFamily& family, std::size_t first, std::size_t last,
                           const std::function<bool(double)>& goes_on) const;

 private:
  struct Variations;

  void add_axes(const ScenarioFamily& family, const Sweep& sweep, const Variations& variations,
                std::size_t which);
  [[nodiscard]] std::vector<ScenarioFamily::Setting> settings_of(
      const std::vector<double>& values) const;
  [[nodiscard]] bool is_lead(std::size_t axis) const { return axes_[axis].lead == axis; }
  [[nodiscard]] static double drawn(const Axis& axis, std::size_t number);

  std::vector<Axis> axes_;
  Combine combine_;
  std::size_t samples_ = 1, cases_ = 1;
  std::uint64_t seed_;
};

}  // namespace bbsim::sweep
