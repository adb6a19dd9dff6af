// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "sweep/sweep.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "sweep/runners.hpp"

namespace bbsim::sweep {
namespace {

// Target time of a thread for a block, s. A killed sweep loses about one block per thread; short
// blocks would make threads wait for each other.
constexpr double least_seconds = 0.02, most_seconds = 0.1;
constexpr std::size_t most_in_block = 4096;
constexpr std::size_t most_series_numbers = std::size_t{1} << 18U;  // in a block
// Most blocks per thread that wait for delivery while a slow case delays an earlier block.
constexpr std::size_t most_ahead = 8;

std::size_t block_limit(const SweepTask& task, std::size_t group) {
  const std::size_t numbers = std::max<std::size_t>(1, task.series.size() * task.series_rows);
  return std::max(group, std::min(most_in_block, most_series_numbers / numbers) / group * group);
}

// Collects blocks of cases from the threads and delivers them in order.
class Queue {
 public:
  Queue(CaseRange range, const std::vector<std::size_t>* ends, std::size_t ahead,
        const std::atomic<bool>& stop, const std::function<void(const CaseResults&)>& deliver)
      : range_(range),
        ends_(ends),
        ahead_(ahead),
        next_(range.first),
        delivered_(range.first),
        stop_(stop),
        deliver_(deliver) {}

  // Returns the next cases to compute, at most this many unless the blocks are given; an empty
  // range at the end.
  CaseRange take(std::size_t cases) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock,
                  [this] { return ended() || next_ >= range_.last || waiting_.size() < ahead_; });
    if (ended() || next_ >= range_.last) return {};
    const std::size_t first = next_;
    next_ = ends_ != nullptr ? *std::ranges::upper_bound(*ends_, first)
                             : std::min(range_.last, first + cases);
    return {first, next_};
  }

  // Adds a block and delivers the blocks that are now next in order. Leaves `results` empty.
  void put(CaseResults& results) {
    std::unique_lock lock(mutex_);
    waiting_.emplace(results.first, std::move(results));
    results = {};
    if (delivering_) return;
    delivering_ = true;
    while (!waiting_.empty() && waiting_.begin()->first == delivered_ && !failure_) {
      auto ready = waiting_.extract(waiting_.begin());
      lock.unlock();
      std::exception_ptr failure;
      try {
        deliver_(ready.mapped());
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      delivered_ += ready.mapped().count;
      if (failure) failure_ = failure;
      changed_.notify_all();
    }
    delivering_ = false;
  }

  void fail(std::exception_ptr failure) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(failure);
    changed_.notify_all();
  }

  // Wakes threads that wait for the delivery of blocks that will not come.
  void give_up() {
    const std::lock_guard lock(mutex_);
    given_up_ = true;
    changed_.notify_all();
  }

  // Whether all was delivered; call it once all threads have ended.
  [[nodiscard]] bool finished() const {
    if (failure_) std::rethrow_exception(failure_);
    return delivered_ >= range_.last;
  }

 private:
  [[nodiscard]] bool ended() const {
    return failure_ || given_up_ || stop_.load(std::memory_order_relaxed);
  }

  const CaseRange range_;
  const std::vector<std::size_t>* const ends_;
  const std::size_t ahead_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_, delivered_;
  std::map<std::size_t, CaseResults> waiting_;
  bool delivering_ = false, given_up_ = false;
  std::exception_ptr failure_;
  const std::atomic<bool>& stop_;
  const std::function<void(const CaseResults&)>& deliver_;
};

void work(const Engine& engine, Queue& queue, const std::atomic<bool>& stop,
          const std::function<void(CaseResults&)>& prepare) {
  using Clock = std::chrono::steady_clock;
  try {
    const std::unique_ptr<CaseRunner> runner = engine.runner();
    CaseResults results;
    std::size_t size = engine.group;
    for (;;) {
      const CaseRange block = queue.take(size);
      if (block.first == block.last) return;
      const Clock::time_point start = Clock::now();
      const std::size_t count = block.last - block.first;
      const std::size_t done = runner->run(block.first, count, results, stop);
      if (done < count) results.cut(done, engine.task);
      if (done > 0) {
        prepare(results);
        queue.put(results);
      }
      if (done < count) {
        queue.give_up();
        return;
      }
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      if (seconds < least_seconds)
        size = std::min(2 * size, block_limit(engine.task, engine.group));
      if (seconds > most_seconds)
        size = std::max(engine.group, size / 2 / engine.group * engine.group);
    }
  } catch (...) {
    queue.fail(std::current_exception());
  }
}

// Engine for the measures of the motion, with measures of the loop beside them.
Engine engine_with_loop(const SweepTask& task) {
  if (is_of_loop_only(task)) {
    return {"linear analysis", task, 1, [&task] { return loop_runner(task, nullptr); }};
  }
  const auto motion = std::make_shared<const SweepTask>(task_of_motion(task));
  const auto inner = std::make_shared<const Engine>(choose_engine(*motion));
  return {inner->name, task, inner->group,
          [&task, motion, inner] { return loop_runner(task, inner->runner()); }};
}

}  // namespace

Engine choose_engine(const SweepTask& task) {
  const auto is_loop = [](const scenario::Measure& measure) {
    return measure.kind == scenario::Measure::Kind::loop;
  };
  if (std::ranges::any_of(task.measures, is_loop)) return engine_with_loop(task);
  if (can_use_open_lanes(task)) {
    return {"open lanes", task, lane_group(), [&task] { return lane_runner(task); }};
  }
  if (can_use_lanes(task)) {
    return {"lanes", task, lane_group(), [&task] { return lane_runner(task); }};
  }
  if (can_use_rig_lanes(task)) {
    return {"rig lanes", task, rig_group(), [&task] { return rig_lane_runner(task); }};
  }
  return {"single runs", task, 1, [&task] { return single_runner(task); }};
}

CaseRange shard_range(std::size_t cases, std::size_t group, std::size_t shard, std::size_t shards) {
  const std::size_t groups = (cases + group - 1) / group;
  // groups * shard would overflow beyond 1e12 cases on 1e7 shards.
  const auto start = [&](std::size_t k) {
    const std::size_t whole = groups / shards * k + groups % shards * k / shards;
    return std::min(cases, whole * group);
  };
  return {start(shard - 1), start(shard)};
}

bool run_sweep(const Engine& engine, CaseRange range, std::size_t threads,
               const std::atomic<bool>& stop, const std::function<void(CaseResults&)>& prepare,
               const std::function<void(const CaseResults&)>& deliver,
               const std::function<void(std::size_t)>& fewer) {
  const std::size_t groups = (range.last - range.first + engine.group - 1) / engine.group;
  Queue queue(range, engine.ends, most_ahead * threads, stop, deliver);
  const std::size_t wanted = std::max<std::size_t>(1, std::min(threads, groups));
  {
    std::vector<std::jthread> others;
    others.reserve(wanted);
    while (others.size() + 1 < wanted) {
      try {
        others.emplace_back([&] { work(engine, queue, stop, prepare); });
      } catch (const std::system_error&) {  // a limit on processes, or no memory for a stack
        break;
      } catch (const std::bad_alloc&) {
        break;
      }
    }
    if (others.size() + 1 < wanted && fewer) {
      try {
        fewer(others.size() + 1);
      } catch (...) {
        queue.fail(std::current_exception());  // so that the others end
      }
    }
    work(engine, queue, stop, prepare);
  }
  return queue.finished();
}

}  // namespace bbsim::sweep
