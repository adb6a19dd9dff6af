// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The time that picture, plots and scrubber show, and its progress.
bbsim.makeClock = (data) => {
  const listeners = [], stateListeners = [], relaxed = [];
  let span = 0, due = 0;  // ms between calls of the relaxed listeners while time runs
  let now = data.start, playing = false, speed = 1, loop = false, last = null;

  function notify() {
    for (const listener of listeners) listener(now);
    const time = performance.now();
    if (playing && time < due) return;
    due = time + span;
    for (const listener of relaxed) listener(now);
  }
  function tellState() {
    if (!playing) for (const listener of relaxed) listener(now);
    for (const listener of stateListeners) listener();
  }

  function frame(time) {
    if (!playing) return;
    // The first frame only sets the reference time.
    const {start, end} = data, next = now + (last === null ? 0 : (time - last) / 1000 * speed);
    last = time;
    if (next < end) {
      now = next;
    } else if (loop && end > start) {
      now = start + (next - start) % (end - start);
    } else {
      now = end;
      playing = false;
      tellState();
    }
    notify();
    if (playing) requestAnimationFrame(frame);
  }

  const clock = {
    get now() { return now; },
    get playing() { return playing; },
    get speed() { return speed; },
    get loop() { return loop; },
    seek(t) {
      if (!Number.isFinite(t)) return;
      now = Math.min(Math.max(t, data.start), data.end);
      notify();
    },
    play() {
      if (playing || data.end <= data.start) return;
      if (now >= data.end) now = data.start;
      playing = true;
      last = null;
      tellState();
      requestAnimationFrame(frame);
    },
    pause() {
      if (!playing) return;
      playing = false;
      tellState();
    },
    toggle() {
      if (playing) clock.pause();
      else clock.play();
    },
    setSpeed(value) {
      speed = value;
      tellState();
    },
    setLoop(value) {
      loop = value;
      tellState();
    },
    // Goes to a row of the leading run, forward or back from the current time.
    step(rows) {
      const [run] = data.runs;
      clock.pause();
      const row = run.row(now), onRow = Math.abs(run.t[row] - now) < 1e-12 * Math.max(1, Math.abs(now));
      const next = rows > 0 ? row + rows : row + rows + (onRow ? 0 : 1);
      clock.seek(run.t[Math.min(Math.max(next, 0), run.t.length - 1)]);
    },
    onTime: (listener) => listeners.push(listener),
    // For listeners that need not follow every frame if frames are slow.
    onTimeRelaxed: (listener) => relaxed.push(listener),
    relax(least) { span = least; },
    onState: (listener) => stateListeners.push(listener),
  };
  return clock;
};
bbsim.clock = bbsim.makeClock(bbsim.data);

// What the button that plays and pauses will do.
bbsim.showPlaying = ({playing}) => {
  document.getElementById('play').setAttribute('aria-label', playing ? 'Pause' : 'Play');
  document.getElementById('play-sign').setAttribute('d', playing ? 'M5 3h4v14H5zM11 3h4v14h-4z' : 'M5 3l12 7-12 7z');
};
