// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the cases of a sweep, over threads, and delivers them in their order.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>

#include "sweep/task.hpp"

namespace bbsim::sweep {

// How cases are computed, chosen for the sweep as a whole.
struct Engine {
  std::string name;
  const SweepTask& task;
  // Cases are computed in groups, which begin at multiples of this number.
  std::size_t group = 1;
  // Makes a runner; called once on each thread.
  std::function<std::unique_ptr<CaseRunner>()> runner;
};

// The fastest that serves the task, which outlives it: superposition where start, radius and
// gravity vary under one prescribed motion; SIMD lanes where the motion varies too, and for loops
// at tolerances where they are ahead; and single runs for all else.
[[nodiscard]] Engine choose_engine(const SweepTask& task);

// Cases first ... last - 1.
struct CaseRange {
  std::size_t first = 0, last = 0;
};

// Part `shard` of `shards`, from 1: whole groups, as even as can be.
[[nodiscard]] CaseRange shard_range(std::size_t cases, std::size_t group, std::size_t shard,
                                    std::size_t shards);

// `prepare` sees some cases at a time, on the thread that computed them; then `deliver` gets them
// in their order, whatever the number of threads, and one call at a time. Not many more are held
// than threads compute at once. Ends soon after `stop` becomes true, with all that came before
// delivered; returns whether the range was finished. Throws what the two throw. `range.first` is a
// multiple of the group's size. Where the system has fewer threads, `fewer` is told how many there
// are, once, perhaps while cases are being delivered.
[[nodiscard]] bool run_sweep(const Engine& engine, CaseRange range, std::size_t threads,
                             const std::atomic<bool>& stop,
                             const std::function<void(CaseResults&)>& prepare,
                             const std::function<void(const CaseResults&)>& deliver,
                             const std::function<void(std::size_t)>& fewer = {});

}  // namespace bbsim::sweep
