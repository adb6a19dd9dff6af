// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The rate and the damping of a pole's mode: of s, or of z = exp(s period).
bbsim.modeOf = ([re, im], period) => {
  const [decay, turn] = period === null ? [re, im] : [Math.log(Math.hypot(re, im)) / period, Math.atan2(im, re) / period];
  const rate = Math.hypot(decay, turn);
  return {rate, damping: rate > 0 ? -decay / rate : 0, time: -1 / decay};
};

// The modes in a table, slowest first; a pair of poles is one mode, and so are the same ones of both
// axes.
bbsim.polesTable = ({period, values}) => {
  const {element, number} = bbsim.text;
  const modes = values.filter(([re, im]) => Number.isFinite(re) && im >= 0 && (period === null || Math.hypot(re, im) > 1e-9))
      .map((pole) => ({pole, ...bbsim.modeOf(pole, period)})).sort((a, b) => a.rate - b.rate)
      .filter(({rate, damping}, i, all) => i === 0 || Math.abs(rate - all[i - 1].rate) > 1e-6 * rate || Math.abs(damping - all[i - 1].damping) > 1e-6);
  const shown = modes.slice(0, 8), seconds = (time) => (Math.abs(time) < 1 ? `${number(1e3 * time, 3)} ms` : Number.isFinite(time) ? `${number(time, 3)} s` : '∞');
  return element('table', {class: 'measures modes'},
      element('thead', {}, element('tr', {}, ...['mode, rad/s', 'damping', 'time constant'].map((words) => element('th', {scope: 'col'}, words)))),
      element('tbody', {}, ...shown.map(({rate, damping, time}) => element('tr', {}, element('td', {}, number(rate, 3)), element('td', {}, number(damping, 3)),
                                                                                 element('td', {}, time < 0 ? `grows in ${seconds(-time)}` : seconds(time))))),
      modes.length > shown.length ? element('caption', {}, `and ${modes.length - shown.length} faster ones`) : null);
};

// The poles of a run, if it has any: their picture, what it shows, and their table.
bbsim.showPoles = (poles) => {
  if (!poles || poles.values.length === 0) return [];
  const {period} = poles, {element, number} = bbsim.text;
  const words = period === null ? 'Poles: stable left of the line, 1/s' : `Poles of a period of ${number(period * 1e3)} ms: stable within the circle`;
  return [bbsim.drawPoles(poles), element('figcaption', {}, words), bbsim.polesTable(poles)];
};

// A small picture of the loop's poles: the s plane or, for a sampled loop, the unit circle.
bbsim.drawPoles = ({period, values}) => {
  const {svg, number} = bbsim.text;
  const finite = values.filter(([re, im]) => Number.isFinite(re) && Number.isFinite(im));
  const sampled = period !== null;
  const width = 300, height = sampled ? 300 : 260;
  const root = svg('svg', {viewBox: `0 0 ${width} ${height}`, class: 'poles', role: 'img'});
  const isStable = ([re, im]) => (sampled ? Math.hypot(re, im) < 1 : re < 0);
  const unstable = finite.filter((pole) => !isStable(pole)).length;
  root.append(svg('title', {}, `${finite.length} poles, ${unstable === 0 ? 'all of them stable' : `${unstable} of them unstable`}`));

  const far = Math.max(sampled ? 1.12 : 0, ...finite.map(([re, im]) => (sampled ? Math.max(Math.abs(re), Math.abs(im)) : 0)));
  let x, y;
  if (sampled) {
    const scale = (width / 2 - 16) / (far * 1.02);
    x = (re) => width / 2 + re * scale;
    y = (im) => height / 2 - im * scale;
    root.append(svg('circle', {cx: x(0), cy: y(0), r: scale, class: 'stable'}));
  } else {
    const left = Math.min(0, ...finite.map(([re]) => re)), right = Math.max(0, ...finite.map(([re]) => re));
    const span = Math.max(right - left, 1e-9), high = Math.max(...finite.map(([, im]) => Math.abs(im)), 0.25 * span, 1e-9);
    const from = left - 0.12 * span, to = right + Math.max(0.12 * span, 0.1 * (right - left));
    x = (re) => 12 + (re - from) / (to - from) * (width - 24);
    y = (im) => height / 2 - im / (1.25 * high) * (height / 2 - 18);
    root.append(svg('rect', {x: 0, y: 0, width: x(0), height, class: 'stable'}));
    // The numbers stand farther out than the poles, whose crosses would cover them.
    for (const im of [high, -high]) {
      root.append(svg('path', {d: `M${x(0) - 3} ${y(im)}h6`, class: 'line'}),
                  svg('text', {x: x(0) + (x(0) > 0.75 * width ? -6 : 6), y: y(im) + (im > 0 ? -7 : 16), 'text-anchor': x(0) > 0.75 * width ? 'end' : 'start'},
                      `${number(im, 3)} i`));
    }
    root.append(svg('path', {d: `M${x(left)} ${y(0) - 3}v6`, class: 'line'}),
                svg('text', {x: x(left), y: y(0) + 16, 'text-anchor': 'middle'}, number(left, 3)));
  }
  root.append(svg('path', {d: `M0 ${y(0)}H${width}M${x(0)} 0V${height}`, class: 'line'}));
  for (const pole of finite) {
    const [re, im] = pole;
    const sign = im === 0 ? '' : im > 0 ? ` + ${number(im)} i` : ` − ${number(-im)} i`;
    let words = `${number(re)}${sign}`;
    const {rate, damping, time} = bbsim.modeOf(pole, period);
    words += sampled ? `: size ${number(Math.hypot(re, im))}, ` : ' 1/s: ';
    words += `${number(rate)} rad/s, damping ${number(damping, 3)}, time constant ${number(time, 3)} s`;
    words += isStable(pole) ? '' : ', unstable';
    const s = isStable(pole) ? 4.5 : 6;
    const mark = svg('path', {d: `M${x(re) - s} ${y(im) - s}l${2 * s} ${2 * s}m0 ${-2 * s}l${-2 * s} ${2 * s}`,
                              class: isStable(pole) ? 'pole' : 'pole unstable'});
    const group = svg('g', {}, mark);
    if (!isStable(pole)) group.append(svg('circle', {cx: x(re), cy: y(im), r: 1.6 * s, class: 'unstable'}));
    group.append(svg('circle', {cx: x(re), cy: y(im), r: 9, class: 'touch'}, svg('title', {}, words)));
    root.append(group);
  }
  return root;
};
