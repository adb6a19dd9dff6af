// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Draws the first picture; reading.js then adds the rest.
(() => {
  const {data, clock, palette, text} = bbsim;
  const {scene, runs} = data;
  const get = (id) => document.getElementById(id);
  const hasRuns = runs.length > 0;

  function entitle() {
    document.title = text.visible(scene.title || 'bbsim replay');
    get('title').textContent = document.title;
  }
  entitle();
  get('made-by').textContent = text.visible(`Made by bbsim ${scene.version}. It holds all that it shows.`);
  get('help').addEventListener('click', () => get('keys').showModal());
  get('licences').addEventListener('click', () => get('licence-texts').showModal());
  const toggleTheme = () => palette.choose(palette.isDark() ? 'light' : 'dark');
  get('theme').addEventListener('click', toggleTheme);

  const statusSigns = {done: '●', stopped: '■', failed: '▲', interrupted: '❚❚'};
  function describe(run) {
    if (!run.status) return text.element('span', {}, run.name);
    const until = run.status === 'done' ? '' : ` at ${text.number(run.reached, 6)} s${run.end > 0 ? ` of ${text.number(run.end)} s` : ''}`;
    return text.element('span', {title: text.visible(run.reason)}, `${run.name}  `,
                        text.element('b', {class: `status ${run.status}`}, `${statusSigns[run.status] || '○'} ${run.status}${until}`));
  }

  // Reports the error itself, instead of blaming a browser without 3D graphics.
  let picture = null;
  function makePicture() {
    try {
      picture = bbsim.makePicture(get('canvas'), () => hint('Ctrl and the wheel zoom, or click the picture first.'));
    } catch (error) {
      const probe = document.createElement('canvas');
      const has = ['webgl', 'experimental-webgl'].some((kind) => probe.getContext(kind));
      get('trouble').textContent = text.visible(has ? `The picture is drawn flat, because drawing in three dimensions failed: ${error.message}.`
          : 'This browser gives the page no 3D graphics (WebGL), so the picture is drawn flat.');
      get('trouble').hidden = false;
    }
  }

  let hinting = 0;
  function hint(words) {
    get('hint').textContent = words;
    get('hint').hidden = false;
    clearTimeout(hinting);
    hinting = setTimeout(() => { get('hint').hidden = true; }, Math.max(2500, 50 * words.length));
  }
  bbsim.hint = hint;

  bbsim.ready = new Promise((resolve, reject) => { Object.assign(bbsim, {isReady: resolve, isNot: reject}); });
  if (!hasRuns) {
    get('sweeps').hidden = false;
    document.querySelectorAll('.for-runs').forEach((part) => { part.hidden = true; });
    bbsim.seek = () => {};
    bbsim.ballOnScreen = () => null;
    palette.onChange(() => {});
    bbsim.address.apply(null, null);
    return;
  }

  get('replay').hidden = false;
  makePicture();
  const screen = bbsim.makeScreen(picture, () => bbsim.makeFlat(get('flat-canvas')),
      (rate) => hint(`This browser draws only ${rate} pictures a second in three dimensions, so the picture is flat now. Choose a view to bring it back.`));
  bbsim.screen = screen;
  bbsim.picture = picture;

  // Factors for the plate's angles in the picture, as far as it stays within 45 degrees.
  let factors = [1];
  function findFactors() {
    const angles = runs.flatMap((run) => ['phi', 'theta'].map((name) => run.columns.get(name)));
    const largest = Math.max(0, ...angles.map((column) => (column ? column.size : 0)));
    factors = [1, 2, 5, 10, 20, 50].filter((factor) => factor === 1 || factor * largest <= Math.PI / 4);
    get('exaggeration').max = factors.length - 1;
  }
  function setFactor(value) {
    const nearest = factors.reduce((best, f) => (Math.abs(f - value) < Math.abs(best - value) ? f : best));
    if (picture) picture.exaggerate(nearest);
    get('exaggeration').value = factors.indexOf(nearest);
    get('exaggeration').setAttribute('aria-valuetext', `${nearest} times`);
    get('factor').textContent = `×${nearest}`;
    showFactor();
    if (later) later();
  }
  // The flat picture shows no tilt.
  function showFactor() {
    const factor = picture && !screen.isFlat ? picture.factor : 1;
    get('exaggerated').textContent = `Tilt drawn ×${factor}`;
    get('exaggerated').hidden = factor === 1;
    document.querySelector('.tilt').hidden = screen.isFlat;
  }
  let later = null;
  get('exaggeration').addEventListener('input', () => setFactor(factors[get('exaggeration').value]));

  const transport = bbsim.makeTransport();
  bbsim.transport = transport;

  const say = (words) => { get('said').textContent = words; };
  function goTo(name) {
    screen.setFlat(name === 'flat');
    if (name === 'flat' || !picture) return;
    screen.choose();
    picture.eyes.go(name);
  }
  const views = [...document.querySelectorAll('[data-view]')];
  const mark = () => {
    showFactor();
    for (const button of views) {
      const {view} = button.dataset;
      button.hidden = !picture && view !== 'flat';
      button.setAttribute('aria-pressed', String(view === 'flat' ? screen.isFlat : !screen.isFlat && view === picture.eyes.view && !picture.eyes.touched));
    }
  };
  for (const button of views) button.addEventListener('click', () => goTo(button.dataset.view));
  screen.onChange(mark);
  if (picture) picture.eyes.onChange(mark);

  const chip = (name, words, sign) => {
    const button = text.element('button', {type: 'button', class: 'chip', 'aria-pressed': String(bbsim.visible[name])},
                                text.element('span', {class: `sign ${sign}`, 'aria-hidden': 'true'}), words);
    button.addEventListener('click', () => {
      const on = button.getAttribute('aria-pressed') !== 'true';
      button.setAttribute('aria-pressed', String(on));
      screen.show(name, on);
    });
    get('shown').append(button);
  };
  const scale = text.element('p', {class: 'scale'});
  get('screen').append(scale);
  // What depends on the runs.
  function renew() {
    const [lead] = runs;
    get('subtitle').replaceChildren(describe(lead));
    findFactors();
    const chips = [['trail', 'line', true], ['reference', 'dashed', lead.path.length > 0 || lead.hasReference], ['sensor', 'cross', lead.isMeasured],
                   ['events', 'diamond', lead.events.length > 0], ['axes', 'axes', true], ['gimbal', 'frame', picture !== null], ['arrows', 'line', picture !== null]].filter(([, , has]) => has);
    // The same chips stay, with their focus.
    const names = chips.map(([name]) => name).join();
    if (names !== get('shown').dataset.names) {
      get('shown').dataset.names = names;
      get('shown').replaceChildren();
      for (const [name, sign] of chips) chip(name, name, sign);
    }
    const spacing = bbsim.gimbal.gridSpacing(), shown = text.shownIn(lead.unitsKnown ? 'm' : '', spacing);
    const grid = `grid ${text.number(spacing * shown.factor)} ${shown.unit}`.trim();
    get('canvas').setAttribute('aria-label', text.visible(
        `${scene.title}: a ball on a plate in a gimbal, seen in three dimensions: ${grid}.` +
        (scene.stage.plateGiven ? '' : ' The scene has no plate: the one drawn is large enough for the path.')));
    get('flat-canvas').setAttribute('aria-label', text.visible(`${scene.title}: a ball on a plate, seen from above: ${grid}.`));
    scale.textContent = `${grid}${scene.stage.plateGiven ? '' : ' · plate drawn to fit the path'}${lead.ball.given ? '' : ' · ball of no known size'}` +
        `${lead.turns ? '' : ' · how the ball turns is not known'}`;
    get('save-csv').title = `Save the numbers of this page as CSV (S): ${lead.t.length - (lead.hasEndRow ? 1 : 0)} of ${lead.rows} rows, seven digits`;
  }
  renew();
  data.onChange(() => {
    entitle();
    const factor = picture ? picture.factor : 1;
    renew();
    if (!factors.includes(factor)) setFactor(factor);
    clock.reset();
  });
  if (picture) picture.recolour();
  screen.setFlat(false);
  setFactor(1);
  if (picture) picture.eyes.refit();
  screen.resize();
  mark();
  new ResizeObserver(screen.resize).observe(get('screen'));
  window.addEventListener('resize', screen.resize);

  bbsim.address.apply(screen, {setFactor});
  later = bbsim.address.keep(screen, {setFactor});
  bbsim.addressLater = later;

  const csv = () => bbsim.save.csv(runs[0]), png = () => bbsim.save.png(screen.shown, transport.timeText);
  get('save-csv').addEventListener('click', csv);
  get('save-png').addEventListener('click', png);
  bbsim.makeKeys({
    say, csv, png,
    view: goTo,
    theme: toggleTheme,
    exaggerate() {
      if (screen.isFlat) return;
      setFactor(factors[(factors.indexOf(picture.factor) + 1) % factors.length]);
      say(`tilt drawn ${picture.factor} times`);
    },
  });

  bbsim.seek = clock.seek;
  bbsim.ballOnScreen = () => screen.shown.ballOnScreen();
  bbsim.view = () => picture && picture.view();
  if (!screen.isFlat) {
    picture.drawn();
    bbsim.firstPicture = performance.now();  // ms since the page was requested
  }
})();
