// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Texts and numbers for readers. Nothing of a scene enters the page as HTML.
window.bbsim = {};

bbsim.text = (() => {
  // Replaces invisible characters, such as escape codes, and those that change the direction of
  // text, with visible signs.
  function visible(text) {
    return String(text).replace(
        /[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u200b-\u200f\u202a-\u202e\u2028\u2029\u2060-\u2069\ufeff]/g,
        (c) => {
          const code = c.charCodeAt(0);
          if (code < 0x20) return String.fromCharCode(0x2400 + code);
          return '⟨U+' + code.toString(16).toUpperCase().padStart(4, '0') + '⟩';
        });
  }

  function fill(made, attributes, children) {
    for (const [key, value] of Object.entries(attributes)) {
      if (value === false || value === undefined || value === null) continue;
      if (key.startsWith('on')) made.addEventListener(key.slice(2), value);
      else made.setAttribute(key, value === true ? '' : value);
    }
    for (const child of children) {
      if (child !== null && child !== undefined) made.append(typeof child === 'string' ? visible(child) : child);
    }
    return made;
  }
  // element('p', {class: 'x', onclick: f}, 'text', child...): texts become text nodes.
  const element = (name, attributes = {}, ...children) => fill(document.createElement(name), attributes, children);
  const svg = (name, attributes = {}, ...children) => fill(document.createElementNS('http://www.w3.org/2000/svg', name), attributes, children);

  // A button that is pressed or not; `action(on)` follows each change.
  function toggle(words, attributes, action, on = false) {
    const made = element('button', {...attributes, 'aria-pressed': String(on), onclick() {
      const now = made.getAttribute('aria-pressed') !== 'true';
      made.setAttribute('aria-pressed', String(now));
      action(now);
    }}, words);
    return made;
  }

  // Four significant digits, with a true minus sign.
  function number(value, digits = 4) {
    if (!Number.isFinite(value)) return Number.isNaN(value) ? '–' : value > 0 ? '∞' : '−∞';
    if (value === 0) return '0';
    const size = Math.abs(value);
    const rounded = Number(value.toPrecision(digits));
    const text = size >= 1e6 || size < 1e-4 ? rounded.toExponential().replace('e+', 'e') : String(rounded);
    return text.replaceAll('-', '−');
  }

  // As many decimals as a value of this size needs, so that the text does not jitter.
  function steady(value, size) {
    if (!Number.isFinite(value)) return number(value);
    if (size >= 1e6 || (size > 0 && size < 1e-5)) return number(value);
    const decimals = Math.max(0, Math.min(8, 3 - Math.floor(Math.log10(size || 1))));
    const text = value.toFixed(decimals);
    return (Number(text) === 0 ? (0).toFixed(decimals) : text).replaceAll('-', '−');
  }

  const degrees = 180 / Math.PI;
  const angles = {'rad': '°', 'rad/s': '°/s', 'rad/s^2': '°/s²'};
  const prefixed = ['m', 'm/s', 'N', 'N m', 'W', 'J', 'N s', 'V', 'A'];

  // The unit for a quantity of this size: {factor, unit}.
  function shownIn(unit, size) {
    if (unit in angles) return {factor: degrees, unit: angles[unit]};
    const name = unit === '1' ? '' : unit.replace('^2', '²').replace('N m', 'N·m').replace('kg m', 'kg·m');
    const lengths = unit === 'm';
    if (prefixed.includes(unit) && size > 0) {
      if (size < 1e-4) return {factor: 1e6, unit: 'µ' + name};
      if (size < (lengths ? 1 : 0.1)) return {factor: 1e3, unit: 'm' + name};
    }
    return {factor: 1, unit: name};
  }

  // The least of 1, 2 and 5 times a power of ten that is this large.
  function roundUp(value) {
    const power = 10 ** Math.floor(Math.log10(value));
    return [1, 2, 5, 10].find((n) => n * power >= value) * power;
  }

  // Round numbers from low to high: as many as `most` or fewer, but three at least.
  function ticks(low, high, most) {
    for (let many = most; many < 100; many *= 1.5) {
      const step = roundUp((high - low) / many), first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
      if (last - first >= 2) return Array.from({length: last - first + 1}, (_, i) => Number(((first + i) * step).toPrecision(12)));
    }
    return [low];  // is also high
  }

  const symbols = {phi: 'φ', theta: 'θ', gamma: 'γ'};

  // Turns phi_command into "φ command".
  function columnName(name) {
    return name.split('_').map((word) => symbols[word] || word).join(' ');
  }

  // The number of decimals for times with this step.
  function decimalsOfTime(step) {
    return Math.max(1, Math.min(6, Math.ceil(-Math.log10(step || 0.01) - 1e-9)));
  }

  return {visible, element, svg, toggle, number, steady, shownIn, roundUp, ticks, columnName, decimalsOfTime, degrees};
})();
