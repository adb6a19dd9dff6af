// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The page on paper: the current picture, all plots, and all else that the page says of the run.
bbsim.preparePrint = () => {
  const root = document.documentElement, screen = document.getElementById('screen');
  // The smaller width of A4 and Letter without their margins, CSS pixels (96 an inch).
  const width = 716, height = 110;
  let copies = [];

  // Prints a copy: a canvas that is redrawn during printing may be printed empty, as may a 3D canvas.
  function copy(from, into) {
    const made = bbsim.text.element('canvas', {class: 'printed'});
    [made.width, made.height] = [from.width, from.height];
    made.getContext('2d', {willReadFrequently: true}).drawImage(from, 0, 0);
    into.prepend(made);
    copies.push(made);
  }

  function begin() {
    if (copies.length > 0) return;
    bbsim.clock.pause();
    root.classList.add('printing');
    bbsim.palette.print(true);
    if (screen) copy(bbsim.screen.shown.print(screen.clientWidth, screen.clientHeight), screen);
    const {plots} = bbsim.plots, columns = plots.length > 12 ? 3 : 2;
    root.style.setProperty('--plots-beside', columns);
    bbsim.plots.print({width: Math.floor((width - 8 * (columns - 1)) / columns - 14), height});
    for (const {canvas} of plots) copy(canvas.querySelector('canvas'), canvas);
  }

  function end() {
    if (copies.length === 0) return;
    for (const one of copies.splice(0)) one.remove();
    root.classList.remove('printing');
    bbsim.palette.print(false);
    bbsim.plots.print(null);
    if (screen) bbsim.screen.shown.printed();
  }

  window.addEventListener('beforeprint', begin);
  window.addEventListener('afterprint', end);
  // For a browser that only shows a preview.
  matchMedia('print').addEventListener('change', (event) => (event.matches ? begin() : end()));
  bbsim.print = {begin, end};  // for tests
};
