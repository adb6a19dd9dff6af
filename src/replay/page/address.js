'use strict';
// Time and view in the page's address, after the #: a link shows what its sender saw.
bbsim.address = (() => {
  const short = (value) => String(Number(value.toPrecision(5)));

  function read() {
    const result = new Map();
    for (const part of location.hash.slice(1).split('&')) {
      const [name, value] = part.split('=');
      if (name) result.set(name, value === undefined ? '' : decodeURIComponent(value));
    }
    return result;
  }

  function write(picture) {
    const {clock, palette} = bbsim;
    const parts = [`t=${Number(clock.now.toPrecision(9))}`];
    if (picture) {
      const {eyes} = picture;
      parts.push(`view=${eyes.view}`);
      if (eyes.touched) parts.push(`eye=${eyes.state().map(short).join(',')}`);
      if (picture.factor !== 1) parts.push(`tilt=${picture.factor}`);
    }
    if (palette.chosen()) parts.push(`theme=${palette.chosen()}`);
    const hash = '#' + parts.join('&');
    try {
      if (hash !== location.hash) history.replaceState(null, '', hash);
    } catch {
      // A page within a page may not have an address of its own to write to.
    }
  }

  // What a hash says that makes sense; the rest of it is left alone.
  function apply(picture, setFactor) {
    const said = read();
    if (['light', 'dark'].includes(said.get('theme'))) bbsim.palette.choose(said.get('theme'));
    const t = Number(said.get('t'));
    if (said.has('t') && Number.isFinite(t)) bbsim.clock.seek(t);
    if (!picture) return;
    const view = said.get('view');
    const eye = (said.get('eye') || '').split(',').map(Number);
    if (['free', 'above', 'front', 'axis', 'plate'].includes(view)) {
      const usable = eye.length === 6 && eye.every(Number.isFinite) && Math.hypot(eye[0] - eye[3], eye[1] - eye[4], eye[2] - eye[5]) > 0;
      picture.eyes.restore(view, said.has('eye') && usable ? eye : null);
    }
    const factor = Number(said.get('tilt'));
    if (factor >= 1) setFactor(factor);
  }

  function keep(picture, setFactor) {
    let timer = 0;
    const later = () => {
      clearTimeout(timer);
      timer = setTimeout(() => { if (!bbsim.clock.playing) write(picture); }, 250);
    };
    bbsim.clock.onTime(later);
    bbsim.clock.onState(later);
    bbsim.palette.onChange(later);
    if (picture) picture.eyes.onChange(later);
    window.addEventListener('hashchange', () => apply(picture, setFactor));
    return later;
  }

  return {apply, keep};
})();
