// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Lists the cases of a sweep: combines and numbers the values of its keys.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "scenario/family.hpp"
#include "scenario/variation.hpp"

namespace bbsim::sweep {

// One key that varies. Keys may be tied: all but the first then take its values times a factor, and
// add no cases.
struct PlanAxis {
  std::string key;
  std::size_t lead = 0;  // the axis whose values it takes; its own index if it is not tied
  double factor = 1;     // multiplies these values
  scenario::VariationSpec::Kind kind = scenario::VariationSpec::Kind::list;
  bool numeric = true;               // single numbers in SI units; otherwise texts in YAML
  std::string unit{};                // of these numbers, if the key would read others in another
  std::size_t count = 1;             // number of values; 1 if they are drawn
  double from = 0, to = 0;           // bounds; mean and standard deviation of normal
  std::vector<double> numbers{};     // of a list
  std::vector<std::string> texts{};  // of a list that is not numeric
  std::uint64_t stream = 0;          // seeds the draws of this key
  // No rule relates the number at any varied key to another key. The same for all axes.
  bool independent = false;

  [[nodiscard]] bool random() const {
    return kind == scenario::VariationSpec::Kind::uniform ||
           kind == scenario::VariationSpec::Kind::normal;
  }
};

// Cases are numbered from 0. In a grid the first key varies slowest. Zipped keys all advance from
// case to case. Each combination occurs `samples` times in a row, with new draws.
class SweepPlan {
 public:
  // Reads all listed values, which checks them. Throws InputError with the number of the case in
  // which a value is refused, as check() does.
  SweepPlan(const ScenarioFamily& family, const Sweep& sweep);

  // A key with a value for each case: numbers (SI), or texts in YAML. An empty text leaves the
  // scenario's own value.
  struct ListedKey {
    std::string key;
    std::vector<double> numbers{};
    std::vector<std::string> texts{};
  };
  // Lists cases. They may have errors, which appear when they are run. They replace
  // overrides. Throws InputError for keys that overlap each other, and if no case can be read;
  // beyond 64 cases, if none of 64 from all over the list can.
  SweepPlan(const ScenarioFamily& family, std::vector<ListedKey> keys, std::size_t cases);

  [[nodiscard]] std::size_t cases() const { return cases_; }
  // Case i of a sample from all over the sweep. Multiples of the golden ratio do not fall into step
  // with a grid's keys.
  [[nodiscard]] std::size_t sampled(std::size_t i) const;
  [[nodiscard]] const std::vector<PlanAxis>& axes() const { return axes_; }

  // Whether no rule relates the number at any varied key to another key.
  [[nodiscard]] bool independent() const { return axes_.empty() || axes_.front().independent; }

  // Writes the number of each axis in a case, or the index of its text in the list.
  void values(std::size_t number, double* values) const;
  // Those of all cases.
  [[nodiscard]] std::vector<ListedKey> values() const;

  // The values of a case as settings of a scenario.
  [[nodiscard]] std::vector<ScenarioFamily::Setting> settings(std::size_t number) const;
  // Those of the first case; of a case that can be read, if the first cannot.
  [[nodiscard]] std::vector<ScenarioFamily::Setting> first_settings() const {
    return settings(first_);
  }

  // Settings in which a number is 0 only if its key takes no other value. Their scene is symmetric
  // only if every case is. Requires independent(). No case need have these settings.
  [[nodiscard]] std::vector<ScenarioFamily::Setting> general_settings() const;

  // Runs the scenario's checks on cases first ... last - 1: on each case if keys depend on each
  // other, otherwise on the extremes. Calls goes_on() with the fraction done, 0 to 1; if it returns
  // false, check() stops and returns false. Throws InputError.
  [[nodiscard]] bool check(const ScenarioFamily& family, std::size_t first, std::size_t last,
                           const std::function<bool(double)>& goes_on) const;

 private:
  struct Variations;

  // Finds out whether the keys are independent.
  void relate(const ScenarioFamily& family);
  void find_first(const ScenarioFamily& family);
  [[nodiscard]] bool can_read_extremes(const ScenarioFamily& family) const;
  void add_axes(const ScenarioFamily& family, const Sweep& sweep, const Variations& variations,
                std::size_t which);
  [[nodiscard]] std::vector<ScenarioFamily::Setting> settings_of(
      const std::vector<double>& values) const;
  [[nodiscard]] bool is_lead(std::size_t axis) const { return axes_[axis].lead == axis; }
  [[nodiscard]] static double drawn(const PlanAxis& axis, std::size_t number);

  std::vector<PlanAxis> axes_;
  Combine combine_;
  std::size_t samples_ = 1, cases_ = 1, first_ = 0;
  std::uint64_t seed_ = 0;
};

}  // namespace bbsim::sweep
