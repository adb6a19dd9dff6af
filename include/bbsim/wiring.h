/* SPDX-FileCopyrightText: 2026 the bbsim authors
 * SPDX-License-Identifier: BSD-3-Clause */

/* The wiring of a sketch's board, read from controller.library.wiring (docs/reference/wiring.md).
 * If a scenario names a wiring, bbsim calls bbsim_controller_create_wired() in place of
 * bbsim_controller_create(); the rest is as in controller.h. `bbsim sketch` makes such libraries.
 *
 * SI units and radians. Pin -1 means no pin. Pointers are valid during the call only. */
#ifndef BBSIM_WIRING_H
#define BBSIM_WIRING_H

#include <bbsim/controller.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Increases when anything below changes. */
#define BBSIM_WIRING_VERSION 6u

/* Linear map through two points: position[i] gives counts[i]. It also extrapolates. */
typedef struct bbsim_count_map {
  double counts[2];
  double position[2]; /* m */
} bbsim_count_map;

/* angle = scale * (pulse - level) */
typedef struct bbsim_wired_servo {
  int32_t pin;     /* of the board, or -1 */
  int32_t channel; /* of the PCA9685, or -1 */
  double level;    /* s */
  double scale;    /* rad per second of pulse; negative if the direction is -1 */
} bbsim_wired_servo;

/* A stepper motor behind a driver with inputs for step and direction. Its shaft is at
 * start + angle * (pulses forward - pulses back). */
typedef struct bbsim_wired_stepper {
  int32_t step, dir;   /* pins; -1: there is no motor */
  int32_t enable;      /* pin, or -1; the driver ignores pulses while it is HIGH */
  int32_t home;        /* pin of a limit switch, or -1 */
  double angle;        /* of a microstep, rad; negative if the direction is -1 */
  double start;        /* as the board is switched on, rad; NaN: where setup() ends at t = 0 */
  double home_angle;   /* from here on, seen from the start, the switch is closed, rad */
  uint32_t home_level; /* of the pin while the switch is closed: 0 or 1 */
} bbsim_wired_stepper;

enum bbsim_screen_kind {
  bbsim_no_screen = 0,
  bbsim_four_wires = 1, /* pins: x plus, x minus, y plus, y minus */
  bbsim_five_wires = 2, /* pins: upper left, upper right, lower left, lower right, sense */
  bbsim_voltages = 3,   /* pins: x, y */
  bbsim_stmpe610 = 4    /* a touch controller; counts of 12 bits */
};

typedef struct bbsim_wired_screen {
  uint32_t kind;
  int32_t pins[5];
  bbsim_count_map x, y;
  double untouched;     /* counts of a floating pin */
  double resistance[2]; /* of the x plate and the y plate, ohm */
  double contact;       /* resistance of the touch, ohm */
  double interval;      /* time between points of the chip, s */
} bbsim_wired_screen;

typedef struct bbsim_wired_camera {
  int32_t port;      /* 0: Serial, 1 to 3: Serial1 to Serial3, 4: SerialUSB; -1: no camera */
  uint32_t decimals; /* of x and y in the text */
  double period;     /* time between frames, s */
  double delay;      /* time from a frame to its first byte, s */
  bbsim_count_map x, y;
  const char* frame; /* text of a frame; {x} and {y} stand for the numbers */
  const char* lost;  /* text while the ball is not seen; empty: none */
} bbsim_wired_camera;

/* A distance sensor that measures along an axis. */
typedef struct bbsim_wired_distance {
  int32_t trigger, echo; /* pins of an ultrasonic one, or -1 */
  uint32_t chip;         /* 1: a VL53L0X on I2C */
  double offset;         /* the distance is this plus the ball's position, m */
  double noise;          /* standard deviation of the distance, m */
  double blind;          /* nearer balls read as this distance, m */
  double range;          /* balls beyond give no echo, m */
} bbsim_wired_distance;

