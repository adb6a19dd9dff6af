'use strict';
// Puts the first picture on the screen, then lets the rest follow: see reading.js.
(() => {
  const {data, clock, palette, text} = bbsim;
  const {scene, runs} = data;
  const get = (id) => document.getElementById(id);
  const hasRuns = runs.length > 0;

  document.title = text.visible(scene.title || 'bbsim replay');
  get('title').textContent = text.visible(scene.title || 'bbsim replay');
  get('made-by').textContent = text.visible(`Made by bbsim ${scene.version}. It holds all that it shows.`);
  get('help').addEventListener('click', () => get('keys').showModal());
  get('licences').addEventListener('click', () => get('licence-texts').showModal());
  const toggleTheme = () => palette.choose(palette.isDark() ? 'light' : 'dark');
  get('theme').addEventListener('click', toggleTheme);

  const statusSigns = {done: '●', stopped: '■', failed: '▲', interrupted: '❚❚'};
  function describe(run) {
    if (!run.status) return text.element('span', {}, run.name);
    const until = run.status === 'done' ? '' : ` at ${text.number(run.last)} s${run.end > 0 ? ` of ${text.number(run.end)} s` : ''}`;
    return text.element('span', {title: text.visible(run.reason)}, `${run.name}  `,
                        text.element('b', {class: `status ${run.status}`}, `${statusSigns[run.status] || '○'} ${run.status}${until}`));
  }

  let picture = null, transport = null;
  function makePicture() {
    try {
      picture = bbsim.makePicture(get('canvas'));
    } catch (error) {
      // No WebGL: the plots and all else are there still.
      get('trouble').textContent = 'This browser gives the page no 3D graphics (WebGL), so the picture stays away: ' + error.message;
      get('trouble').hidden = false;
      get('picture').hidden = true;
      document.querySelectorAll('.shown, #save-png').forEach((part) => { part.hidden = true; });
    }
  }

  bbsim.ready = new Promise((resolve, reject) => { Object.assign(bbsim, {isReady: resolve, isNot: reject}); });
  if (!hasRuns) {
    get('sweeps').hidden = false;
    document.querySelectorAll('.for-runs').forEach((part) => { part.hidden = true; });
    bbsim.seek = () => {};
    bbsim.ballOnScreen = () => null;
    palette.onChange(() => {});
    bbsim.address.apply(null);
    return;
  }

  get('replay').hidden = false;
  get('subtitle').append(describe(runs[0]));
  makePicture();

  // 1, 2, 5, ...: what the plate's angles are multiplied by in the picture.
  const factors = [1, 2, 5, 10, 20, 50];
  function setFactor(value) {
    const nearest = factors.reduce((best, f) => (Math.abs(f - value) < Math.abs(best - value) ? f : best));
    if (picture) picture.exaggerate(nearest);
    get('exaggeration').value = factors.indexOf(nearest);
    get('exaggeration').setAttribute('aria-valuetext', `${nearest} times`);
    get('factor').textContent = `×${nearest}`;
    get('exaggerated').textContent = `Tilt drawn ×${nearest}`;
    get('exaggerated').hidden = nearest === 1;
    if (later) later();
  }
  let later = null;
  get('exaggeration').addEventListener('input', () => setFactor(factors[get('exaggeration').value]));
  setFactor(1);

  transport = bbsim.makeTransport(picture);
  bbsim.picture = picture;
  bbsim.transport = transport;

  function say(words) {
    get('said').textContent = words;
  }

  if (picture) {
    const views = [...document.querySelectorAll('[data-view]')];
    const mark = () => views.forEach((button) => {
      button.setAttribute('aria-pressed', String(button.dataset.view === picture.eyes.view && !picture.eyes.touched));
    });
    for (const button of views) button.addEventListener('click', () => picture.eyes.go(button.dataset.view));
    picture.eyes.onChange(mark);
    mark();

    const chip = (name, words, sign) => {
      const button = text.element('button', {type: 'button', class: 'chip', 'aria-pressed': 'true'},
                                  text.element('span', {class: `sign ${sign}`, 'aria-hidden': 'true'}), words);
      button.addEventListener('click', () => {
        const on = button.getAttribute('aria-pressed') !== 'true';
        button.setAttribute('aria-pressed', String(on));
        picture.show(name, on);
      });
      get('shown').append(button);
    };
    chip('trail', 'trail', 'line');
    if (picture.hasPath || picture.target.visible) chip('reference', 'reference', 'dashed');
    if (runs[0].isMeasured) chip('sensor', 'sensor', 'cross');
    if (runs[0].events.length > 0) chip('events', 'events', 'diamond');
    chip('axes', 'axes', 'axes');
    chip('gimbal', 'gimbal', 'frame');
    const spacing = bbsim.gimbal.gridSpacing(), shown = text.shownIn('m', spacing);
    get('canvas').setAttribute('aria-label', text.visible(
        `${scene.title}: a ball on a plate in a gimbal, seen in three dimensions. Grid lines are ` +
        `${text.number(spacing * shown.factor)} ${shown.unit} apart.` +
        (scene.stage.plateGiven ? '' : ' The scene has no plate: one is drawn that the path fits on.')));
    get('picture').append(text.element('p', {class: 'scale'},
        `grid ${text.number(spacing * shown.factor)} ${shown.unit}${scene.stage.plateGiven ? '' : ' · plate drawn to fit the path'}` +
        `${runs[0].ball.given ? '' : ' · ball of no known size'}`));
    picture.recolour();
    picture.resize();
    new ResizeObserver(picture.resize).observe(get('picture'));
    window.addEventListener('resize', picture.resize);
  }

  bbsim.address.apply(picture, setFactor);
  later = bbsim.address.keep(picture, setFactor);

  const speeds = [...get('speed').options].map((option) => Number(option.value));
  get('save-csv').addEventListener('click', () => bbsim.save.csv(runs[0]));
  get('save-csv').title = `Save the numbers of this page as CSV (S): ${runs[0].t.length} of ${runs[0].rows} rows, seven digits`;
  if (picture) get('save-png').addEventListener('click', () => bbsim.save.png(picture, transport.timeText));
  bbsim.makeKeys({
    toggle: clock.toggle,
    step: clock.step,
    seekBy: (seconds) => clock.seek(clock.now + seconds),
    toStart: () => clock.seek(data.start),
    toEnd: () => clock.seek(data.end),
    faster(by) {
      const at = speeds.indexOf(clock.speed) + by;
      clock.setSpeed(speeds[Math.min(Math.max(at, 0), speeds.length - 1)]);
      say(`speed ${get('speed').selectedOptions[0].textContent}`);
    },
    loop: () => clock.setLoop(!clock.loop),
    view: (name) => picture && picture.eyes.go(name),
    zoom: (factor) => picture && picture.eyes.zoom(factor),
    turn: (left, up) => picture && picture.eyes.turn(left, up),
    exaggerate() {
      if (!picture) return;
      setFactor(factors[(factors.indexOf(picture.factor) + 1) % factors.length]);
      say(`tilt drawn ${picture.factor} times`);
    },
    theme: toggleTheme,
    png: () => picture && bbsim.save.png(picture, transport.timeText),
    csv: () => bbsim.save.csv(runs[0]),
  });

  bbsim.seek = clock.seek;
  bbsim.ballOnScreen = () => picture && picture.ballOnScreen();
  bbsim.view = () => picture && picture.view();
  if (picture) {
    picture.drawn();
    bbsim.firstPicture = performance.now();  // ms from when the page was asked for
  }
})();
