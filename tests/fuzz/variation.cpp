// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The variations of a sweep: KEY=SPEC, the resulting plan, and the scenarios of its cases.
//
// An input has one line per --vary. If the first line is "zip", the keys vary together.
#include "scenario/variation.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "fuzz.hpp"
#include "scenario/family.hpp"
#include "sweep/plan.hpp"

namespace {

using namespace bbsim_fuzz;

const bbsim::ScenarioFamily& family() {
  static const bbsim::ScenarioFamily it(BBSIM_SOURCE_DIR "/configs/fig2b.yaml", {});
  return it;
}

void must_be_a_case(const bbsim::sweep::SweepPlan& plan, std::size_t number) {
  std::vector<double> values(plan.axes().size());
  plan.values(number, values.data());
  for (std::size_t a = 0; a < values.size(); ++a) {
    const bbsim::sweep::PlanAxis& axis = plan.axes()[a];
    must(axis.numeric || (values[a] >= 0 && values[a] < static_cast<double>(axis.texts.size())));
  }
  const auto settings = plan.settings(number);
  must(settings.size() == plan.axes().size());
  may_refuse([&] { (void)family().read(settings); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest = text_of(data, size);
  bbsim::Sweep sweep;
  if (rest.starts_with("zip\n")) {
    sweep.combine = bbsim::Combine::zip;
    take_line(rest);
  }
  may_refuse([&] {
    bool random = false;
    while (!rest.empty()) {
      sweep.vary.push_back(bbsim::scenario::split_variation(std::string(take_line(rest))));
      random = random || bbsim::scenario::parse_variation(sweep.vary.back()).random();
    }
    if (random) sweep.samples = 3;
    const bbsim::sweep::SweepPlan plan(family(), sweep);
    must(plan.cases() > 0);
    must_be_a_case(plan, 0);
    must_be_a_case(plan, plan.cases() / 2);
    must_be_a_case(plan, plan.cases() - 1);
  });
  return 0;
}
