// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Keeps time, view and zoom in the page's address after the #, so that a link shows what its sender
// saw.
bbsim.address = (() => {
  const short = (value) => String(Number(value.toPrecision(5)));
  const read = () => new URLSearchParams(location.hash.slice(1));

  function write(screen) {
    const {clock, palette, plots} = bbsim;
    const parts = [`t=${Number(clock.now.toPrecision(9))}`];
    if (screen) {
      const {solid} = screen;
      parts.push(`view=${screen.isFlat ? 'flat' : solid.eyes.view}`);
      if (!screen.isFlat && solid.eyes.touched) parts.push(`eye=${solid.eyes.state().map(short).join(',')}`);
      if (solid && solid.factor !== 1) parts.push(`tilt=${solid.factor}`);
    }
    const zoom = plots ? plots.range : zoomIn(read());
    if (zoom) parts.push(`zoom=${zoom.map((t) => Number(t.toPrecision(9))).join(',')}`);
    if (palette.chosen()) parts.push(`theme=${palette.chosen()}`);
    if (bbsim.live && bbsim.live.fragment()) parts.push(bbsim.live.fragment());
    const hash = '#' + parts.join('&');
    try {
      if (hash !== location.hash) history.replaceState(null, '', hash);
    } catch {
      // An embedded page may have no address to write to.
    }
  }

  function zoomIn(said) {
    const range = (said.get('zoom') || '').split(',').map(Number);
    return range.length === 2 && range.every(Number.isFinite) && range[0] < range[1] ? range : null;
  }

  // Applies the valid parts of the hash and ignores the others.
  function apply(screen, actions) {
    const said = read();
    if (['light', 'dark'].includes(said.get('theme'))) bbsim.palette.choose(said.get('theme'));
    const t = Number(said.get('t'));
    if (bbsim.clock && said.get('t') && Number.isFinite(t)) bbsim.clock.seek(t);
    if (bbsim.plots && zoomIn(said)) bbsim.plots.zoom(zoomIn(said));
    if (!screen) return;
    const view = said.get('view');
    const eye = (said.get('eye') || '').split(',').map(Number);
    if (view === 'flat') screen.setFlat(true);
    else if (screen.solid && Object.keys(bbsim.views).includes(view)) {
      const usable = eye.length === 6 && eye.every(Number.isFinite) && Math.hypot(eye[0] - eye[3], eye[1] - eye[4], eye[2] - eye[5]) > 0;
      screen.setFlat(false);
      screen.solid.eyes.restore(view, said.has('eye') && usable ? eye : null);
    }
    const factor = Number(said.get('tilt'));
    if (factor >= 1) actions.setFactor(factor);
  }

  function keep(screen, actions) {
    let timer = 0;
    const later = () => {
      clearTimeout(timer);
      timer = setTimeout(() => { if (!bbsim.clock.playing) write(screen); }, 250);
    };
    bbsim.clock.onTime(later);
    bbsim.clock.onState(later);
    bbsim.palette.onChange(later);
    screen.onChange(later);
    if (screen.solid) screen.solid.eyes.onChange(later);
    window.addEventListener('hashchange', () => apply(screen, actions));
    return later;
  }

  return {apply, keep, zoom: () => zoomIn(read()), said: (name) => read().get(name)};
})();
