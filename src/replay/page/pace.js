// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Where pictures come slowly while time goes on, all but the picture follows a few times a second, since what a browser
// puts together anew is all between what has changed; the picture has fewer pixels; and if that is not enough it is flat.
// A time that stands still is drawn with all pixels. Who chooses a view keeps it.
bbsim.makePace = (screen, tell) => {
  const {clock} = bbsim;
  const slow = 1000 / 24, tooSlow = 1000 / 15, several = 6;  // ms a picture; so many are looked at
  let last = null, spans = [], coarse = false, chosen = false;

  function judge() {
    const middle = spans.sort((a, b) => a - b)[several >> 1];
    spans = [];
    if (middle <= slow) return;
    clock.relax(100);
    if (screen.isFlat) return;
    if (!coarse) {
      coarse = true;
      screen.solid.setPixels(0.5);
    } else if (!chosen && middle > tooSlow) {
      screen.setFlat(true);
      tell(Math.round(1000 / middle));
    }
  }

  clock.onTime(() => {
    if (!clock.playing) return;
    const now = performance.now();
    if (last !== null) spans.push(now - last);
    last = now;
    if (spans.length >= several) judge();
  });
  clock.onState(() => {
    last = null;
    spans = [];
    if (screen.solid) screen.solid.setPixels(clock.playing && coarse ? 0.5 : 1);
  });
  return {
    // A view in three dimensions was asked for.
    choose() { chosen = true; },
    get coarse() { return coarse; },
  };
};
