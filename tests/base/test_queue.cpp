// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// First in, first out.
#include <deque>

#include "base/queue.hpp"
#include "catch.hpp"

namespace bbsim_test::test_queue {

using namespace bbsim;

TEST_CASE("a queue returns its elements in order, however full it was") {
  Queue<int> queue;
  std::deque<int> same;
  unsigned state = 1;
  for (int i = 0; i < 10000; ++i) {
    state = state * 1664525U + 1013904223U;
    // Phases of mostly pushes alternate with phases of mostly pops.
    const bool push = same.empty() || ((state >> 16U) % 8 < (i / 100 % 2 == 0 ? 6U : 2U));
    if (push) {
      queue.push() = i;
      same.push_back(i);
    } else {
      REQUIRE(queue.front() == same.front());
      REQUIRE(queue.pop() == same.front());
      same.pop_front();
    }
    REQUIRE(queue.empty() == same.empty());
  }
}

}  // namespace bbsim_test::test_queue
