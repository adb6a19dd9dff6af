// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Adapts the page to slow frames while time runs, in three stages. First, everything but the
// picture follows only a few times a second, because a browser composes everything between changed
// parts again. Then the picture gets fewer pixels. If that does not suffice, it becomes flat. A
// picture at rest has all pixels. A view that the user has chosen stays.
bbsim.makePace = (screen, notify) => {
  const {clock} = bbsim;
  const slow = 1000 / 24, tooSlow = 1000 / 15, several = 6;  // ms a frame; frames to judge
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
      notify(Math.round(1000 / middle));
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
    // The user has chosen a view in three dimensions.
    choose() { chosen = true; },
    get coarse() { return coarse; },
  };
};
