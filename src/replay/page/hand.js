// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Tilting the plate by hand in a live page, in real time: drag across the picture, or press the arrow
// keys. The tilt follows at a limited rate, and the engine rolls the ball from picture to picture: a
// late picture is left out, its time is not. `ask(piece)` is fulfilled with the state at its end.
bbsim.makeHand = (ask, fault) => {
  const {clock, data, screen} = bbsim;
  const [lead] = data.runs, box = document.getElementById('screen');
  const largest = Math.PI / 15, rate = Math.PI / 3, longest = 0.25;  // rad, rad/s, s
  const middle = {x: 0, y: 0, vx: 0, vy: 0, phi: 0, theta: 0};
  let on = false, wanted = [0, 0], held = null;
  const bounded = (value, most) => Math.min(Math.max(value, -most), most);

  async function roll() {
    const turned = new THREE.Quaternion(), more = new THREE.Quaternion();
    const at = lead.placeAt(clock.now);
    let state = {...middle, ...(Array.isArray(at) ? {x: at[0], y: at[1]} : {})}, from = performance.now();
    try {
      while (on) {
        lead.hand = {...state, turned};
        clock.seek(clock.now);  // all views look again
        await new Promise((resolve) => requestAnimationFrame(resolve));
        const now = performance.now(), seconds = Math.min((now - from) / 1000, longest);
        from = now;
        if (!(seconds > 0)) continue;
        const to = ['phi', 'theta'].map((name, i) => state[name] + bounded(wanted[i] - state[name], rate * seconds));
        const next = await ask({from: [state.x, state.y, state.vx, state.vy, state.phi, state.theta], to, seconds});
        const {stage} = data.scene;
        if (Math.abs(next.x) > stage.width / 2 || Math.abs(next.y) > stage.depth / 2) {
          state = {...middle, phi: to[0], theta: to[1]};  // it rolled off: another one
          continue;
        }
        turned.premultiply(more.set(next.ball_qx, next.ball_qy, next.ball_qz, next.ball_qw)).normalize();
        state = next;
      }
    } catch (error) {
      fault(error);
    }
    on = false;
    box.classList.remove('held');
    delete lead.hand;
    screen.show('trail', true);
    clock.seek(clock.now);
  }

  // A drag by a third of the picture is the largest tilt; the side that is pushed goes down.
  const signs = [1, -1];  // of phi for +x, and of theta for +y
  function lean(x, y) {
    wanted = [signs[0] * bounded(x, 1) * largest, signs[1] * bounded(y, 1) * largest];
  }
  const way = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1]};
  const pressed = new Set();
  function listen(type, act) {
    (type.startsWith('key') ? window : box).addEventListener(type, (event) => {
      if (!on || (type.startsWith('key') ? !way[event.key] || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName) : !held && !(event.target instanceof HTMLCanvasElement))) return;
      event.preventDefault();
      event.stopPropagation();
      act(event);
    }, true);
  }
  listen('pointerdown', (event) => {
    held = [event.clientX, event.clientY];
    event.target.setPointerCapture(event.pointerId);
  });
  listen('pointermove', (event) => {
    if (held) lean((event.clientX - held[0]) / box.clientWidth * 3, (held[1] - event.clientY) / box.clientWidth * 3);
  });
  for (const type of ['pointerup', 'pointercancel']) {
    listen(type, () => {
      held = null;
      lean(0, 0);
    });
  }
  for (const [type, change] of [['keydown', 'add'], ['keyup', 'delete']]) {
    listen(type, ({key}) => {
      pressed[change](key);
      lean(...[0, 1].map((i) => [...pressed].reduce((sum, one) => sum + way[one][i], 0)));
    });
  }

  return {
    get state() { return lead.hand; },
    lean,
    step: ask,
    start() {
      on = true;
      box.classList.add('held');  // a finger tilts, and does not scroll
      pressed.clear();
      lean(0, 0);
      clock.pause();
      screen.show('trail', false);
      return roll();
    },
    stop() { on = false; },
  };
};
