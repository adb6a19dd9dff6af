// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// What the headers here share: the board's clock, and the words for what it lacks.
#pragma once

#include <stddef.h>

namespace bbsim_board {

// The call took that long, in ns: the board's clock moves, and other calls see what is then.
void spend(long long time);
long long now();  // ns

// The run ends with that reason.
__attribute__((format(printf, 1, 2))) void fail(const char* format, ...);

template <class...>
inline constexpr bool never = false;

}  // namespace bbsim_board

// A function that is not there: who calls it gets the hint from the compiler.
#define BBSIM_LACKS(name, hint)                                      \
  template <class... Arguments>                                      \
  int name(Arguments&&...) {                                         \
    static_assert(bbsim_board::never<Arguments...>, "bbsim: " hint); \
    return 0;                                                        \
  }
