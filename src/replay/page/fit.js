// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The page of a fit: tables, and one of its logs beside the model.
(() => {
  const {palette, text} = bbsim;
  const {element} = text;
  const {scene, runs} = bbsim.data;
  const get = (id) => document.getElementById(id);

  document.title = text.visible(scene.title);
  get('title').textContent = text.visible(scene.title);
  get('subtitle').textContent = text.visible(`${scene.scenario}, to ${scene.logs.join(', ')} · bbsim ${scene.version}`);
  get('made-by').textContent = text.visible(`Made by bbsim ${scene.version}. It holds all that it shows.`);
  get('theme').addEventListener('click', () => palette.choose(palette.isDark() ? 'light' : 'dark'));

  function table(caption, {head, rows}) {
    const number = (words) => words.replace(/^-$/, '–').replaceAll('-', '−');
    const isUnit = (i) => head[i] === 'unit';
    return element('table', {}, element('caption', {}, caption),
        element('thead', {}, element('tr', {}, ...head.map((name) => element('th', {scope: 'col'}, name)))),
        element('tbody', {}, ...rows.map((row) => element('tr', {}, ...row.map((words, i) => (i === 0
            ? element('th', {scope: 'row'}, words)
            : element('td', {'data-label': text.visible(head[i]), class: isUnit(i) ? 'unit' : false}, isUnit(i) ? words : number(words))))))));
  }
  get('parameters').append(table('Parameters', scene.parameters));
  get('residuals').append(table('Residuals: model minus log', scene.residuals));
  get('compared').textContent = text.visible(scene.remarks[0]);
  for (const words of scene.remarks.slice(1)) {
    get('remarks').append(element('li', {class: words.startsWith('not identifiable') ? 'untold' : false}, words));
  }

  // The row nearest to a time. A row without numbers separates two windows; it does not count.
  for (const run of runs) {
    run.windowAt = (row) => run.windows.find(({last}) => row <= last) || run.windows[run.windows.length - 1];
    run.nearest = (t) => {
      const before = run.row(t), after = Math.min(before + 1, run.t.length - 1);
      const row = run.t[after] - t < t - run.t[before] ? after : before;
      if (row >= run.windowAt(row).first) return row;
      return t - run.t[row - 1] < run.t[row + 1] - t ? row - 1 : row + 1;
    };
    run.rowNumbers = run.windows.flatMap(({first, last}) => Array.from({length: last - first + 1}, (_, i) => first + i));
  }

  function groupsOf(run) {
    const ink = () => palette.now().reference;
    const curve = (name, label, style) => {
      const column = run.columns.get(name);
      return {run, name, label, values: column.values, meaning: column.meaning, unit: column.unit, ...style};
    };
    return scene.columns.flatMap(({name, symbol, unit}) => [
      {title: symbol, unit, curves: [
        curve(name, 'log', {colour: () => palette.now().x, dots: 'circle', every: true, layer: 1}),
        curve(`${name}_modelled`, 'model', {colour: () => palette.run(0), width: 1.4, layer: 2}),
      ]},
      {title: `${symbol}: model minus log`, unit, isResidual: true, curves: [
        curve(`${name}_residual`, 'residual', {colour: ink, width: 1.1, layer: 1}),
      ]},
    ]);
  }

  // Marks windows below the curves: the start of each, a background for those held out, and the
  // zero line of residuals.
  function paintWindows(run) {
    return (ink, area, graph, {isResidual}) => {
      ink.save();
      ink.clip(new Path2D(`M${area.x} ${area.y}h${area.w}v${area.h}h${-area.w}z`));
      const x = (row) => graph.toDomXCoord(run.t[row]);
      ink.fillStyle = palette.isDark() ? 'rgba(200, 210, 220, .15)' : 'rgba(60, 75, 90, .13)';
      for (const {first, last, held} of run.windows) {
        if (held) ink.fillRect(x(first), area.y, x(last) - x(first), area.h);
      }
      ink.strokeStyle = palette.isDark() ? '#7d8a98' : '#8b97a4';
      ink.lineWidth = 1;
      // Too many lines would hide the curves.
      const [from, to] = graph.xAxisRange();
      const seen = run.windows.filter(({first}) => run.t[first] >= from && run.t[first] <= to);
      ink.setLineDash([3, 4]);
      for (const {first} of seen.length <= area.w / 8 ? seen : []) ink.stroke(new Path2D(`M${x(first)} ${area.y}v${area.h}`));
      ink.setLineDash([]);
      if (isResidual) ink.stroke(new Path2D(`M${area.x} ${graph.toDomYCoord(0)}h${area.w}`));
      ink.restore();
    };
  }

  let plan = null;
  const scrub = get('scrub');
  function showTime(t) {
    const {clock, transport} = bbsim;
    const [run] = bbsim.data.runs;
    scrub.value = run.rowNumbers.indexOf(run.nearest(clock.now));
    const words = `${transport.timeText(t)} s`;
    scrub.setAttribute('aria-valuetext', words);
    if (get('time').textContent !== words) get('time').textContent = words;
    if (plan) plan.show(t, transport.timeText(t));
  }
  scrub.addEventListener('input', () => {
    const {clock, data} = bbsim, [run] = data.runs;
    clock.pause();
    clock.seek(run.t[run.rowNumbers[scrub.value]]);
  });
  get('play').addEventListener('click', () => bbsim.clock.toggle());

  // Shows one of the logs.
  function show(run) {
    if (bbsim.plots) {
      bbsim.clock.pause();
      bbsim.plots.end();
    }
    bbsim.data = {...bbsim.data, runs: [run], start: run.start, end: run.last};
    bbsim.clock = bbsim.makeClock(bbsim.data);
    const decimals = text.decimalsOfTime((run.last - run.start) / Math.max(1, run.rowNumbers.length - 1));
    bbsim.transport = {timeText: (t) => t.toFixed(decimals).replace('-', '−')};
    bbsim.groups = () => groupsOf(run);
    bbsim.address = {zoom: () => null};
    bbsim.plots = bbsim.makePlots(get('plots'), {behind: paintWindows(run), pointed: (t) => showTime(t === null ? bbsim.clock.now : t)});
    plan = scene.place ? bbsim.makePlan(get('plan'), run, scene.place, scene.radius) : null;
    get('plan').hidden = plan === null;
    get('held-sign').hidden = !run.windows.some(({held}) => held);
    get('thinned').textContent = run.every > 1 ? `One row in ${run.every} of ${run.rows} is shown.` : '';
    scrub.max = run.rowNumbers.length - 1;
    bbsim.clock.onTimeRelaxed(showTime);
    bbsim.clock.onState(() => bbsim.showPlaying(bbsim.clock));
    showTime(bbsim.clock.now);
    bbsim.showPlaying(bbsim.clock);
  }

  get('choice').hidden = runs.length < 2;
  get('log').append(...runs.map((run, i) => element('option', {value: String(i)}, run.name)));
  get('log').addEventListener('change', () => show(runs[get('log').value]));

  show(runs[0]);
  bbsim.preparePrint();
  bbsim.seek = (t) => bbsim.clock.seek(t);
  bbsim.ready = new Promise((resolve) => { requestAnimationFrame(() => setTimeout(resolve, 0)); });
})();
