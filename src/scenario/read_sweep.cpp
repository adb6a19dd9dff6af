// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads `sweep`.
#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "scenario/measures.hpp"
#include "scenario/sections.hpp"
#include "scenario/variation.hpp"
#include "yaml/rules.hpp"
#include "yaml/spelling.hpp"

namespace bbsim::scenario {
namespace {

// A mapping from keys of the scenario to the values they take.
struct Variations {
  [[nodiscard]] static std::string allowed() {
    return "a mapping from keys to values, such as ball.radius: linear:0.005:0.02:16";
  }
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared variations(yaml::Declared::Kind::names);
    variations.parts.push_back(yaml::Declared::Kind::text);
    return variations;
  }
  static bool read(const yaml::Value& value, std::vector<Variation>& into) {
    if (value.node->kind != yaml::Node::Kind::mapping || value.node->entries.empty()) {
      return value.refuse("", allowed());
    }
    bool fine = true;
    for (const yaml::Entry& entry : value.node->entries) {
      if (entry.value->absent) continue;
      const yaml::Value spec{entry.value, value.path + '.' + entry.key, entry.position,
                             value.context};
      const auto same = [&](const Variation& variation) {
        return yaml::american(variation.key) == yaml::american(entry.key);
      };
      if (spec.node->kind != yaml::Node::Kind::scalar) {
        fine = spec.refuse("", "a text such as linear:0.005:0.02:16");
      } else if (std::ranges::any_of(into, same)) {
        fine = spec.report("found again; allowed: each key once");
      } else {
        into.push_back({entry.key, spec.node->text});
        fine = understood(spec, into.back()) && fine;
      }
    }
    return fine;
  }

 private:
  static bool understood(const yaml::Value& spec, const Variation& variation) {
    try {
      static_cast<void>(parse_variation(variation));
      static_cast<void>(tied_keys(variation));
      return true;
    } catch (const InputError& error) {
      const std::string text = error.what();
      return spec.report(text.substr(text.find(": ") + 2));
    }
  }
};

struct MeasureNames {
  [[nodiscard]] static std::string allowed() {
    return "a list of measures, such as [max_tilt, end_x]";
  }
  [[nodiscard]] static yaml::Declared declared() {
    yaml::Declared measures =
        yaml::Declared::list(1, yaml::Declared::unbounded, yaml::Declared::Kind::text);
    measures.distinct = true;
    return measures;
  }
  static bool read(const yaml::Value& value, std::vector<std::string>& into) {
    if (value.node->kind != yaml::Node::Kind::sequence || value.node->items.empty()) {
      return value.refuse("", allowed());
    }
    bool fine = true;
    for (std::size_t i = 0; i < value.node->items.size(); ++i) {
      const yaml::Value item = value.item(i);
      if (!find_measure(item.node->text)) {
        fine = item.refuse(measure_hint(item.node->text), allowed_measures());
      } else if (std::ranges::find(into, item.node->text) != into.end()) {
        fine = item.refuse(" again", "each measure once");
      } else {
        into.push_back(item.node->text);
      }
    }
    return fine;
  }
};

}  // namespace

void read_sweep(yaml::Keys& keys, Sweep& sweep) {
  keys.optional("vary", Variations{}, sweep.vary,
                {"from keys to [value specifications](commands.md#values-of-a-sweep), such as "
                 "`ball.radius: linear:0.005:0.02:16`"});
  keys.optional("combine", yaml::NameOf<Combine>{{{Combine::grid, "grid"}, {Combine::zip, "zip"}}},
                sweep.combine,
                {"`grid`: every combination; `zip`: first values together, then second ones"});
  keys.optional("samples", yaml::Whole{1, "1000"}, sweep.samples,
                {"cases to draw where values are drawn"});
  keys.optional("seed", yaml::Whole{0, "1000"}, sweep.seed, {"seed of drawn values"});
  keys.optional("measure", MeasureNames{}, sweep.measure,
                {.meaning = "[measures](measures.md) to keep, such as `max_tilt`, `x.RiseTime`",
                 .standard = "the [default measures](measures.md#default-measures-of-a-sweep)"});
}

}  // namespace bbsim::scenario
