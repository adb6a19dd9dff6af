// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Changes the scenario of a live page and runs it again: sliders for its numbers, its text, undo,
// links, the measures and the tasks of an exercise. The newest wish wins: while a run computes, only
// the last change waits.
bbsim.makeLive = (container) => {
  const {data, text} = bbsim;
  const {element} = text;
  const [lead] = data.runs;
  const engine = bbsim.makeEngine();
  const name = lead.scenario.file || 'scenario.yaml';
  const original = {text: lead.scenario.text, set: settingsOf(lead.scenario.overrides)};

  let base = original.text, set = new Map(original.set);  // the text, and the keys set in it
  let offered = data.scene.live, yaml = base, measures = {}, tasks = offered.tasks.map(() => false), columns = null;
  const history = [];
  let pinned = false, controlled = false, computing = false, waiting = null, calm = 0;

  function settingsOf(overrides) {
    return overrides.map((words) => [words.slice(0, words.indexOf('=')), words.slice(words.indexOf('=') + 1)]);
  }

  // --- Runs ---------------------------------------------------------------------------------

  const status = element('p', {class: 'live-status', role: 'status'});
  const stop = element('button', {type: 'button', hidden: true, onclick: () => engine.stop('stopped')}, 'Stop');
  const faults = element('ul', {class: 'faults'});

  const request = (more = {}) => ({text: base, name, set: Object.fromEntries(set), controlled, measures: [], checked: false, keys: false, ...more});

  async function ask(more) {
    const begun = performance.now();
    const late = setInterval(() => {
      status.textContent = `computing for ${Math.round((performance.now() - begun) / 1000)} s`;
      stop.hidden = false;
    }, 1000);
    try {
      return await engine.ask(request(more));
    } finally {
      clearInterval(late);
      stop.hidden = true;
    }
  }

  function showFaults(list) {
    faults.replaceChildren(...list.map(({place, message}) => {
      const line = Number((/:(\d+):\d+$/.exec(place) || [])[1]);
      return element('li', {}, line > 0 ? element('button', {type: 'button', class: 'link', onclick: () => goToLine(line)}, `line ${line}`) : null,
                     line > 0 ? `: ${message}` : message);
    }));
  }

  // Shows a run's answer in all views.
  function show({answer, arrays}) {
    ({measures, text: yaml} = answer);
    measures = Object.fromEntries(Object.entries(measures).map(([key, one]) => [key, {...one, value: one.value === null ? NaN : one.value}]));
    tasks = answer.tasks.map(({holds}) => holds);
    columns = Object.fromEntries(Object.entries(answer.columns).map(([key, place]) => [key, arrays[place]]));
    const {live, ...scene} = answer.scene;
    scene.runs[0].scenario.overrides = [...set].map(([key, value]) => `${key}=${value}`);
    // What only a checked run has stays until the next one.
    if (scene.runs[0].check.length === 0) scene.runs[0].check = lead.check;
    data.replace(scene, arrays);
    if (live) {
      offered = live;
      fillSliders();
    }
    if (document.activeElement !== editor) editor.value = yaml;
    showFaults(answer.warnings.map((message) => ({place: '', message})));
    showNumbers(answer.tasks);
  }

  // Runs what is wanted now. Fulfilled when it is drawn; rejected if it cannot run, or if a newer
  // wish took its place.
  function run(more) {
    return new Promise((resolve, reject) => {
      if (waiting) waiting.reject(new Error('a newer change took its place'));
      waiting = {more, resolve, reject};
      next();
    });
  }
  async function next() {
    if (computing || !waiting) return;
    const {more, resolve, reject} = waiting;
    waiting = null;
    computing = true;
    clearTimeout(calm);
    const begun = performance.now();
    try {
      const result = await ask(more);
      if (result.answer.faults) {
        showFaults(result.answer.faults);
        status.textContent = 'not run';
        reject(new Error(result.answer.faults.map(({message}) => message).join('\n')));
      } else {
        status.textContent = `computed in ${text.number(performance.now() - begun, 3)} ms`;
        show(result);
        requestAnimationFrame(() => setTimeout(resolve, 0));
        if (!result.answer.scene.runs[0].check.length) calm = setTimeout(describe, 500);
      }
    } catch (error) {
      status.textContent = error.message;
      reject(error);
    } finally {
      computing = false;
      if (bbsim.addressLater) bbsim.addressLater();
      next();
    }
  }
  // At rest, the cards below the plots follow, which takes longer than the run.
  async function describe() {
    try {
      const {answer} = await ask({checked: true});
      if (answer.faults || computing || waiting) return;
      Object.assign(lead, {check: answer.scene.runs[0].check, summary: answer.scene.runs[0].summary});
      bbsim.details.fill();
    } catch (error) {
      status.textContent = error.message;
    }
  }

  // --- Changes ------------------------------------------------------------------------------

  // Keeps the state before a gesture, for undo, and its run beside the new one.
  function remember() {
    const last = history[history.length - 1];
    if (!last || last.base !== base || String([...last.set]) !== String([...set])) history.push({base, set: new Map(set)});
    if (!pinned) data.before = data.copyOf(lead);
    showButtons();
  }
  const quietly = (promise) => promise.catch(() => {});  // its fault is on the page

  function setKey(key, value) {
    set.delete(key);  // settings apply in their order
    set.set(key, String(value));
    return run();
  }

  function restore(state) {
    ({base} = state);
    set = new Map(state.set);
    quietly(run({keys: true}));
    showButtons();
  }
  const undo = () => { if (history.length > 0) restore(history.pop()); };
  const reset = () => {
    remember();
    restore({base: original.text, set: original.set});
  };

  // --- Sliders ------------------------------------------------------------------------------

  const sliders = element('div', {class: 'sliders'});
  // "2 cm" -> {number: 2, unit: 'cm'}
  function parsed(words) {
    const found = /^\s*['"]?([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*([^'"]*?)['"]?\s*$/i.exec(words);
    return found ? {number: Number(found[1]), unit: found[2]} : null;
  }

  // The slider's range in the unit of the text: what is allowed, or else up to twice the value.
  function rangeOf({value, least, most}, number) {
    const factor = number !== 0 && value !== 0 ? value / number : 1;
    const size = number === 0 ? 1 : 2.5 * Math.abs(number);
    let low = least === null ? -size : Math.max(least / factor, -size), high = most === null ? size : Math.min(most / factor, size);
    if (number > 0 && low < 0) low = 0;
    if (number < 0 && high > 0) high = 0;
    if (!(high > low)) high = low + size;
    const power = 10 ** Math.floor(Math.log10((high - low) / 200));
    return {low, high, step: [1, 2, 5, 10].map((n) => n * power).find((n) => n >= (high - low) / 200 * 0.999)};
  }

  function slider(key) {
    const begun = parsed(set.get(key.key) || key.text);
    if (!begun) return null;
    const {low, high, step} = rangeOf(key, begun.number);
    const id = `live-${key.key}`, parts = key.key.split('.');
    const input = element('input', {type: 'range', id, min: low, max: high, step: key.whole ? Math.max(1, Math.round(step)) : step, 'data-key': key.key});
    input.value = begun.number;
    const field = element('input', {type: 'text', class: 'value', value: `${begun.number} ${begun.unit}`.trim(), 'aria-label': `${key.key}, as text`, spellcheck: 'false'});
    const valueText = () => `${text.number(Number(input.value), 6)} ${begun.unit}`.trim();
    input.setAttribute('aria-valuetext', valueText());
    let held = false;
    const release = () => { held = false; };
    input.addEventListener('input', () => {
      if (!held) remember();
      held = true;
      const words = `${Number(Number(input.value).toPrecision(12))} ${begun.unit}`.trim();
      field.value = words;
      input.setAttribute('aria-valuetext', valueText());
      quietly(setKey(key.key, words));
    });
    for (const end of ['change', 'blur']) input.addEventListener(end, release);
    field.addEventListener('change', () => {
      remember();
      const now = parsed(field.value);
      if (now && now.unit === begun.unit) input.value = now.number;
      quietly(setKey(key.key, field.value));
    });
    const row = element('div', {class: 'slider'},
                        element('label', {for: id, title: key.key}, parts.length > 1 ? element('small', {}, `${parts.slice(0, -1).join('.')}.`) : null, parts[parts.length - 1]),
                        input, field);
    row.update = (words) => {
      const now = parsed(words);
      field.value = words;
      if (now && now.unit === begun.unit) input.value = now.number;
    };
    row.key = key.key;
    return row;
  }

  function fillSliders() {
    const free = offered.free, keys = offered.keys.filter(({key}) => free.length === 0 || free.includes(key));
    sliders.replaceChildren(...keys.map(slider).filter(Boolean));
    if (sliders.children.length === 0) sliders.append(element('p', {class: 'fine'}, 'The scenario has no numbers to slide: change its text.'));
  }

  // --- Text ---------------------------------------------------------------------------------

  const editor = element('textarea', {class: 'editor', spellcheck: 'false', 'aria-label': 'The scenario, YAML', rows: '16'});
  editor.value = yaml;
  const editing = element('details', {class: 'card'}, element('summary', {}, element('h3', {}, 'Text')), editor);
  let typing = 0;
  editor.addEventListener('input', () => {
    clearTimeout(typing);
    typing = setTimeout(() => {
      remember();
      base = editor.value;
      set = new Map();
      quietly(run({keys: true}));
    }, 300);
  });
  function goToLine(line) {
    editing.open = true;
    const lines = editor.value.split('\n'), from = lines.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
    editor.focus();
    editor.setSelectionRange(from, from + (lines[line - 1] || '').length);
  }

  // --- Numbers ------------------------------------------------------------------------------

  const numbers = element('table', {class: 'measures'}), exercise = element('ol', {class: 'tasks'});
  const poles = element('figure', {class: 'live-poles'});
  function showNumbers(judged) {
    numbers.replaceChildren(element('tbody', {}, ...Object.entries(measures).map(([key, {value, unit}]) => {
      const shown = text.shownIn(unit, Math.abs(value));
      return element('tr', {}, element('th', {scope: 'row'}, key.replaceAll('_', ' ')), element('td', {}, `${text.number(value * shown.factor, 4)} ${shown.unit}`.trim()));
    })));
    exercise.replaceChildren(...(judged || offered.tasks).map(({text: words, expect, holds}) => element(
        'li', {class: holds ? 'holds' : 'open'}, element('b', {}, judged ? (holds ? '✓ ' : '✗ ') : ''), words, element('small', {}, ` ${expect}`))));
    poles.replaceChildren(...(lead.poles && lead.poles.values.length > 0
        ? [bbsim.drawPoles(lead.poles), element('figcaption', {}, lead.poles.period === null ? 'Poles: stable left of the line, 1/s' : 'Poles of a period: stable within the circle')] : []));
  }

  // --- The viewer's controller --------------------------------------------------------------

  const control = (script) => {
    remember();
    engine.control(script);
    controlled = script !== '';
    return run();
  };
  const controller = bbsim.makeControllerCard((script) => quietly(control(script)));

  // --- Buttons ------------------------------------------------------------------------------

  const button = (words, title, action) => element('button', {type: 'button', title, onclick: action}, words);
  const undoing = button('Undo', 'Take back the last change', undo);
  const back = button('Back to the file', 'Undo all changes', reset);
  const pin = element('button', {type: 'button', title: 'Keep the pale curves as they are', 'aria-pressed': 'false', onclick: () => {
    pinned = !pinned;
    pin.setAttribute('aria-pressed', String(pinned));
    if (pinned) data.before = data.copyOf(lead);
  }}, 'Pin');
  const download = button('YAML', 'Save the scenario with its changes', () => bbsim.save.offer(
      new Blob([yaml], {type: 'application/yaml'}), bbsim.save.fileName(name, '.yaml')));
  function showButtons() {
    undoing.disabled = history.length === 0;
  }

  // --- Links --------------------------------------------------------------------------------

  // The changes, as a part of the page's address.
  const fragment = () => (set.size > 0 && base === original.text ? `set=${encodeURIComponent(JSON.stringify([...set]))}` : '');
  // The changes of a link are shown before they are applied.
  function offerLink() {
    const found = /(?:^|[#&])set=([^&]*)/.exec(location.hash);
    if (!found) return null;
    let wanted;
    try {
      wanted = JSON.parse(decodeURIComponent(found[1]));
    } catch {
      return null;
    }
    const valid = Array.isArray(wanted) && wanted.length > 0 && wanted.length <= 100 &&
        wanted.every((one) => Array.isArray(one) && one.length === 2 && one.every((words) => typeof words === 'string' && words.length <= 1000));
    if (!valid) return null;
    const box = element('div', {class: 'offer', role: 'group', 'aria-label': 'Changes of this link'},
                        element('p', {}, 'This link changes the scenario:'),
                        element('ul', {}, ...wanted.map(([key, value]) => element('li', {}, element('code', {}, `${key} = ${value}`)))),
                        element('p', {class: 'buttons'}, button('Apply', 'Make these changes', () => {
                          box.remove();
                          remember();
                          set = new Map([...set, ...wanted]);
                          quietly(run({keys: true}));
                        }), button('Ignore', 'Keep the file as it is', () => box.remove())));
    return box;
  }

  fillSliders();
  showNumbers(null);
  showButtons();
  container.append(element('div', {class: 'live-head'}, element('h2', {}, 'Change it'), status, stop), ...[offerLink()].filter(Boolean),
                   element('p', {class: 'buttons'}, undoing, back, pin, download), faults, exercise, sliders, element('div', {class: 'live-numbers'}, numbers, poles), controller, editing);
  // The engine starts at the first touch.
  for (const touch of ['pointerenter', 'focusin', 'pointerdown']) container.addEventListener(touch, () => engine.start(), {once: true});

  // The columns of the page's own run, before the engine has run.
  const pageColumns = () => Object.fromEntries([['t', lead.t], ...[...lead.columns].map(([key, {values}]) => [key, Float64Array.from(values)])]);
  bbsim.live = {
    // Sets a key: a number in SI units, or a text such as "2 cm". Fulfilled when the run is drawn.
    set(key, value) {
      remember();
      const drawn = setKey(key, value);
      for (const row of sliders.children) if (row.key === key) row.update(set.get(key));
      return drawn;
    },
    get columns() { return columns || pageColumns(); },
    get yaml() { return yaml; },
    get measures() { return Object.fromEntries(Object.entries(measures).map(([key, {value}]) => [key, value])); },
    get tasks() { return [...tasks]; },
    // Replaces the whole text. Fulfilled when the run is drawn.
    edit(words) {
      remember();
      base = editor.value = words;
      set = new Map();
      return run({keys: true});
    },
    // Lets a script with step(sample) control the gimbal; '' for the scenario's law.
    control,
    undo, reset, fragment,
  };
};
