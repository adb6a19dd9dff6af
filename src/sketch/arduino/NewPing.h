// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// NewPing.h: ultrasonic sensors, with distances as round trips of sound. Pings wait for their echo.
#pragma once

#include "Arduino.h"

#define NO_ECHO 0
#define US_ROUNDTRIP_CM 57
#define US_ROUNDTRIP_IN 146

class NewPing {
 public:
  NewPing(int trigger, int echo, unsigned most_cm = 500)
      : trigger_(trigger), echo_(echo), most_cm_(most_cm) {}
  // Microseconds; 0 if there is no echo within the greatest distance.
  unsigned ping(unsigned most_cm = 0);
  unsigned long ping_cm(unsigned most_cm = 0) { return convert_cm(ping(most_cm)); }
  unsigned long ping_in(unsigned most_cm = 0) { return convert_in(ping(most_cm)); }
  unsigned long ping_median(uint8_t count = 5, unsigned most_cm = 0);
  static unsigned convert_cm(unsigned us) { return (us + US_ROUNDTRIP_CM / 2) / US_ROUNDTRIP_CM; }
  static unsigned convert_in(unsigned us) { return (us + US_ROUNDTRIP_IN / 2) / US_ROUNDTRIP_IN; }

 private:
  int trigger_, echo_;
  unsigned most_cm_;
};
