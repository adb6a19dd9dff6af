// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// damage_state FILE COPY NUMBER: copies a saved state of a run (bbsim run --save-state), damaged in
// one of many ways. NUMBER determines the damage; the checksum is corrected.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static uint64_t seed;

// xorshift64*
static uint64_t drawn(void) {
  seed ^= seed >> 12;
  seed ^= seed << 25;
  seed ^= seed >> 27;
  return seed * 0x2545F4914F6CDD1DULL;
}

static size_t below(size_t most) { return most == 0 ? 0 : (size_t)(drawn() >> 11) % most; }

static uint64_t bits_of(double value) {
  uint64_t bits = 0;
  memcpy(&bits, &value, sizeof bits);
  return bits;
}

int main(int argc, char **argv) {
  if (argc != 4) return 2;
  FILE *file = fopen(argv[1], "rb");
  if (file == NULL) return 2;
  static unsigned char bytes[1 << 22];
  size_t size = fread(bytes, 1, sizeof bytes - 65536, file);
  fclose(file);
  if (size < 100) return 2;
  size -= 8;  // without the checksum
  seed = 0x9E3779B97F4A7C15ULL * (strtoull(argv[3], NULL, 10) + 1);
  for (int i = 0; i < 8; ++i) drawn();

  // Three texts with their lengths follow the first line. The last is the scene, in which damage is
  // mostly found immediately.
  size_t first = (size_t)((unsigned char *)memchr(bytes, '\n', size) - bytes) + 1;
  const size_t whole = first;
  for (int i = 0; i < 3; ++i) {
    uint64_t length = 0;
    memcpy(&length, bytes + first, sizeof length);
    if (length > size - first - 8) return 2;
    first += 8 + (size_t)length;
  }
  if (below(16) == 0) first = whole;

  const uint64_t words[] = {0, 1, 2, 3, 7, 8, 15, 16, 17, 63, 255, 4096, 65535, 65536, 1u << 30,
                            0x7fffffff, 0x80000000, 0xffffffff, 1ULL << 32, 1ULL << 40,
                            1ULL << 53, 1ULL << 62, 1ULL << 63, ~0ULL,
                            bits_of(0.1), bits_of(-1), bits_of(1e9), bits_of(-1e9), bits_of(1e18),
                            bits_of(1e300), bits_of(-1e300), bits_of(1e-300), bits_of(5e-324),
                            0x7ff0000000000000ULL, 0xfff0000000000000ULL, 0x7ff8000000000000ULL,
                            0x8000000000000000ULL};
  const size_t kinds = sizeof words / sizeof *words;
  const size_t times = below(4) == 0 ? 1 + below(8) : 1;
  for (size_t i = 0; i < times; ++i) {
    const size_t at = first + below(size - first);
    switch (below(8)) {
      case 0:
        bytes[at] ^= (unsigned char)(1u << below(8));
        break;
      case 1:
        bytes[at] = (unsigned char)drawn();
        break;
      case 2: {  // removes a piece, anywhere or at the end
        const size_t cut = below(4) == 0 ? size - at : 1 + below(16);
        if (cut >= size - first) break;
        if (at + cut < size) memmove(bytes + at, bytes + at + cut, size - at - cut);
        size -= cut < size - at ? cut : size - at;
        break;
      }
      case 3: {  // inserts a piece
        const size_t more = 1 + below(64);
        memmove(bytes + at + more, bytes + at, size - at);
        for (size_t k = 0; k < more; ++k) bytes[at + k] = (unsigned char)drawn();
        size += more;
        break;
      }
      case 4:  // changes a number slightly
        bytes[at] = (unsigned char)(bytes[at] + (below(2) == 0 ? 1 : 255));
        break;
      default: {  // changes a word, mostly where words are
        const size_t place = below(4) == 0 ? at : at - (at - first) % 8 + below(2);
        if (place + 8 <= size) memcpy(bytes + place, &words[below(kinds)], 8);
      }
    }
  }

  uint64_t sum = 0xcbf29ce484222325ULL;
  for (size_t i = 0; i < size; ++i) sum = (sum ^ bytes[i]) * 0x100000001b3ULL;
  memcpy(bytes + size, &sum, sizeof sum);
  file = fopen(argv[2], "wb");
  if (file == NULL || fwrite(bytes, 1, size + 8, file) != size + 8) return 2;
  return fclose(file) == 0 ? 0 : 2;
}
