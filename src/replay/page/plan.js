// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The balls of a log and of the model at one time, seen from above, with their paths in the window.
// xName, yName: two columns; radius: the ball's, m.
bbsim.makePlan = (container, run, [xName, yName], radius) => {
  const {text} = bbsim;
  const {element, svg} = text;
  const of = (ending) => [run.values(xName + ending), run.values(yName + ending)];
  const measured = of(''), model = of('_modelled');

  // The picture's extent: all positions in the log and the model, with a ball at each.
  const sides = [0, 1].map((axis) => {
    const one = bbsim.data.extent(measured[axis]), other = bbsim.data.extent(model[axis]);
    return [Math.min(one.least, other.least) - 1.2 * radius, Math.max(one.greatest, other.greatest) + 1.2 * radius];
  });
  // Keeps the shorter side from being much shorter than the longer one.
  const spans = sides.map(([from, to]) => to - from), least = 0.4 * Math.max(...spans);
  sides.forEach((side, axis) => {
    const more = Math.max(0, least - spans[axis]) / 2;
    side[0] -= more;
    side[1] += more;
  });
  const left = 44, bottom = 32, top = 22, wide = 460;
  const scale = (wide - left - 8) / (sides[0][1] - sides[0][0]);
  const high = Math.round(scale * (sides[1][1] - sides[1][0])) + bottom + top;
  const px = (x) => left + scale * (x - sides[0][0]), py = (y) => high - bottom - scale * (y - sides[1][0]);
  const at = (value) => value.toFixed(1);

  const root = svg('svg', {viewBox: `0 0 ${wide} ${high}`, class: 'place', role: 'img', 'aria-label': 'The ball of the log and of the model, from above'});
  const shown = text.shownIn('m', Math.max(...sides.flat().map(Math.abs)));
  const lines = ([from, to]) => text.ticks(from * shown.factor, to * shown.factor, (to - from) / (sides[0][1] - sides[0][0]) * 9).map((value) => value / shown.factor);
  for (const x of lines(sides[0])) {
    root.append(svg('path', {class: 'line', d: `M${at(px(x))} ${top}V${high - bottom}`}),
                svg('text', {x: at(px(x)), y: high - bottom + 14, 'text-anchor': 'middle'}, text.number(x * shown.factor)));
  }
  for (const y of lines(sides[1])) {
    root.append(svg('path', {class: 'line', d: `M${left} ${at(py(y))}H${wide - 8}`}),
                svg('text', {x: left - 5, y: at(py(y) + 4), 'text-anchor': 'end'}, text.number(y * shown.factor)));
  }
  root.append(svg('text', {x: wide - 8, y: high - 3, 'text-anchor': 'end'}, `x (${shown.unit})`),
              svg('text', {x: 2, y: 11}, `y (${shown.unit})`));

  const ways = {measured: svg('path', {class: 'way measured'}), model: svg('path', {class: 'way model'})};
  const size = Math.max(5, scale * radius);
  const ball = (name, center) => svg('g', {'data-ball': name}, svg('circle', {r: at(size), class: `ball ${name}`}), svg('path', {class: `center ${name}`, d: center}));
  const cross = 'M-5 0H5M0 -5V5', saltire = 'M-4 -4L4 4M-4 4L4 -4';
  const balls = {measured: ball('measured', cross), model: ball('model', saltire)};
  root.append(ways.measured, ways.model, balls.measured, balls.model);

  const sample = (name, center) => svg('svg', {viewBox: '-12 -12 24 24', 'aria-hidden': 'true'}, svg('circle', {r: 9, class: `ball ${name}`}), svg('path', {class: `center ${name}`, d: center}));
  const apart = element('output', {}), where = element('p', {});
  container.replaceChildren(root, element('figcaption', {},
      element('ul', {class: 'legend'}, element('li', {}, sample('measured', cross), 'log'), element('li', {}, sample('model', saltire), 'model'), element('li', {}, apart)), where));

  function put(name, [xs, ys], row) {
    const has = Number.isFinite(xs[row]) && Number.isFinite(ys[row]);
    balls[name].setAttribute('visibility', has ? 'visible' : 'hidden');
    if (has) balls[name].setAttribute('transform', `translate(${at(px(xs[row]))} ${at(py(ys[row]))})`);
    return has;
  }
  function wayOf([xs, ys], {first, last}, dots) {
    let words = '', pen = false;
    for (let row = first; row <= last; ++row) {
      const has = Number.isFinite(xs[row]) && Number.isFinite(ys[row]);
      if (has) words += `${pen && !dots ? 'L' : 'M'}${at(px(xs[row]))} ${at(py(ys[row]))}${dots ? 'h0' : ''}`;
      pen = has;
    }
    return words;
  }

  let drawn = null, ofWindow = '';
  return {
    // At the row nearest to t.
    show(t, timeText) {
      const row = run.nearest(t), window = run.windowAt(row);
      if (drawn !== window) {
        drawn = window;
        ways.measured.setAttribute('d', wayOf(measured, window, true));
        ways.model.setAttribute('d', wayOf(model, window, false));
        ofWindow = `window ${run.windows.indexOf(window) + 1} of ${run.windows.length}, ` +
            `${text.number(run.t[window.first], 5)} to ${text.number(run.t[window.last], 5)} s${window.held ? ', held out of the fit' : ''}`;
      }
      where.textContent = `t = ${timeText} s, ${ofWindow}`;
      const both = [put('measured', measured, row), put('model', model, row)].every(Boolean);
      const far = Math.hypot(measured[0][row] - model[0][row], measured[1][row] - model[1][row]);
      const {factor, unit} = text.shownIn('m', shown.factor === 1 ? 1 : 0.1);
      apart.textContent = both ? `${text.steady(far * factor, 10)} ${unit} apart` : 'the log has no position here';
    },
  };
};
