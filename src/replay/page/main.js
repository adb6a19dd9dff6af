// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Draws the first picture, and then adds what can wait until it is on the screen.
(() => {
  const {data, clock, palette, text} = bbsim;
  const {element} = text, {scene, runs} = data;
  const get = (id) => document.getElementById(id);
  const hasRuns = runs.length > 0;

  function entitle() {
    document.title = text.visible(scene.title || 'bbsim replay');
    get('title').textContent = document.title;
  }
  entitle();
  get('made-by').textContent = text.visible(`Made by bbsim ${scene.version}. It holds all that it shows.`);
  get('help').addEventListener('click', () => get('keys').showModal());
  const toggleTheme = () => palette.choose(palette.isDark() ? 'light' : 'dark');
  get('theme').addEventListener('click', toggleTheme);

  const statusSigns = {done: '●', stopped: '■', failed: '▲', interrupted: '❚❚'};
  function describe(run) {
    if (!run.status) return element('span', {}, run.name);
    const until = run.status === 'done' ? '' : ` at ${text.number(run.reached, 6)} s${run.end > 0 ? ` of ${text.number(run.end)} s` : ''}`;
    return element('span', {title: text.visible(run.reason)}, `${run.name}  `,
                   element('b', {class: `status ${run.status}`}, `${statusSigns[run.status] || '○'} ${run.status}${until}`));
  }

  // Reports the error itself, instead of blaming a browser without 3D graphics.
  let picture = null;
  function makePicture() {
    try {
      picture = bbsim.makePicture(get('canvas'), () => hint('Ctrl and the wheel zoom, or click the picture first.'));
    } catch (error) {
      const has = document.createElement('canvas').getContext('webgl');
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

  // The list of several runs: their names, their distances from the first run now, and whether they
  // are shown.
  function listRuns(container) {
    const list = element('ul', {class: 'runs'});
    const lines = runs.map((run) => {
      const apart = element('output', {});
      const box = element('input', {type: 'checkbox', checked: true, 'data-run': String(run.index), onchange: () => {
        run.shown = box.checked;
        bbsim.screen.invalidate();
      }});
      const words = run.status && run.status !== 'done' ? ` (${run.status} at ${text.number(run.reached, 6)} s)` : '';
      const item = element('li', {}, element('label', {}, box, bbsim.swatch({pattern: palette.dash(run.index)}), element('span', {}, run.name + words)), apart);
      list.append(item);
      return {run, apart, item};
    });
    const recolour = () => lines.forEach(({run, item}) => item.style.setProperty('--colour', palette.run(run.index)));
    const show = (t) => {
      for (const {run, apart} of lines.slice(1)) {
        const far = t >= run.start && t <= run.last ? Math.hypot(run.at(t, 'x') - runs[0].at(t, 'x'), run.at(t, 'y') - runs[0].at(t, 'y')) : NaN;
        const shown = text.shownIn(run.unitsKnown && runs[0].unitsKnown ? 'm' : '', far < 1 ? 0.1 : far);
        apart.textContent = Number.isFinite(far) ? `${text.steady(far * shown.factor, 100)} ${shown.unit} apart` : 'over';
      }
    };
    lines[0].apart.textContent = 'leads';
    recolour();
    palette.onChange(recolour);
    clock.onTimeRelaxed(show);
    show(clock.now);
    container.append(element('h2', {}, `${runs.length} runs`), list);
    container.hidden = false;
  }

  // The plots, what was run, and sweeps.
  function read() {
    if (runs.length > 1) listRuns(get('runs'));
    if (hasRuns) {
      bbsim.plots = bbsim.makePlots(get('plots'));
      bbsim.details = bbsim.makeDetails(get('details'));
      bbsim.preparePrint();
      if (bbsim.makeLive) bbsim.makeLive(get('live'));
    }
    get('sweeps').hidden = scene.sweeps.length === 0;
    bbsim.sweeps = scene.sweeps.map((sweep) => bbsim.makeSweep(sweep, get('sweeps')));
  }
  const painted = () => new Promise((resolve) => requestAnimationFrame(() => setTimeout(resolve, 0)));
  bbsim.ready = painted().then(read).then(painted);  // one more frame, for parts that wait for it

  if (!hasRuns) {
    const [sweep] = scene.sweeps;
    get('subtitle').textContent = text.visible(scene.sweeps.map(({title}) => title).filter((title) => title && title !== scene.title).join(', '));
    get('save-csv').addEventListener('click', () => bbsim.save.offer(
        new Blob([bbsim.sweeps[0].csv()], {type: 'text/csv'}), bbsim.save.fileName(sweep.name, '-page.csv')));
    document.querySelectorAll('.for-runs').forEach((part) => { part.hidden = true; });
    bbsim.seek = () => {};
    bbsim.ballOnScreen = () => null;
    bbsim.address.apply(null, null);
    return;
  }

  get('replay').hidden = false;
  makePicture();
  const screen = bbsim.makeScreen(picture, () => bbsim.makeFlat(get('flat-canvas')),
      (rate) => hint(`This browser draws only ${rate} pictures a second in three dimensions, so the picture is flat now. Choose a view to bring it back.`));
  Object.assign(bbsim, {screen, picture});

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
    if (bbsim.addressLater) bbsim.addressLater();
  }
  // The flat picture shows no tilt.
  function showFactor() {
    const factor = picture && !screen.isFlat ? picture.factor : 1;
    get('exaggerated').textContent = `Tilt drawn ×${factor}`;
    get('exaggerated').hidden = factor === 1;
    document.querySelector('.tilt').hidden = screen.isFlat;
  }
  get('exaggeration').addEventListener('input', () => setFactor(factors[get('exaggeration').value]));

  const transport = bbsim.transport = bbsim.makeTransport();

  const say = (words) => { get('said').textContent = words; };
  function goTo(name) {
    screen.setFlat(name === 'flat');
    if (name === 'flat' || !picture) return;
    screen.choose();
    picture.eyes.go(name);
  }
  const views = Object.entries(bbsim.views).map(([view, [words, from]], i) =>
      element('button', {'data-view': view, title: `${from} (${i + 1})`, onclick: () => goTo(view)}, words));
  get('views').append(...views);
  const mark = () => {
    showFactor();
    for (const button of views) {
      const {view} = button.dataset;
      button.hidden = !picture && view !== 'flat';
      button.setAttribute('aria-pressed', String(view === 'flat' ? screen.isFlat : !screen.isFlat && view === picture.eyes.view && !picture.eyes.touched));
    }
  };
  screen.onChange(mark);
  if (picture) picture.eyes.onChange(mark);

  // What can be switched off, with its sign, and whether a run has it.
  const chips = [
    ['trail', 'line', () => true], ['reference', 'dashed', (run) => run.path.length > 0 || run.hasReference],
    ['sensor', 'cross', (run) => run.isMeasured], ['events', 'diamond', (run) => run.events.length > 0],
    ['axes', 'axes', () => true], ['gimbal', 'frame', () => picture !== null], ['arrows', 'line', () => picture !== null],
  ].map(([name, sign, has]) => {
    const button = text.toggle(name, {class: 'chip'}, (on) => screen.show(name, on), bbsim.visible[name]);
    button.prepend(element('span', {class: `sign ${sign}`, 'aria-hidden': 'true'}));
    get('shown').append(button);
    return {button, has};
  });
  const scale = element('p', {class: 'scale'});
  get('screen').append(scale);
  // What depends on the runs.
  function renew() {
    const [lead] = runs;
    get('subtitle').replaceChildren(describe(lead));
    findFactors();
    for (const {button, has} of chips) button.hidden = !has(lead);
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
    clock.seek(clock.now);  // as far as the runs have it
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
  bbsim.addressLater = bbsim.address.keep(screen, {setFactor});

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
})();
