// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Constants in program memory. Here, all memory is the same.
#pragma once

#include <stdint.h>
#include <string.h>

#define PROGMEM
#define PGM_P const char*
#define PSTR(text) (text)

template <class Any>
constexpr Any bbsim_read(const void* from) {
  return *static_cast<const Any*>(from);
}
#define pgm_read_byte(from) bbsim_read<uint8_t>(from)
#define pgm_read_word(from) bbsim_read<uint16_t>(from)
#define pgm_read_dword(from) bbsim_read<uint32_t>(from)
#define pgm_read_float(from) bbsim_read<float>(from)
#define pgm_read_ptr(from) bbsim_read<const void*>(from)
#define pgm_read_byte_near(from) pgm_read_byte(from)
#define pgm_read_word_near(from) pgm_read_word(from)
#define pgm_read_dword_near(from) pgm_read_dword(from)
#define pgm_read_float_near(from) pgm_read_float(from)

#define memcpy_P memcpy
#define strcpy_P strcpy
#define strncpy_P strncpy
#define strcmp_P strcmp
#define strncmp_P strncmp
#define strlen_P strlen
#define strcat_P strcat
#define sprintf_P sprintf
#define snprintf_P snprintf
