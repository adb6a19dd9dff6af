// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The time that picture, plots and scrubber show, and its progress.
bbsim.makeClock = (data) => {
  const {runs} = data;
  let {start, end} = data;
  const listeners = [], stateListeners = [], relaxed = [];
  let span = 0, due = 0;  // ms between calls of the relaxed listeners while time runs
  let now = start, playing = false, speed = 1, loop = false, last = null;

  function notify() {
    for (const listener of listeners) listener(now);
    const time = performance.now();
    if (playing && time < due) return;
    due = time + span;
    for (const listener of relaxed) listener(now);
  }
  const tellState = () => {
    if (!playing) for (const listener of relaxed) listener(now);
    for (const listener of stateListeners) listener();
  };

  function frame(time) {
    if (!playing) return;
    // The first frame only sets the reference time.
    const next = now + (last === null ? 0 : (time - last) / 1000 * speed);
    last = time;
    if (next >= end) {
      if (loop && end > start) {
        now = start + (next - start) % (end - start);
      } else {
        now = end;
        playing = false;
        tellState();
      }
    } else {
      now = next;
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
      now = Math.min(Math.max(t, start), end);
      notify();
    },
    play() {
      if (playing || end <= start) return;
      if (now >= end) now = start;
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
      const [run] = runs;
      clock.pause();
      const row = run.row(now), onRow = Math.abs(run.t[row] - now) < 1e-12 * Math.max(1, Math.abs(now));
      const next = rows > 0 ? row + rows : row + rows + (onRow ? 0 : 1);
      clock.seek(run.t[Math.min(Math.max(next, 0), run.t.length - 1)]);
    },
    onTime: (listener) => listeners.push(listener),
    // For listeners that need not follow every frame if frames are slow.
    onTimeRelaxed: (listener) => relaxed.push(listener),
    relax(least) { span = least; },
    // The runs have changed: stays at the time, as far as they have it.
    reset() {
      ({start, end} = data);
      clock.seek(now);
    },
    onState: (listener) => stateListeners.push(listener),
  };
  return clock;
};
bbsim.clock = bbsim.makeClock(bbsim.data);
