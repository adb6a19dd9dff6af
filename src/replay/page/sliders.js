// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The largest number in the list or matrix that has this number, or null: in reference.point, of x and y.
bbsim.neighborOf = ({key}, keys) => {
  const list = key.replace(/(\.\d+)+$/, '.');
  return keys.filter((other) => list !== key && other.value !== 0 && other.key.startsWith(list))
      .reduce((best, one) => (best && Math.abs(best.value) >= Math.abs(one.value) ? best : one), null);
};

// The range of a key's slider in `unit`, in which its value is `number`: up to 2.5 times the value, as
// far as it is allowed. `least` and `most` are SI; `open`: least itself is not allowed. At zero, the
// range is that of `like`, {value, number} of a neighbor in the same unit, or a usual one of the unit.
bbsim.rangeOf = ({value, least, most, open, whole}, {number, unit}, like) => {
  const usual = {m: 0.1, cm: 10, mm: 100, s: 0.1, ms: 100, rad: 0.1, deg: 5, 'm/s': 0.5, 'cm/s': 50}[unit] || (whole ? 10 : 1);
  const known = number === 0 ? like : {value, number};
  const size = known ? 2.5 * Math.abs(known.number) : usual, factor = known ? known.value / known.number : null;
  const inUnit = (bound, otherwise) => (bound === null || (factor === null && bound !== 0) ? otherwise : factor === null ? 0 : bound / factor);
  let low = Math.max(inUnit(least, -size), -size), high = Math.min(inUnit(most, size), size);
  if (number > 0 && low < 0) low = 0;
  if (number < 0 && high > 0) high = 0;
  if (whole) high = Math.floor(high);
  if (!(high > low)) high = low + size;
  const power = 10 ** Math.floor(Math.log10((high - low) / 200));
  const step = Math.max(whole ? 1 : 0, [1, 2, 5, 10].map((n) => n * power).find((n) => n >= (high - low) / 200 * 0.999));
  return {low: open && low === inUnit(least, -size) ? low + step : low, high, step};
};

// Sliders for the numbers of a live page's scenario, in the units of its text.
bbsim.makeSliders = ({remember, change, valueOf}) => {
  const {element, number: numberText} = bbsim.text;
  const root = element('div', {class: 'sliders'});
  // What the key in hand means: for fingers, which see no titles.
  const meaning = element('p', {class: 'fine meaning'});

  // "2 cm" -> {number: 2, unit: 'cm'}
  function parsed(words) {
    const found = /^\s*['"]?([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([^'"]*?)['"]?\s*$/i.exec(words);
    return found ? {number: Number(found[1]), unit: found[2]} : null;
  }

  function rowOf(key, keys) {
    const words = valueOf(key.key) || key.text, begun = parsed(words), neighbor = bbsim.neighborOf(key, keys);
    if (!begun) return null;
    // A bare 0 takes its neighbor's unit.
    const its = neighbor && parsed(neighbor.text), like = its && {value: neighbor.value, ...its};
    const unit = begun.number === 0 && begun.unit === '' && like ? like.unit : begun.unit;
    const fits = (at) => at !== null && (at.unit === unit || at.number === 0);
    const {low, high, step} = bbsim.rangeOf(key, {number: begun.number, unit: unit || key.unit}, like && like.unit === unit ? like : null);
    const id = `live-${key.key}`, parts = key.key.split('.'), last = parts.pop();
    // Steps count from the value, so that the slider can come back to it.
    const title = key.meaning ? `${key.key}: ${key.meaning}` : key.key;
    const input = element('input', {type: 'range', id, title, min: Math.min(low, begun.number), max: Math.max(high, begun.number), step: 'any', 'data-key': key.key});
    const field = element('input', {type: 'text', class: 'value', 'aria-label': `${key.key}, as text`, spellcheck: 'false'});
    const textOf = (value) => `${Number(value.toPrecision(12))} ${unit}`.trim();
    function place(now) {
      const at = parsed(now);
      field.value = now.replace(/^'(.*)'$/, '$1');
      if (fits(at)) input.value = at.number;
      input.setAttribute('aria-valuetext', at ? `${numberText(at.number, 6)} ${at.unit}`.trim() : now);
    }
    let held = false;
    const release = () => { held = false; };
    input.addEventListener('input', () => {
      if (!held) remember();
      held = true;
      const steps = Math.round((Number(input.value) - begun.number) / step);
      const now = textOf(Math.min(Math.max(begun.number + steps * step, low), high));
      place(now);
      change(key.key, now);
    });
    for (const end of ['change', 'blur']) input.addEventListener(end, release);
    field.addEventListener('change', () => {
      remember();
      place(field.value);
      change(key.key, field.value);
    });
    const row = element('div', {class: 'slider'},
                        element('label', {for: id, title}, element('small', {}, ...parts.flatMap((part) => [`${part}.`, element('wbr')])), last),
                        input, field);
    place(words);
    for (const touch of ['pointerdown', 'focusin']) row.addEventListener(touch, () => meaning.replaceChildren(bbsim.text.visible(title)));
    return Object.assign(row, {key: key.key, fits, place});
  }

  return {
    root, meaning,
    // Shows these keys, or only the free ones. Rows of the same key and unit stay, with their focus.
    fill({keys, free}) {
      const wanted = keys.filter(({key}) => free.length === 0 || free.includes(key)), rows = [...root.children];
      const stays = wanted.length === rows.length && wanted.every(({key, text}, i) => rows[i].key === key && rows[i].fits(parsed(valueOf(key) || text)));
      if (stays) {
        wanted.forEach(({key, text}, i) => { if (document.activeElement !== rows[i].querySelector('.value')) rows[i].place(valueOf(key) || text); });
        return;
      }
      root.replaceChildren(...wanted.map((key) => rowOf(key, keys)).filter(Boolean));
      if (root.children.length === 0) root.append(element('p', {class: 'fine'}, 'The scenario has no numbers to slide: change its text.'));
    },
    update(key, words) {
      for (const row of root.children) if (row.key === key) row.place(words);
    },
  };
};
