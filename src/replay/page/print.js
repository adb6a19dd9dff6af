// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The page on paper: the current picture, all plots, and as many details of the run as fit on two
// sheets.
bbsim.preparePrint = () => {
  const {clock, palette} = bbsim;
  const root = document.documentElement;
  // The smaller width and height of A4 and Letter without their margins, CSS pixels (96 an inch).
  const width = 716, sheet = 970, sheets = 2;
  let copies = [];

  function copied(from) {
    const made = bbsim.copyForPaper(from);
    copies.push(made);
    return made;
  }

  // Removes cards while there is too much, the longest first, but the scenario last. The reason of an
  // early end stays.
  function shorten(room) {
    const cards = [...document.querySelectorAll('#details .card')].sort((a, b) => a.classList.contains('text') - b.classList.contains('text') || b.scrollHeight - a.scrollHeight);
    for (const card of cards) {
      if (document.body.scrollHeight <= room) return;
      card.classList.add('unprinted');
    }
    document.querySelectorAll('#details .fine, #details .again').forEach((one) => {
      if (document.body.scrollHeight > room) one.classList.add('unprinted');
    });
  }

  function begin() {
    if (copies.length > 0) return;
    clock.pause();
    root.classList.add('printing');
    palette.print(true);
    const box = document.getElementById('screen').getBoundingClientRect();
    document.getElementById('screen').prepend(copied(bbsim.screen.shown.print(box.width, box.height)));
    // Takes as many columns as it needs to fit all plots below the picture, with half a row to
    // spare at the end of a sheet.
    const {plots} = bbsim.plots, heads = 50, least = 58;
    const high = document.getElementById('plots').getBoundingClientRect().top + window.scrollY;
    let columns = 2, height = 0;
    for (; columns < 6; ++columns) {
      const rows = Math.ceil(plots.length / columns);
      height = Math.min(110, (sheets * sheet - high - 60) / (rows + 0.5) - heads);
      if (height >= least) break;
    }
    root.style.setProperty('--plots-beside', columns);
    root.style.setProperty('--plot-height', `${Math.max(height, 40)}px`);
    bbsim.plots.print({width: Math.floor((width - 8 * (columns - 1)) / columns - 14), height: Math.max(height, 40)});
    for (const {canvas} of plots) canvas.prepend(copied(canvas.querySelector('canvas')));
    shorten(sheets * sheet - 0.5 * (height + heads) - 20);
  }

  function end() {
    for (const copy of copies) copy.remove();
    if (copies.length === 0) return;
    copies = [];
    root.classList.remove('printing');
    palette.print(false);
    document.querySelectorAll('.unprinted').forEach((one) => one.classList.remove('unprinted'));
    bbsim.plots.print(null);
    bbsim.screen.shown.printed();
  }

  window.addEventListener('beforeprint', begin);
  window.addEventListener('afterprint', end);
  // For a browser that only shows a preview.
  matchMedia('print').addEventListener('change', (event) => (event.matches ? begin() : end()));
  bbsim.print = {begin, end};  // for tests
};
