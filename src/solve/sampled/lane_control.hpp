// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// The controllers of rigs in lanes at a sample, for one instruction set.
#pragma once

#include <array>
#include <type_traits>

#include "simd/compare.hpp"
#include "solve/sampled/lane_kernel.hpp"

namespace bbsim::solve::sampled {

// Loads the packs that start at lane `first`.
template <class P>
struct LoadLanes {
  int first;

  BBSIM_INLINE P pack(const Lanes& from) const { return P::load(from.of + first); }
  template <class To, class From, std::size_t count>
  BBSIM_INLINE void each(To (&to)[count], const From (&from)[count]) const {
    for (std::size_t i = 0; i < count; ++i) {
      if constexpr (std::is_array_v<To>) {
        each(to[i], from[i]);
      } else if constexpr (std::is_same_v<To, P>) {
        to[i] = pack(from[i]);
      } else {
        to[i] = {pack(from[i].low), pack(from[i].high)};
      }
    }
  }
  BBSIM_INLINE model::SampledLaw<P> load(const model::SampledLaw<Lanes>& from) const {
    model::SampledLaw<P> law;
    law.law.kind = from.law.kind;
    law.integrates = from.integrates;
    model::for_each_number(
        law.law, from.law, [this](P & to, const Lanes& of) __attribute__((always_inline)) {
          to = pack(of);
        });
    each(law.sine, from.sine);
    each(law.limit, from.limit);
    law.resolution = pack(from.resolution);
    each(law.reached, from.reached);
    law.filter = pack(from.filter);
    return law;
  }
};

template <class P>
[[gnu::flatten]] void control_lanes(LaneControl& control) {
  for (int first = 0; first < group; first += P::size) {
    const LoadLanes<P> from{first};
    const model::SampledLaw<P> law = from.load(control.law);
    model::SampledMemory<P> memory;
    from.each(memory.position, control.memory.position);
    from.each(memory.velocity, control.memory.velocity);
    from.each(memory.integral, control.memory.integral);
    P seen[2], servo[4], command[2];
    from.each(seen, control.seen);
    from.each(servo, control.servo);
    std::array<model::Jet<P>, 2> reference;
    for (std::size_t i = 0; i < 2; ++i) {
      const Lanes* const at = control.reference[i];
      reference[i] = {from.pack(at[0]), from.pack(at[1]), from.pack(at[2])};
    }
    model::take_sample(law, memory, seen, from.pack(control.elapsed),
                       simd::exceeds(from.pack(control.is_first), P(0.5)), servo, reference,
                       command);
    const auto sees = simd::exceeds(from.pack(control.sees), P(0.5));
    const auto keep = [&](Lanes(&to)[2], const P(&values)[2]) __attribute__((always_inline)) {
      for (int i = 0; i < 2; ++i) {
        simd::choose(sees, values[i], from.pack(to[i])).store(to[i].of + first);
      }
    };
    keep(control.memory.position, memory.position);
    keep(control.memory.velocity, memory.velocity);
    keep(control.memory.integral, memory.integral);
    keep(control.command, command);
  }
}

}  // namespace bbsim::solve::sampled
