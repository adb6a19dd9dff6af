// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
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
    y = (im) => height / 2 - im / (1.25 * high) * (height / 2 - 14);
    root.append(svg('rect', {x: 0, y: 0, width: x(0), height, class: 'stable'}));
    for (const im of [high, -high]) {
      root.append(svg('path', {d: `M${x(0) - 3} ${y(im)}h6`, class: 'line'}),
                  svg('text', {x: x(0) + (x(0) > 0.75 * width ? -6 : 6), y: y(im) + 4, 'text-anchor': x(0) > 0.75 * width ? 'end' : 'start'},
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
    if (sampled) {
      words += `: size ${number(Math.hypot(re, im))}`;
    } else {
      const size = Math.hypot(re, im);
      words += ` 1/s: ${number(size)} rad/s${size > 0 ? `, damping ${number(-re / size, 3)}` : ''}`;
    }
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
