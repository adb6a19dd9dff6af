// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A page on paper: the picture as it is now, all plots, and of what was run what two sheets have room for.
bbsim.preparePrint = () => {
  const {clock, palette} = bbsim;
  const {element} = bbsim.text;
  const root = document.documentElement;
  // Of A4 and Letter, less their margins, the narrower and the shorter one, in CSS pixels at 96 an inch.
  const width = 716, sheet = 970, sheets = 2;
  let copies = [];

  // A canvas that is drawn anew while its page is printed may be printed empty, and one of 3D graphics as well: what is
  // printed are copies, pixel by pixel.
  function copied(from) {
    const made = element('canvas', {class: 'printed'});
    [made.width, made.height] = [from.width, from.height];
    let ink = from.getContext('2d');
    if (!ink) {
      ink = Object.assign(document.createElement('canvas'), {width: from.width, height: from.height}).getContext('2d', {willReadFrequently: true});
      ink.drawImage(from, 0, 0);
    }
    made.getContext('2d').putImageData(ink.getImageData(0, 0, from.width, from.height), 0, 0);
    copies.push(made);
    return made;
  }

  // Cards go while there is too much, the longest of them first; that something ended early stays.
  function shorten(room) {
    const cards = [...document.querySelectorAll('#details .card')].sort((a, b) => b.scrollHeight - a.scrollHeight);
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
    // As many plots side by side as it takes for all to fit beneath the picture, with the half of a row to spare at a
    // sheet's end.
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
  // Where a browser only shows what it would print.
  matchMedia('print').addEventListener('change', (event) => (event.matches ? begin() : end()));
  bbsim.print = {begin, end};  // for tests
};