/* A constant input: counts of an analog pin, or 0 or 1 of a digital pin. */
typedef struct bbsim_wired_input {
  int32_t pin;
  double value;
} bbsim_wired_input;

/* Duration of calls, s. */
typedef struct bbsim_call_costs {
  double clock;        /* millis, micros */
  double digital;      /* pinMode, digitalRead, digitalWrite, analogWrite */
  double analog;       /* analogRead */
  double servo;        /* each call of Servo */
  double serial;       /* each byte on Serial, in addition to the line's own time */
  double wire;         /* each transaction on I2C, in addition to its bits */
  double spi;          /* each byte on SPI, in addition to its bits */
  double eeprom_write; /* each byte written */
  double loop;         /* each loop(), for its computation */
} bbsim_call_costs;

typedef struct bbsim_wiring {
  uint32_t version;            /* BBSIM_WIRING_VERSION */
  uint32_t setup_before;       /* 1: setup() has returned at t = 0; 0: the board starts at t = 0 */
  bbsim_wired_servo servos[3]; /* phi, theta and an unused one; or three legs */
  bbsim_wired_stepper steppers[3]; /* likewise, in place of servos */
  double oscillator;           /* frequency of the PCA9685, Hz */
  uint32_t ignored_channels;   /* bit n: channel n of the PCA9685 has a servo outside the scene */
  bbsim_wired_screen screen;
  bbsim_wired_camera camera;
  bbsim_wired_distance distances[2]; /* x, y */
  uint64_t seed;                     /* of their noise: the scenario's sensor.seed */
  size_t input_count;
  const bbsim_wired_input* inputs;
  size_t ignored_count;
  const int32_t* ignored; /* pins of what is outside the scene */
  size_t eeprom_size;     /* bytes */
  const unsigned char* eeprom;
  bbsim_call_costs costs;
  /* Receives each line that the sketch prints, valid during the call. May be null. */
  void (*print)(void* reader, const char* line);
  void* reader;
} bbsim_wiring;

/* Like bbsim_controller_create(), which such a library also defines, but only to refuse. */
BBSIM_CONTROLLER_EXPORT void* bbsim_controller_create_wired(const bbsim_setup* setup,
                                                            const bbsim_wiring* wiring);

/* A step of such a library returns this if the wiring does not fit the sketch. */
enum { BBSIM_WIRING_AT_FAULT = 2 };

/* Whether the sketch has printed the number of this column of the setup. */
BBSIM_CONTROLLER_EXPORT int bbsim_sketch_printed(const void* controller, size_t column);

/* The n-th pin that the sketch drives although the wiring connects nothing to it; -1: there are no
 * more. */
BBSIM_CONTROLLER_EXPORT int bbsim_sketch_unheard(const void* controller, size_t n);

/* A program at the other end of Serial (controller.library.serial). This opens the line, also with
 * no bytes. They follow each other at the speed that the sketch has passed to begin(), from `delay`
 * (s) after the next step's sample on. */
BBSIM_CONTROLLER_EXPORT void bbsim_sketch_send(void* controller, const char* bytes, size_t size,
                                               double delay);

/* Takes bytes that the sketch has printed on Serial and that have arrived by the next sample, at
 * most `room`. Returns their number. */
BBSIM_CONTROLLER_EXPORT size_t bbsim_sketch_receive(void* controller, char* bytes, size_t room);

/* The state of that line. */
typedef struct bbsim_line {
  double baud;    /* that the sketch has passed to begin(); 0: none */
  size_t unbegun; /* bytes that were lost before begin() */
  size_t overrun; /* bytes that were lost because the sketch did not read earlier ones */
  size_t read;    /* bytes that the sketch has read */
} bbsim_line;

BBSIM_CONTROLLER_EXPORT bbsim_line bbsim_sketch_line(const void* controller);

#ifdef __cplusplus
}
#endif

#endif
