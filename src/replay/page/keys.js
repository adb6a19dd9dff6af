// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The keyboard, and the list of its keys.
bbsim.makeKeys = (actions) => {
  const {clock, data, screen} = bbsim, {element} = bbsim.text;
  const keys = document.getElementById('keys'), speed = document.getElementById('speed');
  function faster(by) {
    const speeds = [...speed.options].map((option) => Number(option.value)), at = speeds.indexOf(clock.speed) + by;
    clock.setSpeed(speeds[Math.min(Math.max(at, 0), speeds.length - 1)]);
    actions.say(`speed ${speed.selectedOptions[0].textContent}`);
  }
  const seekBy = (seconds) => clock.seek(clock.now + seconds);
  const zoom = (factor) => !screen.isFlat && screen.solid.eyes.zoom(factor);
  const turn = (left, up) => !screen.isFlat && screen.solid.eyes.turn(left, up);
  const table = [
    [[' '], 'Space', 'play or pause', clock.toggle],
    [['ArrowLeft', ','], '←', 'a row back', (e) => (e.shiftKey ? seekBy(-1) : clock.step(-1))],
    [['ArrowRight', '.'], '→', 'a row on', (e) => (e.shiftKey ? seekBy(1) : clock.step(1))],
    [[], 'Shift ← →', 'a second back or on', null],
    [['Home'], 'Home', 'to the start', () => clock.seek(data.start)],
    [['End'], 'End', 'to the end', () => clock.seek(data.end)],
    [['['], '[', 'slower', () => faster(-1)],
    [[']'], ']', 'faster', () => faster(1)],
    [['l'], 'L', 'loop', () => clock.setLoop(!clock.loop)],
    ...Object.entries(bbsim.views).map(([view, [, from]], i) => [[String(i + 1)], String(i + 1), from.toLowerCase(), () => actions.view(view)]),
    [['+', '='], '+', 'nearer', () => zoom(0.85)],
    [['-'], '−', 'farther', () => zoom(1 / 0.85)],
    [['w'], 'W', 'turn the view up', () => turn(0, 0.08)],
    [['x'], 'X', 'turn the view down', () => turn(0, -0.08)],
    [['a'], 'A', 'turn the view left', () => turn(-0.08, 0)],
    [['d'], 'D', 'turn the view right', () => turn(0.08, 0)],
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
