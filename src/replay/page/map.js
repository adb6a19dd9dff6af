// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A map of a measure over two keys of a live page's scenario. `load([[key, value], ...])` shows the
// case of a cell.
bbsim.makeMap = (cases, requestOf, load) => {
  const {element} = bbsim.text;
  const status = element('span', {class: 'live-status', role: 'status'}), series = cases.makeSeries(status, 'cases');
  const area = element('div', {class: 'map'});
  const stop = element('button', {hidden: true, onclick: () => {
    series.end();
    stop.hidden = true;
    status.textContent = 'stopped';
  }}, 'Stop');
  const select = (label) => element('select', {'aria-label': label, onchange: () => draw(true)});
  const across = select('across'), up = select('up'), measure = select('measure'), cells = select('cells');
  cells.append(...[10, 20, 40].map((n) => element('option', {value: String(n)}, `${n} × ${n}`)));
  cells.value = '20';
  const labelled = (words, one) => element('label', {}, `${words} `, one);
  const root = element('details', {class: 'card', ontoggle: () => {
    if (!root.open) series.end();
    else if (shown === null) draw(true);
  }}, element('summary', {}, element('h3', {}, 'Map')),
                       element('p', {class: 'controls'}, labelled('Measure', measure), labelled('across', across), labelled('up', up), cells, status, stop), area);

  let offered = {keys: [], measures: {}}, state = null, shown = null;

  function offer(list, names, wanted) {
    if ([...list.options].map(({value}) => value).join() === names.join()) return;
    const before = list.value;
    list.replaceChildren(...names.map((name) => element('option', {value: name}, name)));
    list.value = names.includes(before) ? before : wanted;
  }

  // `count` values up to the end of the key's slider, SI.
  function valuesOf(name, count) {
    const key = offered.keys.find(({key: one}) => one === name), neighbor = bbsim.neighborOf(key, offered.keys);
    const {low, high} = bbsim.rangeOf(key, {number: key.value, unit: key.unit}, neighbor && {value: neighbor.value, number: neighbor.value});
    return Array.from({length: count}, (_, i) => Number((low + (i + 1) / count * (high - low)).toPrecision(12)));
  }

  // An empty map of what is chosen.
  function begin() {
    const count = Number(cells.value), xs = valuesOf(across.value, count), ys = valuesOf(up.value, count);
    const all = Array.from({length: count * count}, (_, i) => i);
    const keys = {[across.value]: Float64Array.from(all, (i) => xs[i % count]), [up.value]: Float64Array.from(all, (i) => ys[Math.floor(i / count)])};
    const unitOf = (name) => (offered.keys.find(({key}) => key === name) || {}).unit || '';
    const json = {
      name: 'Map', title: '', cases: all.length, numbers: Float64Array.from(all), statuses: ['', 'done'], status: all.map(() => 0),
      keys: Object.entries(keys).map(([name, doubles]) => ({name, unit: unitOf(name), doubles})),
      measures: [{name: measure.value, unit: offered.measures[measure.value].unit, doubles: new Float64Array(all.length).fill(NaN)}],
      scenario: {file: '', text: '', overrides: []},
    };
    area.replaceChildren();
    const picture = bbsim.map = bbsim.makeSweep(json, area, (i) => load(Object.entries(keys).map(([key, values]) => [key, String(values[i])])));
    return {keys, json, picture};
  }

  // What the cells depend on.
  const basisOf = ({text, set, script}) => JSON.stringify([text, script, set.filter(([key]) => !(key in shown.keys))]);
  // Marks the cell of the page's run.
  function mark() {
    const now = Object.keys(shown.keys).map((name) => (offered.keys.find(({key}) => key === name) || {value: NaN}).value);
    const far = (i) => Object.values(shown.keys).reduce((sum, values, k) => sum + ((values[i] - now[k]) / (values[values.length - 1] - values[0])) ** 2, 0);
    const [{doubles}] = shown.json.measures;
    shown.picture.state.chosen = doubles.reduce((best, _, i) => (far(i) < far(best) ? i : best), 0);
  }

  async function draw(anew) {
    if (!root.open || state === null || across.options.length < 2) return null;
    if (across.value === up.value) up.selectedIndex = (across.selectedIndex + 1) % up.options.length;
    if (anew || shown === null) {
      shown = begin();
      mark();
    }
    const {keys, json, picture} = shown, [{name, doubles}] = json.measures;
    shown.basis = basisOf(state);
    stop.hidden = false;
    try {
      const all = await series.begin(requestOf(state), {keys, measures: [name]}, (first, words, _, measures) => {
        words.forEach((word, i) => {
          if (!json.statuses.includes(word)) json.statuses.push(word);
          json.status[first + i] = json.statuses.indexOf(word);
          doubles[first + i] = measures[name] ? measures[name][i] : NaN;
        });
      }, picture.update);
      if (!all) return null;
    } catch (error) {
      status.textContent = error.message;
    }
    stop.hidden = true;
    return {keys, status: json.status.map((i) => json.statuses[i]), values: doubles};
  }

  return {
    root,
    // The page shows another state, with these keys and measures.
    follow(next, {keys, free, measures}) {
      offered = {keys, measures};
      state = next;
      const names = keys.filter(({key, whole}) => !whole && (free.length === 0 || free.includes(key))).map(({key}) => key);
      // Gains first, of one axis if there are two.
      const value = (name) => keys.find(({key}) => key === name).value, tail = (name) => name.split('.').slice(-2).join('.');
      const gains = [...names.filter((name) => /^controller\.(?!reference|sampling|sensor)/.test(name) && value(name) !== 0), ...names];
      offer(across, names, gains[0]);
      offer(up, names, gains.find((name, i) => i > 0 && tail(name) === tail(gains[0])) || gains[1]);
      offer(measure, Object.keys(measures), Object.keys(measures).find((name) => name.includes('tracking')) || Object.keys(measures)[0]);
      if (!root.open || shown === null) return;
      if (shown.basis !== basisOf(next)) draw(Object.keys(shown.keys).join() !== [across.value, up.value].join());
      else shown.picture.update();
    },
    // Draws another map; fulfilled with {keys, status, values} of all cells, or null if a newer wish came.
    show(x, y, what, count) {
      [across.value, up.value, measure.value, cells.value] = [x, y, what, String(count)];
      shown = null;
      root.open = true;
      return draw(true);  // before its toggle event
    },
  };
};
