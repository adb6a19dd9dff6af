// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Shared by the headers here: the board's clock, and errors for functions that the board lacks.
#pragma once

#include <stddef.h>

namespace bbsim_board {

// Advances the board's clock by the duration of a call, ns. The call may return in a later sample.
void spend(long long time);
long long now();  // ns

// Ends the run with this reason. Does not return, except to the constructor of a global variable.
__attribute__((format(printf, 1, 2))) void fail(const char* format, ...);

// Ends the run if these two pins are electrodes of different plates of the wiring's screen.
void require_plate(int plus, int minus);

template <class...>
inline constexpr bool never = false;

}  // namespace bbsim_board

// Declares a function that the board lacks. A call does not compile, and the error gives the hint.
#define BBSIM_LACKS(name, hint)                                      \
  template <class... Arguments>                                      \
  int name(Arguments&&...) {                                         \
    static_assert(bbsim_board::never<Arguments...>, "bbsim: " hint); \
    return 0;                                                        \
  }
