// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The items of a list in piles: those with the same place.
bbsim.gathered = (list, placeOf) => {
  const places = new Map();
  for (const one of list) {
    const place = placeOf(one);
    if (!places.has(place)) places.set(place, []);
    places.get(place).push(one);
  }
  return [...places.values()];
};

// The cases of a sweep: its keys, measures and axes, their texts, and the command that runs a case
// again.
bbsim.makeSwept = (json) => {
  const {text, data} = bbsim, {number} = text;

  function columnOf(column) {
    const made = {name: column.name, unit: column.unit, drawn: Boolean(column.drawn), along: column.along};
    if (column.words) {
      made.names = [...new Set(column.words)];
      made.words = column.words;
      made.values = Float64Array.from(column.words, (word) => made.names.indexOf(word));
    } else {
      made.values = column.doubles ? data.doubles(column.doubles) : data.floats(column.floats);
    }
    return measured(made);
  }
  function measured(made) {
    const finite = [...new Set(made.values)].filter(Number.isFinite).sort((a, b) => a - b);
    made.levels = finite;
    made.size = finite.length ? Math.max(Math.abs(finite[0]), Math.abs(finite[finite.length - 1])) : 0;
    made.shown = text.shownIn(made.unit, made.size);
    // The axis is logarithmic if the ratios of neighboring levels vary less than their differences.
    made.logarithmic = !made.words && finite.length > 2 && finite[0] > 0 && finite[finite.length - 1] / finite[0] > 20 &&
        Math.abs(Math.log(finite[1] / finite[0]) / Math.log(finite[finite.length - 1] / finite[0]) * (finite.length - 1) - 1) < 0.5;
    return made;
  }

  const keys = json.keys.map(columnOf), measures = json.measures.map(columnOf);
  const cases = data.doubles(json.numbers), count = cases.length;
  const statusOf = (i) => json.statuses[json.status[i]], isDone = (i) => statusOf(i) === 'done';
  // The first of several tied keys represents all of them.
  const leads = keys.filter((key) => !key.along), listed = leads.filter((key) => !key.drawn);
  const labelOf = (key) => [key, ...keys.filter((other) => other.along === key.name)].map((one) => one.name).join(', ');
  // The number of cases for each combination of the listed keys' values: one in a grid, several if
  // other keys were drawn. 0 if the numbers differ or combinations are missing.
  const stack = (() => {
    const cells = listed.reduce((product, key) => product * key.levels.length, 1);
    if (cells > count) return 0;
    const piles = bbsim.gathered(cases.keys(), (i) => listed.map((key) => key.values[i]).join());
    return piles.length === cells && piles.every((pile) => pile.length === count / cells) ? count / cells : 0;
  })();
  const axes = listed.filter((key) => key.levels.length > 1 && (stack > 0 || key.levels.length <= count / 2));

  const isFine = (i, measure) => isDone(i) && Number.isFinite(measure.values[i]);
  // The median of the done cases in one place, or the first case if none is done.
  function middleOf(all, measure) {
    const fine = all.filter((i) => isFine(i, measure)).sort((a, b) => measure.values[a] - measure.values[b]);
    return fine.length > 0 ? fine[fine.length >> 1] : all[0];
  }
  const valueText = (column, i) => (column.words ? column.words[i] : `${number(column.values[i] * column.shown.factor, 7)} ${column.shown.unit}`.trim());
  const shortText = (column, value, digits = 4) => (column.names ? column.names[value] || '' : number(value * column.shown.factor, digits));

  // Quotes a word for a shell.
  const quoted = (word) => (/^[\w@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", `'\\''`)}'`);
  function commandOf(i) {
    const sets = [...json.scenario.overrides, ...keys.map((key) => `${key.name}=${key.words ? key.words[i] : String(key.values[i])}`)];
    const stem = (json.scenario.file || 'scenario.yaml').split('/').pop().replace(/\.ya?ml$/, '');
    return [`bbsim run ${quoted(json.scenario.file || 'SCENARIO')}`, ...sets.map((set) => `--set ${quoted(set)}`),
            `-o ${quoted(`${stem}-case-${cases[i]}.csv`)}`].join(' \\\n  ');
  }

  function csv() {
    const lines = [['case', ...keys.map((k) => k.name), 'status', ...measures.map((m) => m.name)].join(',')];
    const plain = (words) => (/[",\n]/.test(words) ? `"${words.replaceAll('"', '""')}"` : words);
    for (let i = 0; i < count; ++i) {
      const cell = (column) => (column.words ? plain(column.words[i]) : String(column.values[i]));
      lines.push([cases[i], ...keys.map(cell), plain(statusOf(i)), ...measures.map(cell)].join(','));
    }
    return lines.join('\n') + '\n';
  }

  return {
    keys, measures, cases, leads, listed, stack, axes, isDone, isFine, statusOf, labelOf, middleOf, valueText, shortText, commandOf, csv,
    // The values of measures have changed.
    renew: () => measures.forEach(measured),
  };
};
