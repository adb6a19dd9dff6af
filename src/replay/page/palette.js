// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Colors of the light and the dark theme. Colors with a meaning are Okabe and Ito's, which the
// color-blind can distinguish. They are never the only difference: lines have dashes, marks have
// shapes, everything has a name.
bbsim.palette = (() => {
  const light = {
    background: '#eef1f5', ink: '#1d2733', plate: '#eef2f6', grid: '#bcc7d3', rim: '#77869a',
    frame: '#4a5663', metal: '#9aa6b3', cream: '#fbf7ee', x: '#0068a8', y: '#00805c', sensor: '#a8447e',
    reference: '#3b4654', band: '#c9d2dc', faint: 0.62, light: 0.42, sky: '#ffffff', earth: '#8f9aa6', hemisphere: 0.56,
    runs: ['#c94f00', '#0068a8', '#00805c', '#a8447e', '#8a6d00', '#2f7fb5'],
  };
  const dark = {
    background: '#12171d', ink: '#e8edf2', plate: '#303b47', grid: '#4a5867', rim: '#8b99a8',
    frame: '#8794a3', metal: '#5e6b79', cream: '#fbf7ee', x: '#5ab4f0', y: '#2fc99a', sensor: '#e28fbd',
    reference: '#cfd8e2', band: '#465463', faint: 0.62, light: 0.6, sky: '#dfe8f2', earth: '#39434e', hemisphere: 0.55,
    runs: ['#ff8a3d', '#5ab4f0', '#2fc99a', '#e28fbd', '#e0c040', '#8fd0ff'],
  };
  // Dashes for the lines of runs, so that color is not the only difference: solid, dashed, dotted,
  // dash-dotted. There is one more than colors, so that six times seven runs are distinct.
  const dashes = [null, [8, 4], [2, 3], [9, 3, 2, 3], [14, 4], [5, 2, 1, 2], [3, 6]];

  const prefersDark = matchMedia('(prefers-color-scheme: dark)');
  let chosen = null;  // 'light' or 'dark'; null follows the system
  let printing = false;  // paper is light
  const listeners = [];

  const isDark = () => !printing && (chosen ? chosen === 'dark' : prefersDark.matches);
  function notify() {
    document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';
    for (const listener of listeners) listener();
  }
  prefersDark.addEventListener('change', notify);
  document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';

  return {
    now: () => (isDark() ? dark : light),
    run: (index) => (isDark() ? dark : light).runs[index % light.runs.length],
    dash: (index) => dashes[index % dashes.length],
    isDark,
    chosen: () => chosen,
    choose(theme) {
      chosen = theme;
      notify();
    },
    onChange: (listener) => listeners.push(listener),
    print(on) {
      const was = isDark();
      printing = on;
      if (was !== isDark()) notify();
    },
  };
})();
