// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A sweep as a map of a measure over two keys, as lines over one, or as a histogram. A case shows
// the command that runs it again. A live page gives columns as arrays and fills them (update());
// cases without a status yet are blank, and `chosen(i)` hears of a choice.
bbsim.makeSweep = (json, container, chosen = () => {}) => {
  const {text, palette, data, gathered} = bbsim;
  const {element, svg, number} = text;
  const swept = bbsim.makeSwept(json), {keys, measures, cases, leads, listed, stack, axes, isDone, isFine, statusOf, labelOf, middleOf, valueText, shortText} = swept;

  // Viridis, which grows lighter evenly, so that it can be read in gray too.
  const stops = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121],
                 [110, 206, 88], [181, 222, 43], [253, 231, 37]];
  function colourOf(part) {
    const at = Math.min(Math.max(part, 0), 1) * (stops.length - 1), low = Math.min(Math.floor(at), stops.length - 2);
    return `rgb(${stops[low].map((c, i) => Math.round(c + (at - low) * (stops[low + 1][i] - c))).join(',')})`;
  }

  // The view. The first measure shown is one of tracking, if the sweep has one.
  const telling = ['rms_tracking_error', 'max_tracking_error', 'max_distance'];
  const firstMeasure = Math.max(0, measures.findIndex((m) => m.name === telling.find((name) => measures.some((other) => other.name === name))));
  // x and y are indices into `leads`. As in `bbsim plot`, the two keys with the most values are the
  // axes, and the first of them goes across.
  const state = {kind: axes.length >= 2 ? 'map' : axes.length === 1 ? 'lines' : 'histogram', measure: firstMeasure, x: 0, y: 0, fixed: new Map(), chosen: -1};
  const [across, up] = [...axes].sort((a, b) => b.levels.length - a.levels.length).slice(0, 2).map((key) => leads.indexOf(key)).sort((a, b) => a - b);
  if (axes.length > 0) state.x = across;
  if (axes.length > 1) state.y = up;
  if (state.y === state.x && leads.length > 1) state.y = (state.x + 1) % leads.length;

  const canvas = element('canvas', {tabindex: '0', role: 'img'});
  const over = svg('svg', {class: 'over', 'aria-hidden': 'true'});
  const drawing = element('div', {class: 'drawing'}, canvas, over);
  const tip = element('div', {class: 'tip', hidden: true});
  drawing.append(tip);
  const side = element('div', {class: 'case', 'aria-live': 'polite'});
  const controls = element('div', {class: 'controls'});
  const counts = element('ul', {class: 'statuses'});
  const remark = element('p', {class: 'fine remark'});
  let marks = [];  // of the picture: {i, x, y, w, h}; `all`: the cases that case i represents

  function select(label, options, chosen, action) {
    const made = element('select', {'aria-label': label}, ...options.map((words, i) => element('option', {value: String(i)}, words)));
    made.value = String(chosen);
    made.addEventListener('change', () => {
      action(Number(made.value));
      refresh();
    });
    return element('label', {}, `${label} `, made);
  }

  // The cases in the picture. In a grid, the keys that are no axis have fixed values.
  function fixedKeys() {
    if (!stack || state.kind === 'histogram') return [];
    return listed.filter((key) => key !== leads[state.x] && key !== leads[state.y] && key.levels.length > 1);
  }
  const levelOf = (key) => Math.min(state.fixed.get(key.name) || 0, key.levels.length - 1);
  function selected() {
    const fixed = fixedKeys();
    return Array.from(cases.keys()).filter((i) => fixed.every((key) => key.values[i] === key.levels[levelOf(key)]));
  }

  function makeControls() {
    controls.replaceChildren();
    const kinds = [['map', 'Map', leads.length >= 2], ['lines', 'Lines', true], ['histogram', 'Histogram', true]].filter(([, , can]) => can);
    const group = element('div', {class: 'segments', role: 'group', 'aria-label': 'Kind of picture'});
    for (const [kind, words] of kinds) {
      group.append(element('button', {'data-kind': kind, 'aria-pressed': String(state.kind === kind), onclick: () => {
        state.kind = kind;
        refresh();
      }}, words));
    }
    controls.append(group, select('Measure', measures.map((m) => text.columnName(m.name)), state.measure, (k) => { state.measure = k; }));
    // Keys change places if one takes the other's.
    const choice = (label, one, other) => select(label, leads.map(labelOf), state[one], (k) => {
      if (k === state[other]) state[other] = state[one];
      state[one] = k;
    });
    if (state.kind !== 'histogram') controls.append(choice('across', 'x', 'y'));
    if (state.kind !== 'histogram' && leads.length > 1) controls.append(choice(state.kind === 'map' ? 'up' : 'a line for each', 'y', 'x'));
    for (const key of fixedKeys()) {
      const level = levelOf(key);
      const shown = element('output', {}, shortText(key, key.levels[level]));
      const slider = element('input', {type: 'range', min: '0', max: String(key.levels.length - 1), value: String(level), 'aria-label': key.name});
      slider.addEventListener('input', () => {
        state.fixed.set(key.name, Number(slider.value));
        shown.textContent = text.visible(shortText(key, key.levels[slider.value]));
        draw();
      });
      controls.append(element('label', {}, `${labelOf(key)} `, slider, shown));
    }
  }

  // The axis of a column: the position of a value between two ends, and ticks.
  function axisOf(column, from, to, cells) {
    const {levels, shown = {factor: 1}} = column;
    const list = column.names || (cells && levels.length <= 400);
    if (list) {
      const step = (to - from) / levels.length;
      const every = Math.max(1, Math.ceil(levels.length / Math.max(2, Math.abs(to - from) / 64)));
      return {
        place: (value) => from + (levels.indexOf(value) + 0.5) * step, cell: Math.abs(step),
        ticks: levels.map((value, i) => [from + (i + 0.5) * step, shortText(column, value, 3)]).filter((_, i) => i % every === 0),
      };
    }
    const low = levels[0], high = levels[levels.length - 1];
    const scaled = column.logarithmic ? Math.log : (v) => v;
    const a = scaled(low), b = scaled(high), pad = (b - a) * 0.04 || Math.abs(a) * 0.1 || 1;
    const place = (value) => from + (scaled(value) - a + pad) / (b - a + 2 * pad) * (to - from);
    return {place, cell: 7, ticks: ticksOf(column, low, high, shown.factor, Math.abs(to - from) / 70).map((value) => [place(value / shown.factor), number(value)])};
  }
  // Ticks in the unit that is shown.
  function ticksOf({logarithmic}, low, high, factor, most) {
    if (!logarithmic) return text.ticks(low * factor, high * factor, most);
    const power = Math.floor(Math.log10(low * factor)), powers = Math.ceil(Math.log10(high * factor)) - power + 1;
    return Array.from({length: powers}, (_, i) => power + i).flatMap((p) => (high / low > 1e4 ? [1] : [1, 2, 5]).map((m) => Number(`${m}e${p}`)))
        .filter((value) => value >= low * factor * 0.999 && value <= high * factor * 1.001);
  }

  const unitOf = (column) => (column.shown.unit ? `, ${column.shown.unit}` : '');
  let ink, width, height;
  const box = {left: 74, top: 14, right: 96, bottom: 46};

  function frame(x, y, xName, yName) {
    over.replaceChildren();
    over.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const bottom = height - box.bottom;
    for (const [at, words] of x.ticks) {
      over.append(svg('path', {d: `M${at} ${bottom}v5`}), svg('text', {x: at, y: bottom + 18, 'text-anchor': 'middle'}, words));
    }
    for (const [at, words] of y.ticks) {
      over.append(svg('path', {d: `M${box.left} ${at}h-5`}), svg('text', {x: box.left - 8, y: at + 4, 'text-anchor': 'end'}, words));
    }
    over.append(svg('path', {d: `M${box.left} ${box.top}V${bottom}H${width - box.right}`}),
                svg('text', {x: (box.left + width - box.right) / 2, y: height - 8, 'text-anchor': 'middle', class: 'name'}, xName),
                svg('text', {x: 0, y: 0, 'text-anchor': 'middle', class: 'name', transform: `translate(13 ${(box.top + bottom) / 2}) rotate(-90)`}, yName));
  }

  // A case that is not done is gray, with a cross if it failed and a stroke if it was stopped.
  const signOf = (words) => ({done: '●', stopped: '⁄'}[words.split(/[ :]/)[0]] || '×');
  function paintStatus(i, x, y, w, h) {
    const dark = palette.isDark();
    ink.fillStyle = dark ? '#3a434e' : '#d5dae0';
    ink.fillRect(x, y, w, h);
    if (w < 5 || h < 5 || statusOf(i) === '') return;
    Object.assign(ink, {fillStyle: dark ? '#aab4bf' : '#59636e', textAlign: 'center', textBaseline: 'middle', font: `${Math.min(w, h, 30)}px system-ui, sans-serif`});
    ink.fillText(signOf(statusOf(i)), x + w / 2, y + h / 2);
  }

  // From the least to the greatest value, logarithmic over a decade and more; else from the 2nd to the
  // 98th percentile if a few are far out.
  function colourRange(values) {
    values.sort((a, b) => a - b);
    const at = (part) => data.quantile(values, part);
    const range = {low: at(0), high: at(1), clipped: false, logarithmic: at(0) > 0 && at(1) > 10 * at(0)};
    if (range.logarithmic) return range;
    if (values.length < 20 || range.high - range.low <= 4 * (at(0.98) - at(0.02))) return range;
    return {...range, low: at(0.02), high: at(0.98), clipped: true};
  }

  // The part of the color scale at a value.
  const partOf = ({low, high, logarithmic}, value) => (!(high > low) ? 0.5 : logarithmic ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low));

  function colourBar(range, factor, name) {
    over.append(svg('text', {'text-anchor': 'middle', class: 'name', transform: `translate(${width - 5} ${(box.top + height - box.bottom) / 2}) rotate(-90)`}, name));
    const x = width - box.right + 18, top = box.top, bottom = height - box.bottom;
    for (let y = 0; y < bottom - top; ++y) {
      ink.fillStyle = colourOf(1 - y / (bottom - top));
      ink.fillRect(x, top + y, 14, 1.5);
    }
    for (const value of ticksOf(range, range.low, range.high, factor, 5)) {
      const y = bottom - partOf(range, value / factor) * (bottom - top);
      over.append(svg('path', {d: `M${x + 14} ${y}h4`}), svg('text', {x: x + 21, y: y + 4}, number(value, 3)));
    }
    if (range.clipped) {
      over.append(svg('text', {x: x - 2, y: bottom + 18}, 'a few are'), svg('text', {x: x - 2, y: bottom + 32}, 'beyond'));
    }
  }

  // A line through the median of the cases above each place; it breaks where none is done. Returns its end.
  function lineOfMedians(points, measure) {
    let last = null, joined = false;
    ink.beginPath();
    for (const all of gathered(points, (point) => point.x)) {
      const middle = middleOf(all.map(({i}) => i), measure), {x, y} = all.find(({i}) => i === middle);
      if (isFine(middle, measure)) ink[joined ? 'lineTo' : 'moveTo'](...(last = [x + 4, y + 4]));
      joined = isFine(middle, measure);
    }
    ink.stroke();
    return last;
  }
  const drawnNames = () => leads.filter((key) => key.drawn).map(labelOf).join(', ');

  function drawMap(list, measure) {
    const kx = leads[state.x], ky = leads[state.y];
    const cells = axes.includes(kx) && axes.includes(ky);
    const x = axisOf(kx, box.left, width - box.right, cells), y = axisOf(ky, height - box.bottom, box.top, cells);
    const piles = cells ? gathered(list, (i) => `${kx.values[i]},${ky.values[i]}`) : list.map((i) => [i]);
    const shown = piles.map((all) => ({i: middleOf(all, measure), all}));
    const range = colourRange(shown.filter(({i}) => isFine(i, measure)).map(({i}) => measure.values[i]));
    const most = Math.max(...piles.map((all) => all.length));
    if (most > 1) remark.textContent = text.visible(`A cell shows the median of its ${stack ? '' : 'up to '}${most} cases${drawnNames() ? `, over draws of ${drawnNames()}` : ''}.`);
    for (const {i, all} of shown) {
      const w = Math.max(x.cell, 1), h = Math.max(y.cell, 1);
      const mark = {i, all, x: x.place(kx.values[i]) - w / 2, y: y.place(ky.values[i]) - h / 2, w, h};
      if (!Number.isFinite(mark.x + mark.y)) continue;
      marks.push(mark);
      const value = measure.values[i];
      if (isFine(i, measure)) {
        ink.fillStyle = colourOf(partOf(range, value));
        if (cells) {
          ink.fillRect(mark.x, mark.y, w + 0.5, h + 0.5);
        } else {
          ink.beginPath();
          ink.arc(mark.x + w / 2, mark.y + h / 2, 4, 0, 2 * Math.PI);
          ink.fill();
        }
      } else {
        paintStatus(i, mark.x, mark.y, w, h);
      }
    }
    frame(x, y, labelOf(kx) + unitOf(kx), labelOf(ky) + unitOf(ky));
    if (range.low !== undefined) colourBar(range, measure.shown.factor, text.columnName(measure.name) + unitOf(measure));
  }

  // The ends of an axis; around the value if there is only one.
  const spread = (low, high) => (low < high ? [low, high] : [low - (Math.abs(low) / 2 || 1), low + (Math.abs(low) / 2 || 1)]);

  function drawLines(list, measure) {
    const kx = leads[state.x], ky = leads.length > 1 ? leads[state.y] : null;
    const x = axisOf(kx, box.left, width - box.right, Boolean(kx.names));
    // A case that is not done may have reached any value.
    const fine = list.filter((i) => isFine(i, measure));
    const {least, greatest} = data.extent((fine.length > 0 ? fine : list).map((i) => measure.values[i]));
    const y = axisOf({levels: spread(least, greatest), shown: measure.shown}, height - box.bottom, box.top, false);
    const lined = ky && stack && listed.includes(ky) && ky.levels.length <= 12;
    for (const i of list) {
      const value = measure.values[i];
      const line = lined ? ky.values[i] : 0;
      const mark = {i, x: x.place(kx.values[i]) - 4, y: (Number.isFinite(value) ? Math.min(Math.max(y.place(value), box.top), height - box.bottom) : height - box.bottom) - 4, w: 8, h: 8, line, value};
      if (Number.isFinite(mark.x)) marks.push(mark);
    }
    frame(x, y, labelOf(kx) + unitOf(kx), text.columnName(measure.name) + unitOf(measure));
    const connect = stack && listed.includes(kx) && (!ky || lined);
    if (connect && stack > 1) remark.textContent = text.visible(`Lines go through the medians of ${stack} cases, over draws of ${drawnNames()}.`);
    const ends = [];
    gathered([...marks].sort((a, b) => a.line - b.line || a.x - b.x), (mark) => mark.line).forEach((points, n) => {
      const {line} = points[0], done = points.filter(({i}) => isFine(i, measure));
      ink.strokeStyle = palette.run(n);
      ink.lineWidth = 1.8;
      ink.setLineDash(palette.dash(n) || []);
      if (connect) lineOfMedians(points, measure);
      ink.setLineDash([]);
      for (const point of points) {
        if (isFine(point.i, measure)) {
          if (connect && points.length > 80) continue;
          ink.globalAlpha = connect && stack === 1 ? 1 : 0.55;
          ink.fillStyle = palette.run(n);
          ink.beginPath();
          ink.arc(point.x + 4, point.y + 4, 3, 0, 2 * Math.PI);
          ink.fill();
          ink.globalAlpha = 1;
        } else {
          paintStatus(point.i, point.x - 1, point.y - 1, 10, 10);
        }
      }
      const places = new Set(done.map(({x: at}) => at)).size;
      if (!connect && places > 1 && places <= done.length / 2) {
        ink.strokeStyle = palette.now().ink;
        ink.lineWidth = 2.5;
        const [at, level] = lineOfMedians(done, measure);
        over.append(svg('text', {x: at + 8, y: level + 4}, 'median'));
      }
      const end = done[done.length - 1];
      if (lined && end) ends.push({y: end.y + 8, words: shortText(ky, line), colour: palette.run(n)});
    });
    // Moves the names at the lines' ends apart.
    ends.sort((a, b) => a.y - b.y);
    ends.forEach((end, n) => { if (n > 0) end.y = Math.max(end.y, ends[n - 1].y + 14); });
    if (lined) over.append(svg('text', {x: width - box.right + 10, y: 12, class: 'name'}, ky.name.split('.').slice(-2).join('.')));
    for (const end of ends) {
      const words = svg('text', {x: width - box.right + 10, y: Math.max(end.y, 28)}, end.words);
      words.style.fill = end.colour;
      over.append(words);
    }
  }

  function drawHistogram(list, measure) {
    const values = list.filter((i) => isFine(i, measure)).sort((a, b) => measure.values[a] - measure.values[b]);
    const other = list.length - values.length;
    if (values.length === 0) {
      frame({ticks: []}, {ticks: []}, text.columnName(measure.name), 'cases');
      return;
    }
    const at = (part) => measure.values[data.quantile(values, part)];
    const low = measure.values[values[0]], high = measure.values[values[values.length - 1]];
    // Bars have the width of Freedman and Diaconis; there are 5 to 60 of them.
    const bar = 2 * (at(0.75) - at(0.25)) / Math.cbrt(values.length) || (high - low) / 10 || 1;
    const bars = Math.min(60, Math.max(5, Math.ceil((high - low) / bar)));
    const heap = Array.from({length: bars}, () => []);
    for (const i of values) heap[Math.min(bars - 1, Math.floor((measure.values[i] - low) / (high - low || 1) * bars))].push(i);
    const most = Math.max(...heap.map((h) => h.length));
    const x = axisOf({levels: spread(low, high), shown: measure.shown}, box.left, width - box.right, false);
    const bottom = height - box.bottom, tall = (n) => n / most * (bottom - box.top - 8);
    // A single value has a single bar around it.
    const wide = (x.place(high) - x.place(low)) / bars || 20, from = high > low ? x.place(low) : x.place(low) - wide / 2;
    heap.forEach((cases_, n) => {
      const mark = {x: from + n * wide, y: bottom - tall(cases_.length), w: wide, h: tall(cases_.length), i: cases_[cases_.length >> 1], cases: cases_.length,
                    from: low + n * (high - low) / bars, to: low + (n + 1) * (high - low) / bars};
      ink.fillStyle = palette.run(1);
      ink.fillRect(mark.x + 0.5, mark.y, Math.max(1, wide - 1), mark.h);
      if (cases_.length > 0) marks.push(mark);
    });
    const ticks = text.ticks(0, most, 5).filter(Number.isInteger).map((n) => [bottom - tall(n), String(n)]);
    frame(x, {ticks}, text.columnName(measure.name) + unitOf(measure), 'cases');
    const middle = at(0.5);
    over.append(svg('path', {d: `M${x.place(middle)} ${box.top}V${bottom}`, class: 'middle'}),
                svg('text', {x: x.place(middle) + 6, y: box.top + 10}, `median ${number(middle * measure.shown.factor)}`));
    if (other > 0) over.append(svg('text', {x: width - 8, y: box.top + 10, 'text-anchor': 'end'}, `${other} not done`));
  }

  function draw() {
    const scale = window.devicePixelRatio || 1;
    width = Math.max(280, drawing.clientWidth);
    height = Math.max(300, Math.min(0.62 * width, 620));
    box.left = width < 480 ? 58 : 74;
    box.right = state.kind === 'histogram' ? 20 : (width < 480 ? 66 : 96) + (state.kind === 'map' ? 16 : 0);
    canvas.width = width * scale;
    canvas.height = height * scale;
    drawing.style.height = `${height}px`;
    ink = canvas.getContext('2d', {willReadFrequently: true});
    ink.setTransform(scale, 0, 0, scale, 0, 0);
    ink.clearRect(0, 0, width, height);
    marks = [];
    remark.textContent = '';
    const measure = measures[state.measure], list = selected();
    ({map: drawMap, lines: drawLines, histogram: drawHistogram})[state.kind](list, measure);
    canvas.setAttribute('aria-label', text.visible(`${state.kind} of ${measure.name}, ${list.length} cases; arrow keys go from case to case`));
    showChosen();
  }

  const markOf = (i) => marks.find((mark) => mark.i === i) || marks.find((mark) => mark.all && mark.all.includes(i));
  function showChosen() {
    over.querySelectorAll('.chosen').forEach((old) => old.remove());
    const mark = markOf(state.chosen);
    if (mark) over.append(svg('rect', {x: mark.x - 1.5, y: mark.y - 1.5, width: mark.w + 3, height: mark.h + 3, class: 'chosen'}));
  }

  function choose(i) {
    state.chosen = i;
    showChosen();
    chosen(i);
    const rows = element('dl', {class: 'rows'});
    for (const column of [...keys, ...measures]) {
      rows.append(element('div', {}, element('dt', {}, column.name), element('dd', {}, valueText(column, i))));
    }
    side.replaceChildren(element('h3', {}, `Case ${cases[i]}`), element('p', {class: isDone(i) ? 'fine' : 'why'}, statusOf(i)), rows,
                         element('p', {class: 'fine again'}, 'To run it again:'),
                         bbsim.save.copyable(element('code', {id: 'rerun'}, swept.commandOf(i)), {class: 'wrap'}));
  }

  // The mark with the least cost below `most`; null if there is none.
  const markOfLeast = (costOf, most) => marks.reduce(([best, least], mark) => (costOf(mark) < least ? [mark, costOf(mark)] : [best, least]), [null, most])[0];
  function nearest(event) {
    const bounds = canvas.getBoundingClientRect();
    const px = (event.clientX - bounds.left) * width / bounds.width, py = (event.clientY - bounds.top) * height / bounds.height;
    return markOfLeast(({x, y, w, h}) => {
      const dx = Math.max(x - px, 0, px - x - w), dy = Math.max(y - py, 0, py - y - h);
      return dx * dx + dy * dy + 1e-3 * Math.hypot(x + w / 2 - px, y + h / 2 - py);
    }, 30 * 30);
  }

  canvas.addEventListener('pointermove', (event) => {
    const mark = nearest(event);
    tip.hidden = !mark;
    if (!mark) return;
    const measure = measures[state.measure];
    const lines = mark.cases === undefined
        ? [`case ${cases[mark.i]}`, ...keys.map((key) => `${key.name} = ${valueText(key, mark.i)}`), `${measure.name} = ${valueText(measure, mark.i)}`]
        : [`${mark.cases} cases`, `${number(mark.from * measure.shown.factor)} to ${number(mark.to * measure.shown.factor)} ${measure.shown.unit}`];
    if (mark.cases === undefined && !isDone(mark.i)) lines.push(statusOf(mark.i));
    if (mark.all && mark.all.length > 1) {
      const fine = mark.all.filter((i) => isFine(i, measure)).length;
      lines.unshift(fine > 0 ? `median of ${fine} cases${fine < mark.all.length ? `, ${mark.all.length - fine} not done` : ''}:` : `none of ${mark.all.length} cases done`);
    }
    tip.replaceChildren(...lines.map((line) => element('div', {}, line)));
    const left = Math.min(mark.x + mark.w + 10, width - 190);
    tip.style.transform = `translate(${Math.max(0, left)}px, ${Math.max(0, mark.y - 10)}px)`;
  });
  canvas.addEventListener('pointerleave', () => { tip.hidden = true; });
  canvas.addEventListener('click', (event) => {
    const mark = nearest(event);
    if (mark) choose(mark.i);
  });
  canvas.addEventListener('keydown', (event) => {
    const ways = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
    const way = ways[event.key];
    if (!way || marks.length === 0) return;
    event.preventDefault();
    const now = markOf(state.chosen);
    if (!now) return choose(marks[0].i);
    const next = markOfLeast(({x, y}) => {
      const dx = x - now.x, dy = y - now.y, ahead = dx * way[0] + dy * way[1], aside = Math.abs(dx * way[1]) + Math.abs(dy * way[0]);
      return ahead > 0.5 ? ahead + 3 * aside : Infinity;
    }, Infinity);
    if (next) choose(next.i);
  });

  function refresh() {
    makeControls();
    draw();
  }

  const words = Array.from(cases.keys(), (i) => statusOf(i).split(/[ :]/)[0]);
  for (const all of gathered(words, (word) => word).sort((a, b) => b.length - a.length)) {
    counts.append(element('li', {class: `status ${all[0]}`}, `${signOf(all[0])} ${all.length} ${all[0]}`));
  }
  const grouped = (n) => n.toLocaleString('en-US');
  const thinned = cases.length < json.cases ? ` ${grouped(cases.length)} of ${grouped(json.cases)} shown, evenly thinned out; the result file has all cases.` : '';
  container.append(element('section', {class: 'sweep'},
      element('header', {}, element('h2', {}, json.name), element('p', {class: 'fine'}, `${json.cases} ${json.cases === 1 ? 'case' : 'cases'} over ${keys.map((k) => k.name).join(', ')}.${thinned}`), counts),
      controls, remark, element('div', {class: 'columns'}, drawing, side)));
  if (json.scenario.text) {
    container.append(element('details', {class: 'card'}, element('summary', {}, element('h3', {}, json.scenario.file || 'scenario')),
                             element('pre', {tabindex: '0'}, bbsim.highlight(json.scenario.text))));
  }
  side.append(element('p', {class: 'fine'}, 'Choose a case to see its values and the command that runs it again.'));
  refresh();
  // Chooses the only case that is done.
  const done = Array.from(cases.keys()).filter(isDone);
  if (done.length === 1) choose(done[0]);
  new ResizeObserver(() => { if (drawing.clientWidth && Math.abs(drawing.clientWidth - width) > 1) draw(); }).observe(drawing);
  palette.onChange(draw);
  return {
    state, choose, refresh, csv: swept.csv,
    // The columns and the status of cases have changed.
    update() {
      swept.renew();
      draw();
    },
    // For tests: the place of a case in the window.
    placeOf(number_) {
      const mark = markOf(cases.indexOf(number_));
      if (!mark) return null;
      const bounds = canvas.getBoundingClientRect();
      return [bounds.left + (mark.x + mark.w / 2) * bounds.width / width, bounds.top + (mark.y + mark.h / 2) * bounds.height / height];
    },
  };
};
