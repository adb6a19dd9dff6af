// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Moves a scene to a clock that starts later, to run a part of it.
#pragma once

#include "scenario/scenario.hpp"

namespace bbsim::sweep {

// Moves the clock so that t = 0 is `begin`, and ends the run at `end` (s, old clock). Motions,
// torques, pushes and the reference continue as they are then. Tables lose rows that are too far
// away to matter. A sampled controller starts sampling at t = 0; one that plays known commands
// keeps the clock of its samples and the commands under way.
[[nodiscard]] Scenario from_time(const Scenario& scenario, double begin, double end);

// Times that all tables of the scene cover, s; infinite without tables.
struct Span {
  double from, to;
};
[[nodiscard]] Span span_of_tables(const Scenario& scenario);

}  // namespace bbsim::sweep
