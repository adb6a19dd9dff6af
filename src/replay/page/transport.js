// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The plate's true tilt at a time, without exaggeration: its angle, and the downhill direction in
// the plate's frame. Null if the run does not give both angles; on a beam the other angle is zero.
bbsim.tilt = (run, t) => {
  const phi = run.angleAt(t, 'phi'), theta = run.angleAt(t, 'theta');
  if (!Number.isFinite(phi) || !Number.isFinite(theta)) return null;
  const {skew, yaw, baseTilt} = run.mounting;
  // Turns the vertical back into the plate's frame, link by link.
  let [x, y, z] = [0, Math.sin(baseTilt), Math.cos(baseTilt)];
  const turn = (a, b, angle) => [a * Math.cos(angle) + b * Math.sin(angle), b * Math.cos(angle) - a * Math.sin(angle)];
  [z, x] = turn(z, x, phi);
  [x, y] = turn(x, y, skew);
  [y, z] = turn(y, z, theta);
  [x, y] = turn(x, y, yaw - skew);
  return {angle: Math.atan2(Math.hypot(x, y), z), x: -x, y: -y};
};

// The buttons below the picture, the scrubber with its events, and the level in the picture's
// corner.
bbsim.makeTransport = () => {
  const {clock, text, data} = bbsim;
  const [lead] = data.runs;
  let {start, end} = data;
  const get = (id) => document.getElementById(id);
  const scrub = get('scrub'), time = get('time'), play = get('play'), speed = get('speed'), loop = get('loop');
  let decimals, early, endText, scale;  // set by renew()
  const steps = Number(scrub.max);

  const timeText = (t) => t.toFixed(decimals).replace('-', '−');
  // A run that ended between two rows shows its end time, to six digits.
  const isOver = (t) => early && t >= lead.last - 1e-9 * Math.max(1, Math.abs(lead.last));
  const shownTime = (t) => (isOver(t) && t === end ? endText : timeText(t));
  const put = (node, words) => { if (node.textContent !== words) node.textContent = words; };
  const of = document.createTextNode('');
  time.append(text.element('b', {}), of);

  function showTime(t) {
    scrub.value = end > start ? Math.round((t - start) / (end - start) * steps) : 0;
    scrub.style.setProperty('--done', `${end > start ? 100 * (t - start) / (end - start) : 0}%`);
    scrub.setAttribute('aria-valuetext', `${shownTime(t)} s of ${endText} s`);
    put(time.firstChild, shownTime(t));
    showLevel(t);
    showMissing(t);
    get('ended').hidden = !isOver(t);
  }

  // Reports parts of the picture that do not show recorded values.
  function showMissing(t) {
    const words = [], place = lead.placeAt(t);
    if (place === 'beyond') words.push(`The ball is ${far(t)}: it is not drawn.`);
    if (place === 'missing') words.push('The ball\'s position is not recorded here: the ball stays where it was.');
    if (bbsim.tilt(lead, t) === null) {
      words.push(lead.hasAngles ? 'The tilt is not recorded here: the plate is drawn level.' : 'No tilt was recorded: the plate is drawn level.');
    }
    put(get('missing'), words.join(' '));
    get('missing').hidden = words.length === 0;
  }

  const unit = lead.unitsKnown ? ' m' : '';
  function far(t) {
    const row = lead.nearest(t), size = Math.max(Math.abs(lead.values('x')[row]), Math.abs(lead.values('y')[row]));
    return size === Infinity ? 'farther away than the page has numbers for' : `${text.number(size)}${unit} away`;
  }

  function showState() {
    play.setAttribute('aria-label', clock.playing ? 'Pause' : 'Play');
    get('play-sign').setAttribute('d', clock.playing ? 'M5 3h4v14H5zM11 3h4v14h-4z' : 'M5 3l12 7-12 7z');
    speed.value = String(clock.speed);
    loop.setAttribute('aria-pressed', String(clock.loop));
  }

  // The full scale of the level: the first of these that holds the run's largest tilt.
  function scaleOfLevel() {
    const largest = Math.hypot(...['phi', 'theta'].map((name) => (lead.columns.get(name) || {size: 0}).size));
    const degrees = text.degrees * (Math.min(largest, Math.PI) + Math.abs(lead.mounting.baseTilt));
    return [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 45, 90, 180].find((s) => degrees <= s) || 180;
  }
  get('level').title = 'Tilt of the plate: the dot shows downhill, in the plate\'s own axes';

  let lastTilt;
  function showLevel(t) {
    const tilt = bbsim.tilt(lead, t), same = tilt && lastTilt && ['angle', 'x', 'y'].every((name) => tilt[name] === lastTilt[name]);
    if (same || (tilt === null && lastTilt === null)) return;
    lastTilt = tilt;
    get('level').classList.toggle('missing', tilt === null);
    get('level-bubble').setAttribute('visibility', tilt ? 'visible' : 'hidden');
    get('level-unknown').setAttribute('visibility', tilt ? 'hidden' : 'visible');
    get('level-scale').textContent = tilt ? `of ${scale}°` : 'not known';
    if (tilt === null) {
      get('level-slope').setAttribute('d', '');
      put(get('level-tilt'), '–');
      return;
    }
    const degrees = tilt.angle * text.degrees;
    const far = Math.min(1, degrees / scale) * 46, length = Math.hypot(tilt.x, tilt.y) || 1;
    const x = tilt.x / length * far, y = -tilt.y / length * far;
    get('level-bubble').setAttribute('cx', x.toFixed(2));
    get('level-bubble').setAttribute('cy', y.toFixed(2));
    get('level-slope').setAttribute('d', `M0 0L${x.toFixed(2)} ${y.toFixed(2)}`);
    put(get('level-tilt'), `${text.steady(degrees, scale)}°`);
  }

  scrub.addEventListener('input', () => {
    clock.pause();
    clock.seek(start + scrub.value / steps * (end - start));
  });
  // The page's keys replace those of the slider, and go by rows.
  scrub.addEventListener('keydown', (event) => {
    if (event.key.startsWith('Arrow') || ['Home', 'End', 'PageUp', 'PageDown'].includes(event.key)) event.preventDefault();
  });
  play.addEventListener('click', clock.toggle);
  get('to-start').addEventListener('click', () => clock.seek(start));
  get('back').addEventListener('click', () => clock.step(-1));
  get('forward').addEventListener('click', () => clock.step(1));
  speed.addEventListener('change', () => clock.setSpeed(Number(speed.value)));
  loop.addEventListener('click', () => clock.setLoop(!clock.loop));

  const tickOf = (event) => {
    const part = end > start ? (event.t - start) / (end - start) : 0;
    return text.element('button', {
      type: 'button', class: `tick ${event.action === 'stop' ? 'stop' : 'note'}`, style: `left: ${100 * part}%`, tabindex: '-1',
      title: text.visible(`${event.name} at ${event.t.toFixed(decimals + 1)} s`), onclick: () => clock.seek(event.t),
      'aria-label': text.visible(`To ${event.name} at ${event.t.toFixed(decimals + 1)} s`),
    });
  };

  // What depends on the run, not on the time.
  function renew() {
    ({start, end} = data);
    decimals = text.decimalsOfTime(lead.t.length > 1 ? (lead.last - lead.start) / (lead.t.length - 1) : 0.1);
    early = lead.status && lead.status !== 'done';
    endText = early && end === lead.last && timeText(lead.reached) * 1 !== lead.reached ? text.number(lead.reached, 6) : timeText(end);
    of.textContent = ` / ${endText} s`;
    scale = scaleOfLevel();
    lastTilt = undefined;
    get('ticks').replaceChildren(...lead.events.slice(0, 300).map(tickOf));
    const [why] = (lead.reason || '').split('\n');
    get('ended').textContent = text.visible(why ? why[0].toUpperCase() + why.slice(1) : `The run ended here: ${lead.status}`);
  }
  renew();
  data.onChange(renew);
  clock.onTimeRelaxed(showTime);
  clock.onState(showState);
  showTime(clock.now);
  showState();
  return {timeText, shownTime};
};
