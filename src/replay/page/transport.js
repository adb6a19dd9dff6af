'use strict';
// The buttons under the picture, the scrubber with what happened on it, and the level in the picture's corner.
bbsim.makeTransport = (picture) => {
  const {clock, text, data} = bbsim;
  const {start, end, runs} = data;
  const lead = runs[0];
  const get = (id) => document.getElementById(id);
  const scrub = get('scrub'), time = get('time'), play = get('play'), speed = get('speed'), loop = get('loop');
  const decimals = text.decimalsOfTime(lead.t.length > 1 ? (lead.last - lead.start) / (lead.t.length - 1) : 0.1);
  const steps = Number(scrub.max);

  const timeText = (t) => t.toFixed(decimals).replace('-', '−');

  function showTime(t) {
    scrub.value = end > start ? Math.round((t - start) / (end - start) * steps) : 0;
    scrub.style.setProperty('--done', `${end > start ? 100 * (t - start) / (end - start) : 0}%`);
    scrub.setAttribute('aria-valuetext', `${timeText(t)} s of ${timeText(end)} s`);
    time.replaceChildren(text.element('b', {}, timeText(t)), ` / ${timeText(end)} s`);
    showLevel();
    const over = lead.status && lead.status !== 'done' && t >= lead.last - 1e-9 * Math.max(1, Math.abs(lead.last));
    get('ended').hidden = !over;
  }

  function showState() {
    play.setAttribute('aria-label', clock.playing ? 'Pause' : 'Play');
    get('play-sign').setAttribute('d', clock.playing ? 'M5 3h4v14H5zM11 3h4v14h-4z' : 'M5 3l12 7-12 7z');
    speed.value = String(clock.speed);
    loop.setAttribute('aria-pressed', String(clock.loop));
  }

  // The level's full scale: the first of these that holds the run's largest tilt.
  const scale = (() => {
    const largest = Math.hypot(...['phi', 'theta'].map((name) => (lead.columns.get(name) || {size: 0}).size));
    const degrees = text.degrees * (largest + Math.abs(lead.mounting.baseTilt));
    return [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180].find((s) => degrees <= s) || 180;
  })();
  get('level-scale').textContent = `of ${scale}°`;
  get('level').title = 'Tilt of the plate: the dot is where downhill is, in the plate\'s own axes';

  function showLevel() {
    if (!picture) return;
    const tilt = picture.tilt(), degrees = tilt.angle * text.degrees;
    const far = Math.min(1, degrees / scale) * 46, length = Math.hypot(tilt.x, tilt.y) || 1;
    const x = tilt.x / length * far, y = -tilt.y / length * far;
    get('level-bubble').setAttribute('cx', x.toFixed(2));
    get('level-bubble').setAttribute('cy', y.toFixed(2));
    get('level-slope').setAttribute('d', `M0 0L${x.toFixed(2)} ${y.toFixed(2)}`);
    get('level-tilt').textContent = `${text.steady(degrees, scale)}°`;
  }

  scrub.addEventListener('input', () => {
    clock.pause();
    clock.seek(start + scrub.value / steps * (end - start));
  });
  // The keys of the page do what a slider's own would, by rows.
  scrub.addEventListener('keydown', (event) => {
    if (event.key.startsWith('Arrow') || ['Home', 'End', 'PageUp', 'PageDown'].includes(event.key)) event.preventDefault();
  });
  play.addEventListener('click', clock.toggle);
  get('to-start').addEventListener('click', () => clock.seek(start));
  get('back').addEventListener('click', () => clock.step(-1));
  get('forward').addEventListener('click', () => clock.step(1));
  speed.addEventListener('change', () => clock.setSpeed(Number(speed.value)));
  loop.addEventListener('click', () => clock.setLoop(!clock.loop));

  const ticks = get('ticks');
  for (const event of lead.events.slice(0, 300)) {
    const part = end > start ? (event.t - start) / (end - start) : 0;
    ticks.append(text.element('button', {
      type: 'button', class: `tick ${event.action === 'stop' ? 'stop' : 'note'}`, style: `left: ${100 * part}%`, tabindex: '-1',
      title: text.visible(`${event.name} at ${event.t.toFixed(decimals + 1)} s`), onclick: () => clock.seek(event.t),
      'aria-label': text.visible(`To ${event.name} at ${event.t.toFixed(decimals + 1)} s`),
    }));
  }
  if (lead.status && lead.status !== 'done') {
    const [why] = lead.reason.split('\n');
    get('ended').textContent = text.visible(why ? why[0].toUpperCase() + why.slice(1) : `The run ended here: ${lead.status}`);
  }
  clock.onTime(showTime);
  clock.onState(showState);
  showTime(clock.now);
  showState();
  return {timeText};
};
