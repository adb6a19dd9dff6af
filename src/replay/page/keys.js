// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The keyboard, and the list of its keys.
bbsim.makeKeys = (actions) => {
  const {element} = bbsim.text;
  const keys = document.getElementById('keys');
  const table = [
    [[' '], 'Space', 'play or pause', actions.toggle],
    [['ArrowLeft', ','], '←', 'a row back', (e) => (e.shiftKey ? actions.seekBy(-1) : actions.step(-1))],
    [['ArrowRight', '.'], '→', 'a row on', (e) => (e.shiftKey ? actions.seekBy(1) : actions.step(1))],
    [[], 'Shift ← →', 'a second back or on', null],
    [['Home'], 'Home', 'to the start', actions.toStart],
    [['End'], 'End', 'to the end', actions.toEnd],
    [['['], '[', 'slower', () => actions.faster(-1)],
    [[']'], ']', 'faster', () => actions.faster(1)],
    [['l'], 'L', 'loop', actions.loop],
    [['1'], '1', 'from a corner', () => actions.view('free')],
    [['2'], '2', 'from above', () => actions.view('above')],
    [['3'], '3', 'from the front', () => actions.view('front')],
    [['4'], '4', 'along the tilt axis', () => actions.view('axis')],
    [['5'], '5', 'in the plate\'s frame', () => actions.view('plate')],
    [['6'], '6', 'near the ball', () => actions.view('ball')],
    [['7'], '7', 'from above, flat', () => actions.view('flat')],
    [['+', '='], '+', 'nearer', () => actions.zoom(0.85)],
    [['-'], '−', 'farther', () => actions.zoom(1 / 0.85)],
    [['w'], 'W', 'turn the view up', () => actions.turn(0, 0.08)],
    [['x'], 'X', 'turn the view down', () => actions.turn(0, -0.08)],
    [['a'], 'A', 'turn the view left', () => actions.turn(-0.08, 0)],
    [['d'], 'D', 'turn the view right', () => actions.turn(0.08, 0)],
    [['e'], 'E', 'draw the tilt larger', actions.exaggerate],
    [['t'], 'T', 'light or dark', actions.theme],
    [['p'], 'P', 'save a PNG', actions.png],
    [['s'], 'S', 'save the CSV', actions.csv],
    [['?', 'h'], '?', 'this list', () => keys.showModal()],
  ];
  const list = document.getElementById('key-list');
  for (const [, sign, words] of table) {
    list.append(element('div', {}, element('dt', {}, element('kbd', {}, sign)), element('dd', {}, words)));
  }
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector('dialog[open]')) return;
    // Keys that an input, a list or a button uses have no other effect.
    const tag = event.target.tagName;
    if (tag === 'SELECT' || tag === 'TEXTAREA' || (tag === 'INPUT' && event.target.id !== 'scrub')) return;
    if ((tag === 'BUTTON' || tag === 'SUMMARY' || tag === 'A') && (event.key === ' ' || event.key === 'Enter')) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const found = table.find(([names]) => names.includes(key));
    if (!found) return;
    event.preventDefault();
    found[3](event);
  });
};
