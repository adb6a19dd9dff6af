// Runs the cases of a sweep, over threads, and delivers them in their order.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>

#include "study/sweep/task.hpp"

namespace bbsim::study {

// How cases are computed, chosen for the sweep as a whole.
enum class Engine {
  superposition,  // one prescribed motion: sums of a few solutions
  lanes,          // loops of one kind in step, a case a SIMD lane
  single,         // each case as by `bbsim run`
};

[[nodiscard]] std::string_view engine_name(Engine engine);
[[nodiscard]] Engine choose_engine(const SweepTask& task);

// Cases that are computed together, and begin at a multiple of this number.
[[nodiscard]] std::size_t group_size(Engine engine);

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
// multiple of the group's size.
[[nodiscard]] bool run_sweep(const SweepTask& task, Engine engine, CaseRange range,
                             std::size_t threads, const std::atomic<bool>& stop,
                             const std::function<void(CaseResults&)>& prepare,
                             const std::function<void(const CaseResults&)>& deliver);

}  // namespace bbsim::study
