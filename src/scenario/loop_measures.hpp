// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Measures of the control loop near home: stability, margins and bandwidths. They depend on the
// scenario, but not on its motion.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "scenario/columns.hpp"
#include "scenario/scenario.hpp"

namespace bbsim::scenario {

struct LoopMeasure {
  enum class Kind {
    stable,
    spectral_radius,
    spectral_abscissa,
    gain_margin,
    gain_reduction,
    phase_margin,
    delay_margin,
    bandwidth,
    feedback_bandwidth
  } kind;
  std::size_t axis;  // 0: phi and x, or stability and spectra; 1: theta and y
  std::string_view name, unit, meaning;

  // Whether it comes from the loop's frequency response rather than from its poles.
  [[nodiscard]] bool of_response() const { return kind > Kind::spectral_abscissa; }
};

inline constexpr std::array loop_measures = {
    LoopMeasure{LoopMeasure::Kind::stable, 0, "stable", "1",
                "1 if all modes of the loop near home decay, otherwise 0"},
    LoopMeasure{LoopMeasure::Kind::spectral_radius, 0, "spectral_radius", "1",
                "of a sampled loop near home: factor of its slowest mode per sample"},
    LoopMeasure{LoopMeasure::Kind::spectral_abscissa, 0, "spectral_abscissa", "1/s",
                "greatest real part of the loop's poles near home; of a sampled loop, "
                "ln(spectral_radius) per period"},
    LoopMeasure{LoopMeasure::Kind::gain_margin, 0, "phi_gain_margin", "1",
                "smallest factor above 1 on phi's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::gain_reduction, 0, "phi_gain_reduction", "1",
                "greatest factor below 1 on phi's command that makes the loop unstable; 0: none"},
    LoopMeasure{LoopMeasure::Kind::phase_margin, 0, "phi_phase_margin", "rad",
                "smallest turn of phase, lag or lead, of phi's command that makes the loop "
                "unstable"},
    LoopMeasure{LoopMeasure::Kind::delay_margin, 0, "phi_delay_margin", "s",
                "shortest further delay of phi's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::gain_margin, 1, "theta_gain_margin", "1",
                "smallest factor above 1 on theta's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::gain_reduction, 1, "theta_gain_reduction", "1",
                "greatest factor below 1 on theta's command that makes the loop unstable; 0: none"},
    LoopMeasure{LoopMeasure::Kind::phase_margin, 1, "theta_phase_margin", "rad",
                "smallest turn of phase, lag or lead, of theta's command that makes the loop "
                "unstable"},
    LoopMeasure{LoopMeasure::Kind::delay_margin, 1, "theta_delay_margin", "s",
                "shortest further delay of theta's command that makes the loop unstable"},
    LoopMeasure{LoopMeasure::Kind::bandwidth, 0, "x_bandwidth", "rad/s",
                "where the response of x to x_reference first falls to 1/sqrt(2)"},
    LoopMeasure{LoopMeasure::Kind::feedback_bandwidth, 0, "x_feedback_bandwidth", "rad/s",
                "the bandwidth of x without the reference's accelerations"},
    LoopMeasure{LoopMeasure::Kind::bandwidth, 1, "y_bandwidth", "rad/s",
                "where the response of y to y_reference first falls to 1/sqrt(2)"},
    LoopMeasure{LoopMeasure::Kind::feedback_bandwidth, 1, "y_feedback_bandwidth", "rad/s",
                "the bandwidth of y without the reference's accelerations"},
};

// Returns null for an unknown name.
[[nodiscard]] const LoopMeasure* find_loop_measure(std::string_view name);

// Why the scene lacks the measure, as far as its keys tell.
[[nodiscard]] Missing missing(const LoopMeasure& measure, const Scenario& scenario);

}  // namespace bbsim::scenario
