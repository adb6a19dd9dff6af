// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What comes again from period to period of a sampled loop: how long its pieces are, and when
// within them samples are taken.
#pragma once

#include <array>
#include <optional>

#include "model/servo/held_motion.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::solve::sampled {

// Of a loop whose periods are all alike.
class Instants {
 public:
  explicit Instants(const model::SampledLoop& loop);

  // Instants n * period differ by roundings of the time (s). Pieces between them get the length
  // that they are meant to have: one table serves all, and the lengths add up to the times
  // themselves.
  [[nodiscard]] double nominal(double time, double length) const;

  // The time that is meant by `after` (s), after the beginning of a piece that ends at `time` or so
  // and has that length, if both come again from period to period.
  [[nodiscard]] std::optional<double> recurring(double time, double after, double length) const;

  // The answer to an impulse so long after the beginning of such a piece, kept for the instants at
  // which samples are taken. Valid until the next call.
  [[nodiscard]] const model::ImpulseAnswer& answer(const model::HeldLaw& law, double time,
                                                   double after);

 private:
  struct Kept {
    double after = -1;  // the piece's start, s
    bool known = false;
    model::HeldLaw law{};
    model::ImpulseAnswer answer{};
  };
  std::array<double, 2> lengths_;  // of pieces from command to command, s
  std::array<Kept, 2> samples_;
  Kept other_;
};

}  // namespace bbsim::solve::sampled
