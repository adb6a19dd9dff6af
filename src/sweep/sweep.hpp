// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Runs the cases of a sweep on several threads and delivers them in order.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "sweep/task.hpp"

namespace bbsim::sweep {

// The way to compute the cases, chosen for the sweep as a whole.
struct Engine {
  std::string name;
  const SweepTask& task;
  // Cases are computed in groups, which begin at multiples of this number.
  std::size_t group = 1;
  // Makes a runner; called once on each thread.
  std::function<std::unique_ptr<CaseRunner>()> runner;
  // The cases after each block, if the blocks are given; null if their size follows their speed.
  const std::vector<std::size_t>* ends = nullptr;
};

// Chooses the first engine that fits (docs/explanation/sweep-engines.md): linear analysis if all
// measures are of the loop, open lanes, lanes, rig lanes, single runs. The task must
// outlive the engine.
[[nodiscard]] Engine choose_engine(const SweepTask& task);

// Cases first ... last - 1.
struct CaseRange {
  std::size_t first = 0, last = 0;
};

// Part `shard` of `shards`, counted from 1: whole groups, as evenly divided as possible.
[[nodiscard]] CaseRange shard_range(std::size_t cases, std::size_t group, std::size_t shard,
                                    std::size_t shards);

// Computes the cases of `range`; range.first must be a multiple of the group size. Calls `prepare`
// with each block of cases on the thread that computed it. Then calls `deliver` with the blocks in
// the order of the cases, one call at a time. About 8 blocks for each thread can wait for delivery.
// If the system grants fewer threads, calls `fewer` once with their number, perhaps during a
// delivery.
//
// Stops soon after `stop` becomes true and delivers all cases before that point. Returns whether
// all cases were delivered. Throws the exceptions of the callbacks.
[[nodiscard]] bool run_sweep(const Engine& engine, CaseRange range, std::size_t threads,
                             const std::atomic<bool>& stop,
                             const std::function<void(CaseResults&)>& prepare,
                             const std::function<void(const CaseResults&)>& deliver,
                             const std::function<void(std::size_t)>& fewer = {});

}  // namespace bbsim::sweep
