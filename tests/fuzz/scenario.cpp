// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Scenario text with overrides, up to the model and its description.
//
// An input is YAML; its lines that begin with "--set " are overrides, as on a command line.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "fuzz.hpp"
#include "model/model.hpp"
#include "scenario/reader.hpp"

namespace {

using namespace bbsim_fuzz;

void must_be_a_model(const bbsim::Scenario& scenario) {
  using namespace bbsim;
  const model::Model model = model::assemble(scenario, true);
  for (const model::Note& note : model::explain(scenario, model)) must(!note.part.empty());
  must(model.state_names().size() == model.size());
  must(std::all_of(model.initial.begin(), model.initial.end(),
                   [](double x) { return std::isfinite(x); }));
  must(std::is_sorted(model.stops.begin(), model.stops.end()));
  for (const double stop : model.stops) must(0 < stop && stop < scenario.time.end);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::string_view option = "--set ";
  std::string text;
  std::vector<std::string> overrides;
  for (std::string_view rest = text_of(data, size); !rest.empty();) {
    const std::string_view line = take_line(rest);
    if (line.starts_with(option)) {
      overrides.emplace_back(line.substr(option.size()));
    } else {
      text.append(line) += '\n';
    }
  }
  may_refuse([&] { must_be_a_model(bbsim::parse_scenario(text, "fuzz.yaml", overrides)); });
  return 0;
}
