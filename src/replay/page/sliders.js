// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The range of a key's slider in the unit of `number`, its value: up to 2.5 times the value, as far as
// it is allowed. `least` and `most` are SI; `open`: least itself is not allowed.
bbsim.rangeOf = ({value, least, most, open, whole}, number) => {
  const size = number === 0 ? 1 : 2.5 * Math.abs(number), factor = number === 0 ? null : value / number;
  const inUnit = (bound, otherwise) => (bound === null || (factor === null && bound !== 0) ? otherwise : factor === null ? 0 : bound / factor);
  let low = Math.max(inUnit(least, -size), -size), high = Math.min(inUnit(most, size), size);
  if (number > 0 && low < 0) low = 0;
  if (number < 0 && high > 0) high = 0;
  if (!(high > low)) high = low + size;
  const power = 10 ** Math.floor(Math.log10((high - low) / 200));
  const step = Math.max(whole ? 1 : 0, [1, 2, 5, 10].map((n) => n * power).find((n) => n >= (high - low) / 200 * 0.999));
  return {low: open && low === inUnit(least, -size) ? low + step : low, high, step};
};

// Sliders for the numbers of a live page's scenario, in the units of its text.
bbsim.makeSliders = ({remember, change, valueOf}) => {
  const {element, number: numberText} = bbsim.text;
  const root = element('div', {class: 'sliders'});

  // "2 cm" -> {number: 2, unit: 'cm'}
  function parsed(words) {
    const found = /^\s*['"]?([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([^'"]*?)['"]?\s*$/i.exec(words);
    return found ? {number: Number(found[1]), unit: found[2]} : null;
  }

  function rowOf(key) {
    const words = valueOf(key.key) || key.text, begun = parsed(words);
    if (!begun) return null;
    const {unit} = begun, {low, high, step} = bbsim.rangeOf(key, begun.number);
    const id = `live-${key.key}`, parts = key.key.split('.'), last = parts.pop();
    // Steps count from the value, so that the slider can come back to it.
    const input = element('input', {type: 'range', id, min: Math.min(low, begun.number), max: Math.max(high, begun.number), step: 'any', 'data-key': key.key});
    const field = element('input', {type: 'text', class: 'value', 'aria-label': `${key.key}, as text`, spellcheck: 'false'});
    const textOf = (value) => `${Number(value.toPrecision(12))} ${unit}`.trim();
    function place(now) {
      const at = parsed(now);
      field.value = now.replace(/^'(.*)'$/, '$1');
      if (at && at.unit === unit) input.value = at.number;
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
                        element('label', {for: id, title: key.key}, parts.length > 0 ? element('small', {}, `${parts.join('.')}.`) : null, last),
                        input, field);
    place(words);
    return Object.assign(row, {key: key.key, unit, place});
  }

  return {
    root,
    // Shows these keys, or only the free ones. Rows of the same key and unit stay, with their focus.
    fill({keys, free}) {
      const wanted = keys.filter(({key}) => free.length === 0 || free.includes(key)), rows = [...root.children];
      const stays = wanted.length === rows.length && wanted.every(({key, text}, i) => rows[i].key === key && (parsed(valueOf(key) || text) || {}).unit === rows[i].unit);
      if (stays) {
        wanted.forEach(({key, text}, i) => { if (document.activeElement !== rows[i].querySelector('.value')) rows[i].place(valueOf(key) || text); });
        return;
      }
      root.replaceChildren(...wanted.map(rowOf).filter(Boolean));
      if (root.children.length === 0) root.append(element('p', {class: 'fine'}, 'The scenario has no numbers to slide: change its text.'));
    },
    update(key, words) {
      for (const row of root.children) if (row.key === key) row.place(words);
    },
  };
};
