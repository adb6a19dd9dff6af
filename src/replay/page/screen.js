'use strict';
// Which of the two pictures is on the screen: that in three dimensions, if the browser can, or the flat one.
bbsim.makeScreen = (solid, flat) => {
  const get = (id) => document.getElementById(id);
  const listeners = [];
  let isFlat = solid === null;
  const screen = {
    solid, flat,
    get isFlat() { return isFlat; },
    get shown() { return isFlat ? flat : solid; },
    // Goes to the flat picture, or comes back.
    setFlat(on) {
      const next = on || solid === null;
      if (next === isFlat && screen.begun) return;
      screen.begun = true;
      isFlat = next;
      get('picture').hidden = isFlat;
      get('flat').hidden = !isFlat;
      flat.active = isFlat;
      if (solid) solid.active = !isFlat;
      screen.shown.resize();
      screen.shown.invalidate();
      for (const listener of listeners) listener();
    },
    show(name, on) {
      if (solid) solid.show(name, on);
      flat.show(name, on);
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
