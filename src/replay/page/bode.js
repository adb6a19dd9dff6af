// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A small Bode plot of a live page's open loops with their margins, and these in a table. `ask(state)`
// is fulfilled with {loops, arrays}: those of another state, null if they are not known.
bbsim.makeBode = (loops, ask) => {
  const {data} = bbsim;
  const {element} = bbsim.text;
  const root = element('figure', {class: 'live-bode'});
  let margins = {}, wanted = null, asking = Promise.resolve();

  // `floats` makes an array of what the page's data or an answer have in its place.
  function show(its, floats) {
    margins = its ? its.margins : {};
    if (!its) {
      root.replaceChildren();
      return;
    }
    const curves = Object.fromEntries(Object.entries(its.curves).map(([command, {gain, phase}]) => [command, {gain: floats(gain), phase: floats(phase)}]));
    root.replaceChildren(...bbsim.drawBode({...its, frequencies: floats(its.frequencies), curves}), element(
        'figcaption', {}, `The open loop of each command, the other one closed${its.period === null ? '' : ', with all delays'}${its.stable ? '' : '. The closed loop is not stable'}.`));
  }
  show(loops, data.floats);

  async function draw(state) {
    // Runs come first: they may need both processors.
    if (state === wanted) await new Promise((resolve) => setTimeout(resolve, 50));
    if (state !== wanted) return;  // the newest wish wins
    try {
      const {loops: its, arrays} = await ask(state);
      show(its, (place) => arrays[place]);
    } catch {
      show(null);  // the run tells what is wrong
    }
  }
  return {
    root,
    follow(state) {
      wanted = state;
      asking = asking.then(() => draw(state));
    },
    async margins() {
      await asking;
      return margins;
    },
  };
};

// `frequencies` and {phi_command: {gain, phase}} as arrays.
bbsim.drawBode = ({frequencies, curves, margins}) => {
  const {element, svg, number} = bbsim.text;
  const width = 340, left = 36, right = 6, high = 96, gap = 16, top = 6;
  const degrees = (angle) => angle * bbsim.text.degrees, decibels = (gain) => 20 * Math.log10(gain);
  const named = {phi_command: 'φ', theta_command: 'θ'};
  const alike = (a, b) => a.every((value, i) => Math.abs(value - b[i]) <= 1e-6 * Math.abs(value));
  // One curve for both commands if they do not differ.
  let shown = Object.entries(curves).map(([command, {gain, phase}], i) => ({command, label: named[command], look: ['first', 'second'][i], gain, phase}));
  if (shown.length === 2 && alike(shown[0].gain, shown[1].gain) && alike(shown[0].phase, shown[1].phase)) {
    shown = [{...shown[0], label: 'φ, θ'}];
  }

  const low = Math.log10(frequencies[0]), last = Math.log10(frequencies[frequencies.length - 1]);
  const x = (w) => left + (Math.log10(w) - low) / (last - low) * (width - left - right);
  const height = 2 * high + gap + top + 30;
  const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, class: 'poles bode', role: 'img'});
  root.append(svg('title', {}, `Bode plot of the open ${shown.length > 1 ? 'loops' : 'loop'}, ${shown.map(({label}) => label).join(' and ')}`));

  function panel(from, name, steps, critical, valuesOf, marksOf) {
    const all = shown.flatMap((one) => Array.from(valuesOf(one)).filter(Number.isFinite));
    const limit = steps[0] === 20 ? 120 : 1080;
    const least = Math.max(Math.min(critical, ...all), -limit), greatest = Math.min(Math.max(critical, ...all), limit);
    const step = steps.find((one) => (greatest - least) / one <= 5) || steps[steps.length - 1];
    const bottom = step * Math.floor(least / step), above = Math.max(bottom + step, step * Math.ceil(greatest / step));
    const y = (value) => from + (above - Math.min(Math.max(value, bottom), above)) / (above - bottom) * high;
    for (let level = bottom; level <= above; level += step) {
      root.append(svg('path', {d: `M${left} ${y(level)}H${width - right}`, class: level === critical ? 'critical' : 'grid'}),
                  svg('text', {x: left - 4, y: y(level) + 4, 'text-anchor': 'end'}, number(level, 4)));
    }
    root.append(svg('text', {x: left + 4, y: from + high - 5}, name));
    for (const one of shown) {
      const values = valuesOf(one);
      let line = '', pen = 'M';
      for (let i = 0; i < values.length; ++i) {
        if (!Number.isFinite(values[i])) { pen = 'M'; continue; }
        line += `${pen}${x(frequencies[i]).toFixed(1)} ${y(values[i]).toFixed(1)}`;
        pen = 'L';
      }
      root.append(svg('path', {d: line, class: `curve ${one.look}`}));
      for (const [at, value, to, words] of marksOf(one, margins[one.command])) {
        if (!(at > frequencies[0])) continue;
        root.append(svg('path', {d: `M${x(at)} ${y(value)}V${y(to)}`, class: `margin ${one.look}`}, svg('title', {}, `${one.label}: ${words} at ${number(at, 3)} rad/s`)));
      }
    }
  }
  // The phase at a frequency, between two of the curve.
  function phaseAt({phase}, at) {
    const i = Math.max(1, frequencies.findIndex((w) => w >= at));
    return degrees(phase[i - 1] + (phase[i] - phase[i - 1]) * (at - frequencies[i - 1]) / (frequencies[i] - frequencies[i - 1]));
  }
  panel(top, 'gain, dB', [20, 40, 80], 0, (one) => Array.from(one.gain, decibels), (one, its) => [['gain', 'gain_frequency'], ['gain_reduction', 'gain_reduction_frequency']]
      .filter(([name]) => its[name] !== null).map(([name, at]) => [its[at], -decibels(its[name]), 0, `${number(decibels(its[name]), 3)} dB`]));
  panel(top + high + gap, 'phase, °', [90, 180, 360], -180, (one) => Array.from(one.phase, degrees), (one, its) => {
    if (its.phase === null) return [];
    const level = phaseAt(one, its.phase_frequency);
    return [[its.phase_frequency, level, level - degrees(its.phase), `${number(degrees(its.phase), 3)}°`]];
  });
  const floor = top + 2 * high + gap;
  for (let power = Math.ceil(low); power <= last; ++power) {
    root.append(svg('path', {d: `M${x(10 ** power)} ${top}V${floor}`, class: 'grid'}),
                svg('text', {x: x(10 ** power), y: floor + 14, 'text-anchor': 'middle'}, number(10 ** power)));
  }
  root.append(svg('text', {x: width - right, y: floor + 27, 'text-anchor': 'end'}, 'rad/s'));

  const cell = (value, words) => element('td', {}, value === null ? 'any' : words(value));
  const table = element('table', {class: 'measures'},
      element('thead', {}, element('tr', {}, element('th', {}, 'margins'), ...['gain', 'phase', 'delay'].map((name) => element('th', {scope: 'col'}, name)))),
      element('tbody', {}, ...shown.map(({command, label, look}) => {
        const its = margins[command];
        return element('tr', {}, element('th', {scope: 'row', class: look}, label), cell(its.gain, (value) => `${number(decibels(value), 3)} dB`),
                       cell(its.phase, (value) => `${number(degrees(value), 3)}°`), cell(its.delay, (value) => `${number(1e3 * value, 3)} ms`));
      })));
  return [root, table];
};
