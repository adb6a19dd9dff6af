// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A live page: changes its scenario and runs it again. The newest wish wins: while a run computes,
// only the last change waits.
bbsim.makeLive = (container) => {
  const {data, text} = bbsim;
  const {element} = text;
  const [lead] = data.runs;
  const engine = bbsim.makeEngine();
  const name = lead.scenario.file || 'scenario.yaml';
  const keyAndValue = (words) => [words.slice(0, words.indexOf('=')), words.slice(words.indexOf('=') + 1)];

  // What shall run: the text, the keys set in it in their order, the viewer's controller, and the
  // pokes, which are the value of ball.push. States never change; a change makes another one.
  const original = {text: lead.scenario.text, set: lead.scenario.overrides.map(keyAndValue), script: '', pokes: []};
  const same = (a, b) => a.text === b.text && a.script === b.script && JSON.stringify(a.set) === JSON.stringify(b.set);
  let wanted = original, shown = original;  // what shall run, and what has run
  const history = [], broken = new WeakSet();  // states before gestures; states that an error stopped

  // What the page shows of the last run.
  let offered = data.scene.live, yaml = original.text, columns = null;

  // --- Runs ---------------------------------------------------------------------------------

  const status = element('p', {class: 'live-status'});
  const stop = element('button', {hidden: true, onclick: () => {
    for (const {reject} of waiting) reject(new Error('stopped'));
    waiting = [];
    engine.stop('stopped');
  }}, 'Stop');
  const faults = element('ul', {class: 'faults', role: 'alert'});
  let computing = false, waiting = [], keysDue = false, calm = 0;

  const requestOf = (state) => ({text: state.text, name, set: Object.fromEntries(state.set)});
  const ask = (state, more) => engine.ask({...requestOf(state), controlled: state.script !== '', checked: false, keys: false, ...more});

  function showFaults(list) {
    faults.replaceChildren(...list.map(({place, message}) => {
      const line = Number((/:(\d+):\d+$/.exec(place) || [])[1]);
      return element('li', {}, line > 0 ? element('button', {class: 'link', onclick: () => editing.goTo(line)}, `line ${line}`) : null,
                     line > 0 ? `: ${message}` : message);
    }));
  }

  const showError = (error) => showFaults(error.faults || [{place: '', message: error.message}]);

  // Shows the answer to a state in all views.
  function show(state, {answer, arrays}) {
    shown = state;
    yaml = answer.text;
    columns = Object.fromEntries(Object.entries(answer.columns).map(([key, place]) => [key, arrays[place]]));
    const {live, ...scene} = answer.scene, [run] = scene.runs;
    run.scenario.overrides = state.set.map(([key, value]) => `${key}=${value}`);
    // What only a checked run has stays until the next one.
    if (run.check.length === 0) run.check = lead.check;
    data.replace(scene, arrays);
    // Measures of a checked run are unknown until the next one.
    const unknown = Object.fromEntries(Object.entries(offered.measures).map(([key, one]) => [key, {...one, value: null}]));
    offered = {...live, keys: live.keys.length > 0 ? live.keys : offered.keys, measures: {...unknown, ...live.measures}};
    if (live.keys.length > 0) {
      keysDue = false;
      sliders.fill(offered);
    }
    if (state.script !== '' && run.status === 'failed') broken.add(state);
    editing.show(yaml);
    showFaults(answer.warnings.map((message) => ({place: '', message})));
    showNumbers();
    follow(state);
  }

  // Runs what is wanted now. Fulfilled when this, or what replaced it meanwhile, is drawn; rejected if
  // it cannot run.
  function run() {
    return new Promise((resolve, reject) => {
      waiting.push({resolve, reject});
      next();
    });
  }
  async function next() {
    if (computing || waiting.length === 0) return;
    const asked = waiting, state = wanted, begun = performance.now();
    waiting = [];
    computing = true;
    clearTimeout(calm);
    const late = setInterval(() => {
      status.textContent = `computing for ${Math.round((performance.now() - begun) / 1000)} s`;
      stop.hidden = false;
    }, 1000);
    try {
      const result = await ask(state, {keys: keysDue});
      status.textContent = `computed in ${text.number(performance.now() - begun, 3)} ms`;
      show(state, result);
      const drawn = () => { for (const {resolve} of asked) resolve(); };
      if (document.hidden) drawn();  // no frame comes
      else requestAnimationFrame(() => setTimeout(drawn, 0));
      calm = setTimeout(() => describe(state), 500);
    } catch (error) {
      broken.add(state);
      status.textContent = error.message === 'stopped' ? 'stopped' : 'not run';
      if (error.faults) editing.show(state.text);  // whose lines they name
      showError(error);
      for (const {reject} of asked) reject(error);
    } finally {
      clearInterval(late);
      stop.hidden = true;
      computing = false;
      if (bbsim.addressLater) bbsim.addressLater();
      next();
    }
  }
  // At rest, the cards below the plots follow, which takes longer than the run.
  async function describe(state) {
    try {
      const {answer} = await ask(state, {checked: true});
      if (!same(state, wanted)) return;
      Object.assign(lead, {check: answer.scene.runs[0].check, summary: answer.scene.runs[0].summary});
      offered.measures = answer.scene.live.measures;
      showNumbers();
      bbsim.details.fill();
    } catch {
      // The engine was stopped, or another text came meanwhile.
    }
  }

  // --- Changes ------------------------------------------------------------------------------

  let pinned = false;
  const keepRun = () => { if (!pinned) data.before = data.copyOf(lead); };
  // Keeps the state before a gesture, for undo, and its run beside the new one.
  function remember() {
    editing.flush();
    if (history.length === 0 || !same(history[history.length - 1], wanted)) history.push(wanted);
    keepRun();
    showButtons();
  }
  const quietly = (promise) => promise.catch(() => {});  // its fault is on the page

  function change(next) {
    const before = wanted;
    wanted = {...before, ...next};
    if (wanted.text !== before.text) keysDue = true;
    if (wanted.script !== before.script) {
      engine.control(wanted.script);
      controller.show(wanted.script);
    }
    return run();
  }
  // Settings apply in their order, so that the newest comes last.
  const withSet = (set) => [...wanted.set.filter(([key]) => set.every(([other]) => other !== key)), ...set];
  const setKey = (key, value, more = {}) => change({set: withSet([[key, String(value)]]), ...more});
  // Takes several settings from elsewhere than the sliders.
  function setKeys(set) {
    remember();
    keysDue = true;
    quietly(change({set: withSet(set)}));
  }

  function restore(state) {
    keepRun();
    keysDue = true;
    quietly(change(state));
    showButtons();
  }
  function undo() {
    editing.flush();
    const useless = (state) => broken.has(state) || same(state, wanted);
    while (history.length > 0 && useless(history[history.length - 1])) history.pop();
    if (history.length > 0) restore(history.pop());
  }
  function reset() {
    remember();
    restore(original);
  }

  const sliders = bbsim.makeSliders({remember, change: (key, words) => quietly(setKey(key, words)), valueOf: (key) => (wanted.set.find(([other]) => other === key) || [])[1]});
  function edit(words) {
    remember();
    return change({text: words, set: [], pokes: []});
  }
  let known = null;
  const editing = bbsim.makeEditor({yaml, take: (words) => quietly(edit(words)), paths() {
    known = known || engine.ask({paths: true}).then(({answer}) => answer.paths);
    return known.catch(() => (known = null) || []);
  }});
  const control = (script) => {
    remember();
    return change({script});
  };
  const controller = bbsim.makeControllerCard((script) => quietly(control(script)));

  // --- Pokes --------------------------------------------------------------------------------

  // A poke gives a solid ball, which rolls like 7/5 of its mass, the speed that would take it to a
  // point in half a second. The force rises and falls smoothly, so its impulse is half of value times
  // duration (docs/how-to/disturb.md).
  const duration = 0.1;  // s
  function poke([x, y], t = bbsim.clock.now) {
    const mass = (offered.keys.find(({key}) => key === 'ball.mass') || {value: NaN}).value, at = lead.placeAt(t);
    if (!Number.isFinite(mass) || !Array.isArray(at)) {
      const error = new Error('A poke needs ball.mass, and a ball on the plate.');
      showError(error);
      return Promise.reject(error);
    }
    remember();
    const pokes = [...wanted.pokes, {t, force: [x - at[0], y - at[1]].map((far) => 2 * 1.4 * mass * far / 0.5 / duration)}];
    const along = (axis) => pokes.map(({t: start, force}) => `{pulse: {start: ${start}, duration: ${duration}, value: ${force[axis]}}}`).join(', ');
    return setKey('ball.push', `{x: [${along(0)}], y: [${along(1)}]}`, {pokes});
  }

  // --- Many runs ----------------------------------------------------------------------------

  const cases = bbsim.makeCases();
  const ofLaw = (state) => {
    if (state.script !== '') throw new Error('Your controller runs in single runs only: use the scenario\'s law.');
    return requestOf(state);
  };
  const fan = bbsim.makeFan(cases, ofLaw), map = bbsim.makeMap(cases, ofLaw, setKeys);
  const bode = bbsim.makeBode(data.scene.live.loops, async (state) => {
    if (state.script !== '') return {loops: null, arrays: []};
    const {answer, arrays} = await cases.ask({...requestOf(state), loops: true});
    return {loops: answer, arrays};
  });
  function follow(state) {
    bode.follow(state);
    fan.follow(state);
    map.follow(state, offered);
  }

  // --- Numbers ------------------------------------------------------------------------------

  const numbers = element('table', {class: 'measures'}), exercise = element('ol', {class: 'tasks'});
  const poles = element('figure', {class: 'live-poles'});
  const valueOf = ({value}) => (value === null ? NaN : value);
  function showNumbers() {
    const {measures, tasks} = offered;
    numbers.replaceChildren(element('tbody', {}, ...Object.entries(measures).map(([key, one]) => {
      const value = valueOf(one), shown = text.shownIn(one.unit, Math.abs(value));
      return element('tr', {}, element('th', {scope: 'row'}, key.replaceAll('_', ' ')), element('td', {}, Number.isNaN(value) ? '–' : `${text.number(value * shown.factor, 4)} ${shown.unit}`.trim()));
    })));
    exercise.replaceChildren(...tasks.map(({text: words, expect, holds}) => element(
        'li', {class: holds ? 'holds' : 'open'}, element('b', {}, holds ? '✓ ' : '✗ '), words, element('small', {}, ` ${expect}`))));
    poles.replaceChildren(...bbsim.showPoles(lead.poles));
  }

  // --- Buttons ------------------------------------------------------------------------------

  const button = (words, title, action) => element('button', {title, onclick: action}, words);
  const toggle = (words, title, action) => text.toggle(words, {title}, action);
  const undoing = button('Undo', 'Take back the last change', undo);
  const pin = toggle('Pin', 'Keep the pale curves as they are', (on) => {
    pinned = on;
    if (on) data.before = data.copyOf(lead);
  });
  // A finger sees no titles, and perhaps no picture.
  const screen = document.getElementById('screen'), byFinger = matchMedia('(pointer: coarse)').matches;
  const hint = (words) => {
    screen.scrollIntoView({block: 'nearest'});
    bbsim.hint(words);
  };
  const toPoke = `${byFinger ? 'Touch' : 'Click'} the plate: the ball is poked there and then.`;
  const poking = toggle('Poke', toPoke, (on) => on && hint(toPoke));
  screen.addEventListener('pointerdown', (event) => {
    if (poking.getAttribute('aria-pressed') !== 'true' || !(event.target instanceof HTMLCanvasElement)) return;
    event.stopPropagation();
    event.preventDefault();
    const to = bbsim.screen.shown.plateAt(event.clientX, event.clientY);
    if (to) quietly(poke(to));
  }, true);
  // Stays in the order of the keyboard when it does nothing.
  function showButtons() {
    undoing.setAttribute('aria-disabled', String(history.length === 0));
  }

  const hand = bbsim.makeHand(async (piece) => (await engine.ask({...requestOf(wanted), hand: piece})).answer, (error) => {
    showError(error);
    tilting.setAttribute('aria-pressed', 'false');
  });
  const toTilt = `Drag across the picture${byFinger ? '' : ', or press the arrow keys'}: the ball rolls as the plate tilts. Press the button again for the scenario's run.`;
  const tilting = toggle('Tilt by hand', toTilt, (on) => {
    if (on) hint(toTilt);
    return on ? hand.start() : hand.stop();
  });
  const fanning = toggle('100 rigs', 'Show rigs within the tolerances of this one, in the plots', (on) => (on ? fan.show(wanted) : fan.hide()));

  const link = bbsim.makeLink({
    // The changes, if they fit into an address.
    changes: () => (wanted.text === original.text && !same(wanted, original) ? wanted : {set: [], script: ''}),
    apply: setKeys, bring: controller.offer,
  });

  // The sliders stay in sight beside what follows them: plots and numbers.
  const plots = document.getElementById('plots');
  container.append(element('div', {class: 'card'}, element('div', {class: 'live-head'}, element('h2', {}, 'Change it'), status, stop), link.root,
                   element('p', {class: 'buttons'}, undoing, button('Back to the file', 'Undo all changes', reset), pin, poking, tilting, fanning,
                           button('YAML', 'Save the scenario with its changes', () => {
                             editing.flush();
                             bbsim.save.offer(new Blob([bbsim.withController(yaml, wanted.script)], {type: 'application/yaml'}), bbsim.save.fileName(name, '.yaml'));
                           }), fan.status)),
                   faults,
                   element('div', {class: 'tuned'}, element('div', {class: 'card tuning'}, exercise, sliders.root, sliders.meaning), plots, element('div', {class: 'card live-numbers'}, numbers, poles, bode.root)),
                   map.root, controller.root, editing.root);
  sliders.fill(offered);
  showNumbers();
  showButtons();
  map.follow(wanted, offered);
  // The engine starts at the first touch.
  for (const touch of ['pointerenter', 'focusin', 'pointerdown']) container.addEventListener(touch, () => engine.start(), {once: true});

  // The columns of the page's own run, before the engine has run.
  const pageColumns = () => Object.fromEntries([['t', lead.t], ...[...lead.columns].map(([key, {values}]) => [key, Float64Array.from(values)])]);
  // For scripts: docs/how-to/live.md, "From a script".
  bbsim.live = {
    // A value that does not run leaves no trace in the next call.
    set(key, value) {
      remember();
      const drawn = setKey(key, value), tried = wanted;
      sliders.update(key, String(value));
      return drawn.catch((error) => {
        if (wanted === tried) {
          wanted = {...wanted, set: shown.set};
          sliders.fill(offered);
        }
        throw error;
      });
    },
    edit, control, poke, hand, undo, reset, fragment: link.fragment,
    get columns() { return columns || pageColumns(); },
    get yaml() { return yaml; },
    get measures() { return Object.fromEntries(Object.entries(offered.measures).map(([key, one]) => [key, valueOf(one)])); },
    margins: () => bode.margins(),
    get tasks() { return offered.tasks.map(({holds}) => holds); },
    rigs: () => fan.show(wanted),
    map: (x, y, measure, count = 20) => map.show(x, y, measure, count),
  };
};
