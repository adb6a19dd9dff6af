// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The recurring times of a sampled loop: lengths of its pieces, and samples within them.
#pragma once

#include <array>
#include <optional>

#include "model/servo/held_motion.hpp"
#include "model/systems/rig.hpp"

namespace bbsim::solve::sampled {

// Unequal periods seldom recur; their pieces have the lengths that they have.
class Instants {
 public:
  // `cut`: pieces end at samples, too.
  explicit Instants(const model::SampledLoop& loop, bool cut = false);

  // The nominal length (s) of a piece that starts at `time`. Instants n * period have rounding
  // errors, so lengths differ. With nominal lengths one table serves all pieces, and the lengths
  // add up to the times themselves.
  [[nodiscard]] double nominal(double time, double length) const;

  // The exact recurring time that `after` stands for: both are in s from the start of a piece and
  // differ by rounding. Empty if it or the piece's length does not recur. The piece has `length` s
  // and ends near `time`.
  [[nodiscard]] std::optional<double> recurring(double time, double after, double length) const;

  // The impulse response `after` seconds into a piece that ends near `time`. Responses at samples
  // are cached. Valid until the next call.
  [[nodiscard]] const model::ImpulseAnswer& answer(const model::HeldLaw& law, double time,
                                                   double after);

 private:
  struct CachedAnswer {
    double after = -1;  // from the piece's start, s
    bool known = false;
    model::HeldLaw law{};
    model::ImpulseAnswer answer{};
  };
  // Lengths (s) of pieces from command to command, from sample to command, and back to a sample.
  std::array<double, 3> lengths_;
  std::array<CachedAnswer, 2> samples_;
  CachedAnswer other_;
};

}  // namespace bbsim::solve::sampled
