// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The viewer's own controller in a live page: a script with step(sample), as in
// docs/reference/controllers.md, and three to begin from.
bbsim.makeControllerCard = (use) => {
  const {element} = bbsim.text;
  const begins = {
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
  const script = element('textarea', {class: 'editor', spellcheck: 'false', rows: '14', 'aria-label': 'The controller, JavaScript'});
  const choice = element('select', {'aria-label': 'Begin from', onchange: () => { script.value = begins[choice.value]; }},
                         ...Object.keys(begins).map((name) => element('option', {value: name}, name)));
  script.value = begins.PD;
  const off = element('button', {type: 'button', disabled: true, onclick: () => {
    off.disabled = true;
    use('');
  }}, 'Use the scenario\'s law');
  const on = element('button', {type: 'button', onclick: () => {
    off.disabled = false;
    use(script.value);
  }}, 'Use this controller');
  return element('details', {class: 'card'}, element('summary', {}, element('h3', {}, 'Your controller')),
                 element('p', {class: 'buttons'}, choice, on, off), script,
                 element('p', {class: 'fine'}, 'step(sample) gets {sample, t, ball, reference, reference_rate, reference_acceleration, servo, servo_rate, period} in SI units, once a sampling period, and returns [phi, theta]. It runs in this page alone, without network.'));
};
