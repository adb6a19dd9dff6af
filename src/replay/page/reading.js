// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Adds the parts that can wait until the first picture is on the screen: plots, details, sweeps.
(() => {
  const {data, clock, palette, text} = bbsim;
  const {element} = text;
  const get = (id) => document.getElementById(id);

  // The list of several runs: their names, their distances from the first run now, and whether they
  // are shown.
  function makeRuns(container) {
    const {runs} = data;
    const list = element('ul', {class: 'runs'});
    const lines = runs.map((run) => {
      const apart = element('output', {});
      const sample = text.svg('svg', {viewBox: '0 0 26 10', class: 'swatch', 'aria-hidden': 'true'},
                              text.svg('path', {d: 'M1 5H25', 'stroke-dasharray': palette.dash(run.index) ? palette.dash(run.index).join(' ') : 'none'}));
      const box = element('input', {type: 'checkbox', checked: true, 'data-run': String(run.index)});
      box.addEventListener('change', () => {
        run.shown = box.checked;
        bbsim.screen.invalidate();
      });
      const words = run.status && run.status !== 'done' ? ` (${run.status} at ${text.number(run.reached, 6)} s)` : '';
      const item = element('li', {}, element('label', {}, box, sample, element('span', {}, run.name + words)), apart);
      list.append(item);
      return {run, apart, item};
    });
    const recolour = () => lines.forEach(({run, item}) => item.style.setProperty('--colour', palette.run(run.index)));
    const show = (t) => {
      for (const {run, apart} of lines.slice(1)) {
        const far = t >= run.start && t <= run.last ? Math.hypot(run.at(t, 'x') - runs[0].at(t, 'x'), run.at(t, 'y') - runs[0].at(t, 'y')) : NaN;
        const shown = text.shownIn(run.unitsKnown && runs[0].unitsKnown ? 'm' : '', far < 1 ? 0.1 : far);
        apart.textContent = Number.isFinite(far) ? `${text.steady(far * shown.factor, 100)} ${shown.unit} apart` : 'over';
      }
    };
    lines[0].apart.textContent = 'leads';
    recolour();
    palette.onChange(recolour);
    clock.onTimeRelaxed(show);
    show(clock.now);
    container.append(element('h2', {}, `${runs.length} runs`), list);
    container.hidden = false;
  }

  function read() {
    if (data.runs.length > 1) makeRuns(get('runs'));
    if (data.runs.length > 0) {
      bbsim.plots = bbsim.makePlots(get('plots'));
      bbsim.details = bbsim.makeDetails(get('details'));
      bbsim.preparePrint();
      if (bbsim.makeLive) bbsim.makeLive(get('live'));
    }
    const sweeps = data.scene.sweeps;
    if (sweeps.length > 0) {
      get('sweeps').hidden = false;
      bbsim.sweeps = sweeps.map((sweep) => bbsim.makeSweep(sweep, get('sweeps')));
      if (data.runs.length === 0) {
        get('subtitle').textContent = text.visible(sweeps.map((sweep) => sweep.title).filter((title) => title && title !== data.scene.title).join(', '));
        get('save-csv').addEventListener('click', () => bbsim.save.offer(
            new Blob([bbsim.sweeps[0].csv()], {type: 'text/csv'}), bbsim.save.fileName(sweeps[0].name, '-page.csv')));
      }
    }
    // One more frame, for parts that wait for it.
    requestAnimationFrame(() => setTimeout(() => bbsim.isReady(), 0));
  }
  // Lets the browser show the picture first.
  requestAnimationFrame(() => setTimeout(() => {
    try {
      read();
    } catch (error) {
      bbsim.isNot(error);
      throw error;
    }
  }, 0));
})();
