// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The views of the keys 1, 2, ...: their buttons, and where one looks from.
bbsim.views = {
  free: ['Corner', 'From a corner'], above: ['Above', 'From above'], front: ['Front', 'From the front'],
  axis: ['Tilt axis', 'Along the axis that the plate tilts about now'], plate: ['On plate', 'In the plate\'s own frame'],
  ball: ['Ball', 'Near the ball, and with it'], flat: ['Flat', 'From above, drawn flat: the fastest'],
};

// Shows one of two pictures: the one in three dimensions if the browser can draw it, or the flat
// one, which is made when needed.
//
// While time runs, adapts the page to slow frames, in three stages. First, everything but the
// picture follows only a few times a second, because a browser composes everything between changed
// parts again. Then the picture gets fewer pixels. If that does not suffice, it becomes flat, and
// `notify` gets the rate. A picture at rest has all pixels. A view that the user has chosen stays.
bbsim.makeScreen = (solid, makeFlat, notify) => {
  const {clock} = bbsim, get = (id) => document.getElementById(id), listeners = [];
  const slow = 1000 / 24, tooSlow = 1000 / 15, several = 6;  // ms a frame; frames to judge
  let isFlat = solid === null, flat = null, begun = false;
  let last = null, spans = [], coarse = false, chosen = false;

  function judge() {
    const middle = spans.sort((a, b) => a - b)[several >> 1];
    spans = [];
    if (middle <= slow) return;
    clock.relax(100);
    if (isFlat) return;
    if (!coarse) {
      coarse = true;
      solid.setPixels(0.5);
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
    if (solid) solid.setPixels(clock.playing && coarse ? 0.5 : 1);
  });

  const screen = {
    solid,
    get isFlat() { return isFlat; },
    get shown() { return isFlat ? flat : solid; },
    // Switches to the flat picture, or back.
    setFlat(on) {
      const next = on || solid === null;
      if (next === isFlat && begun) return;
      begun = true;
      isFlat = next;
      if (isFlat && !flat) flat = makeFlat();
      get('picture').hidden = isFlat;
      get('flat').hidden = !isFlat;
      if (flat) flat.active = isFlat;
      if (solid) solid.active = !isFlat;
      screen.shown.resize();
      screen.shown.invalidate();
      for (const listener of listeners) listener();
    },
    // The user has chosen a view in three dimensions.
    choose() { chosen = true; },
    show(name, on) {
      bbsim.visible[name] = on;
      screen.invalidate();
    },
    invalidate: () => screen.shown.invalidate(),
    resize: () => screen.shown.resize(),
    onChange: (listener) => listeners.push(listener),
  };
  return screen;
};
