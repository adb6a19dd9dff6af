// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A scene by a clock that starts later, for runs of a part of it.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::fit {

// The scene whose t = 0 is `begin` of the scenario's clock, up to `end` (s, both of that clock).
// Motions, torques, pushes and the reference go on as they are then. Tables lose rows that are too
// far away to matter. A sampled controller begins to sample at t = 0; one that plays known commands
// goes on with the clock of its samples, and with the commands that are on their way.
[[nodiscard]] Scenario from_time(const Scenario& scenario, double begin, double end);

// The times that all tables of the scene cover, s; infinite without tables.
struct Span {
  double from, to;
};
[[nodiscard]] Span span_of_tables(const Scenario& scenario);

}  // namespace bbsim::fit
