// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Shows one of two pictures: the one in three dimensions if the browser can draw it, or the flat
// one, which is made when needed.
bbsim.makeScreen = (solid, makeFlat) => {
  const get = (id) => document.getElementById(id);
  const listeners = [];
  let isFlat = solid === null, flat = null;
  const off = new Set(['arrows']);  // parts that are switched off
  function makeIt() {
    flat = makeFlat();
    for (const name of off) flat.show(name, false);
  }
  const screen = {
    solid,
    get isFlat() { return isFlat; },
    get shown() { return isFlat ? flat : solid; },
    // Switches to the flat picture, or back.
    setFlat(on) {
      const next = on || solid === null;
      if (next === isFlat && screen.begun) return;
      screen.begun = true;
      isFlat = next;
      if (isFlat && !flat) makeIt();
      get('picture').hidden = isFlat;
      get('flat').hidden = !isFlat;
      if (flat) flat.active = isFlat;
      if (solid) solid.active = !isFlat;
      screen.shown.resize();
      screen.shown.invalidate();
      for (const listener of listeners) listener();
    },
    shows: (name) => !off.has(name),
    show(name, on) {
      off[on ? 'delete' : 'add'](name);
      for (const one of [solid, flat]) if (one) one.show(name, on);
    },
    invalidate() {
      screen.shown.invalidate();
    },
    resize() {
      screen.shown.resize();
    },
    onChange: (listener) => listeners.push(listener),
  };
  return screen;
};
