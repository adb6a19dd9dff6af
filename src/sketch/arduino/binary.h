// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Binary constants from B0 to B11111111, with up to eight digits.
#pragma once

#define BBSIM_BITS_1(name) name##0, name##1
#define BBSIM_BITS_2(name) BBSIM_BITS_1(name##0), BBSIM_BITS_1(name##1)
#define BBSIM_BITS_3(name) BBSIM_BITS_2(name##0), BBSIM_BITS_2(name##1)
#define BBSIM_BITS_4(name) BBSIM_BITS_3(name##0), BBSIM_BITS_3(name##1)
#define BBSIM_BITS_5(name) BBSIM_BITS_4(name##0), BBSIM_BITS_4(name##1)
#define BBSIM_BITS_6(name) BBSIM_BITS_5(name##0), BBSIM_BITS_5(name##1)
#define BBSIM_BITS_7(name) BBSIM_BITS_6(name##0), BBSIM_BITS_6(name##1)
#define BBSIM_BITS_8(name) BBSIM_BITS_7(name##0), BBSIM_BITS_7(name##1)

// Names in the order of their values, from 0 on.
enum { BBSIM_BITS_1(B) };
enum { BBSIM_BITS_2(B) };
enum { BBSIM_BITS_3(B) };
enum { BBSIM_BITS_4(B) };
enum { BBSIM_BITS_5(B) };
enum { BBSIM_BITS_6(B) };
enum { BBSIM_BITS_7(B) };
enum { BBSIM_BITS_8(B) };
