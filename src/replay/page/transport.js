// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The plate's true tilt at a time, without exaggeration: its angle, and the downhill direction in
// the plate's frame. Null if the run does not give both angles; on a beam the other angle is zero.
bbsim.tilt = (run, t) => {
  const angles = ['phi', 'theta'].map((name) => run.angleAt(t, name));
  if (!angles.every(Number.isFinite)) return null;
  const links = bbsim.gimbal.linksOf(run);
  links.set(...angles);
  links.base.updateMatrixWorld(true);
  const {x, y, z} = new THREE.Vector3(0, 0, 1).transformDirection(new THREE.Matrix4().getInverse(links.plane.matrixWorld));
  return {angle: Math.atan2(Math.hypot(x, y), z), x: -x, y: -y};
};

// The buttons below the picture, the scrubber with its events, and the level in the picture's
// corner.
bbsim.makeTransport = () => {
  const {clock, text, data} = bbsim;
  const [lead] = data.runs;
  const get = (id) => document.getElementById(id);
  const scrub = get('scrub'), time = get('time'), speed = get('speed'), loop = get('loop');
  let decimals, early, endText, scale;  // set by renew()
  const steps = Number(scrub.max);

  const timeText = (t) => t.toFixed(decimals).replace('-', '−');
  // A run that ended between two rows shows its end time, to six digits.
  const isOver = (t) => early && t >= lead.last - 1e-9 * Math.max(1, Math.abs(lead.last));
  const shownTime = (t) => (isOver(t) && t === data.end ? endText : timeText(t));
  const put = (node, words) => { if (node.textContent !== words) node.textContent = words; };
  const of = document.createTextNode('');
  time.append(text.element('b', {}), of);

  // The part of the time that is over.
  const partOf = (t) => (data.end > data.start ? (t - data.start) / (data.end - data.start) : 0);
  function showTime(t) {
    scrub.value = Math.round(partOf(t) * steps);
    scrub.setAttribute('aria-valuetext', `${shownTime(t)} s of ${endText} s`);
    put(time.firstChild, shownTime(t));
    showLevel(t);
    showMissing(t);
    get('ended').hidden = !isOver(t);
  }

  // Reports parts of the picture that do not show recorded values.
  function showMissing(t) {
    const words = [], place = lead.placeAt(t);
    if (place === 'beyond') words.push('The ball is too far away here: it is not drawn.');
    if (place === 'missing') words.push('The ball\'s position is not recorded here: the ball stays where it was.');
    if (bbsim.tilt(lead, t) === null) {
      words.push(lead.hasAngles ? 'The tilt is not recorded here: the plate is drawn level.' : 'No tilt was recorded: the plate is drawn level.');
    }
    put(get('missing'), words.join(' '));
    get('missing').hidden = words.length === 0;
  }

  function showState() {
    bbsim.showPlaying(clock);
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

  function showLevel(t) {
    const tilt = bbsim.tilt(lead, t);
    get('level').classList.toggle('missing', tilt === null);
    get('level-bubble').setAttribute('visibility', tilt ? 'visible' : 'hidden');
    get('level-unknown').setAttribute('visibility', tilt ? 'hidden' : 'visible');
    put(get('level-scale'), tilt ? `of ${scale}°` : 'not known');
    const degrees = tilt ? tilt.angle * text.degrees : 0, length = tilt && Math.hypot(tilt.x, tilt.y) || 1;
    const [x, y] = [tilt ? tilt.x : 0, tilt ? -tilt.y : 0].map((part) => (part / length * Math.min(1, degrees / scale) * 46).toFixed(2));
    get('level-bubble').setAttribute('transform', `translate(${x} ${y})`);
    get('level-slope').setAttribute('d', `M0 0L${x} ${y}`);
    put(get('level-tilt'), tilt ? `${text.steady(degrees, scale)}°` : '–');
  }

  scrub.addEventListener('input', () => {
    clock.pause();
    clock.seek(data.start + scrub.value / steps * (data.end - data.start));
  });
  // The page's keys replace those of the slider, and go by rows.
  scrub.addEventListener('keydown', (event) => {
    if (event.key.startsWith('Arrow') || ['Home', 'End', 'PageUp', 'PageDown'].includes(event.key)) event.preventDefault();
  });
  get('play').addEventListener('click', clock.toggle);
  get('to-start').addEventListener('click', () => clock.seek(data.start));
  get('back').addEventListener('click', () => clock.step(-1));
  get('forward').addEventListener('click', () => clock.step(1));
  speed.addEventListener('change', () => clock.setSpeed(Number(speed.value)));
  loop.addEventListener('click', () => clock.setLoop(!clock.loop));

  const tickOf = ({t, name, action}) => {
    const title = text.visible(`To ${name} at ${t.toFixed(decimals + 1)} s`);
    return text.element('button', {class: `tick ${action}`, style: `left: ${100 * partOf(t)}%`, tabindex: '-1', title, 'aria-label': title, onclick: () => clock.seek(t)});
  };

  // What depends on the run, not on the time.
  function renew() {
    decimals = text.decimalsOfTime(lead.t.length > 1 ? (lead.last - lead.start) / (lead.t.length - 1) : 0.1);
    early = lead.status && lead.status !== 'done';
    endText = early && data.end === lead.last && timeText(lead.reached) * 1 !== lead.reached ? text.number(lead.reached, 6) : timeText(data.end);
    of.textContent = ` / ${endText} s`;
    scale = scaleOfLevel();
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
  return {timeText};
};
