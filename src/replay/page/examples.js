// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Controllers to begin from in a live page. cmake/inline_page.cmake keeps their indentation.
bbsim.examples = {
  'PD': `// Positive phi drives the ball towards +x, positive theta towards -y (rad).
const kp = 0.7, kv = 0.6;  // rad/m, rad s/m
let last = null;

function reset() { last = null; }

function step({ball, reference, reference_rate, period}) {
  if (!ball) return [0, 0];  // the sensor missed it
  const velocity = ball.map((x, i) => (last ? (x - last[i]) / period : 0));
  last = ball;
  const push = ball.map((x, i) => kp * (reference[i] - x) + kv * (reference_rate[i] - velocity[i]));
  return [push[0], -push[1]];
}
`,
  'PID with a filter': `// The derivative of the measured position passes a low-pass filter.
const kp = 0.7, ki = 0.35, kd = 0.6, filter = 0.04;  // rad/m, rad/(m s), rad s/m, s
let last, velocity, sum;

function reset() { last = null; velocity = [0, 0]; sum = [0, 0]; }

function step({ball, reference, period}) {
  if (!ball) return [0, 0];
  const push = ball.map((x, i) => {
    if (last) velocity[i] += period / (filter + period) * ((x - last[i]) / period - velocity[i]);
    sum[i] += period * (reference[i] - x);
    return kp * (reference[i] - x) + ki * sum[i] - kd * velocity[i];
  });
  last = ball;
  return [push[0], -push[1]];
}
`,
  'State feedback': `// Position, velocity and the servo's angle; the velocity comes from an observer.
const k = [0.9, 0.7, 0.1], gain = [0.6, 6], g = 7;  // g: 5/7 of gravity, m/s^2
let state = null;

function reset() { state = null; }

function step({ball, reference, servo, period}) {
  const tilt = [servo[0], -servo[1]];
  if (!state) state = (ball || [0, 0]).map((x) => ({x, v: 0}));
  const push = state.map((one, i) => {
    one.x += period * one.v;
    one.v += period * g * tilt[i];
    if (ball) {
      const error = ball[i] - one.x;
      one.x += gain[0] * error;
      one.v += gain[1] * error;
    }
    return k[0] * (reference[i] - one.x) - k[1] * one.v - k[2] * tilt[i];
  });
  return [push[0], -push[1]];
}
`,
};
