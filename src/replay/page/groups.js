// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Assigns curves to plots, so that related curves are in one plot.
bbsim.groups = (() => {
  const {runs, scene} = bbsim.data;
  const {palette, text} = bbsim;
  const lead = runs[0];

  // Symbols of the program's columns, by name. Other names are spelled out.
  const symbols = new Map(scene.plots.flatMap(({columns}) => columns.map(({name, symbol}) => [name, symbol])));
  const labelOf = (name) => symbols.get(name) || text.columnName(name);

  // curve: {run, name, label, values, colour(), pattern, width, dots, layer}
  const fromColumn = (run, name, style = {}) => ({
    run, name, label: labelOf(name), values: run.values(name), meaning: run.columns.get(name).meaning,
    unit: run.columns.get(name).unit, ...style,
  });

  function computed(run, name, label, unit, meaning, from, style = {}) {
    const values = new Float64Array(run.t.length);
    for (let i = 0; i < values.length; ++i) values[i] = from(i);
    return {run, name, label, values, meaning, unit: run.unitsKnown ? unit : '', ...style};
  }

  const xColour = () => palette.now().x, yColour = () => palette.now().y;
  const sensor = () => palette.now().sensor;
  const ink = () => palette.now().reference, warm = () => palette.run(0), band = () => palette.now().band;

  // Curves of a plot never differ by color alone. The second of x and y or phi and theta is dashed,
  // references are pale bands, commands thin and dotted or steps, and measurements dots and crosses.
  const first = {colour: xColour, layer: 3}, second = {colour: yColour, pattern: [8, 4], layer: 3};
  const third = {colour: ink, pattern: [9, 3, 2, 3], layer: 3}, main = {colour: warm, width: 2.2, layer: 2};
  const firstBand = {colour: band, width: 6, layer: 0}, secondBand = {colour: band, width: 6, pattern: [16, 4], layer: 0};
  const firstCommand = {colour: xColour, pattern: [2, 2], width: 1.2, layer: 1};
  const secondCommand = {colour: yColour, pattern: [1, 3], width: 2, layer: 1};
  // Steps of a sampled law are many: thin, pale, and without dots, which would tangle.
  const firstSteps = {colour: () => `${xColour()}a0`, width: 1, layer: 1}, secondSteps = {colour: () => `${yColour()}a0`, pattern: [7, 2], width: 1, layer: 1};
  const dots = {colour: sensor, dots: 'circle', layer: 4}, crosses = {colour: sensor, dots: 'cross', layer: 4};

  // Styles a curve as one of several of a kind.
  const numbered = (curve, n) => ({...curve, colour: () => palette.run(n), pattern: palette.dash(n), layer: 3});

  // How a curve is drawn beside the others of its plot.
  function styleOf(curve, curves) {
    const one = (ofFirst, ofSecond) => (curve.axis === 2 ? ofSecond : ofFirst);
    if (curve.role === 'reference') return one(firstBand, secondBand);
    if (curve.role === 'measured') return one(dots, crosses);
    if (curve.role === 'command') {
      // One plot may have a law's command and the torque demanded of a motor.
      const again = curves.filter((other) => other.role === 'command' && other.axis === curve.axis).indexOf(curve) > 0;
      return curve.run.isMeasured && !again ? one(firstSteps, secondSteps) : again ? one({...firstCommand, pattern: [6, 2]}, {...secondCommand, pattern: [6, 2, 1, 2]}) : one(firstCommand, secondCommand);
    }
    const alike = curves.filter((other) => other.role === 'main' && other.axis === curve.axis).indexOf(curve);
    if (curve.axis > 0) return alike === 0 ? one(first, second) : one({...first, pattern: [2, 3]}, {...second, pattern: [9, 3, 2, 3]});
    const hasAxes = curves.some((other) => other.role === 'main' && other.axis > 0);
    return (hasAxes ? [third, {...main, pattern: [2, 3]}] : [main, third])[alike] || numbered({}, alike);
  }

  // Curves that the page computes, which the table of columns lacks.
  const beside = (plot) => ({plot, role: 'main', axis: 0});

  function derived(run) {
    const vx = run.values('vx'), vy = run.values('vy');
    const made = new Map();
    if (vx && vy) made.set('speed', computed(run, 'speed', 'speed', 'm/s', 'size of (vx, vy)', (i) => Math.hypot(vx[i], vy[i]), beside('Velocity')));
    if (run.hasReference && !run.columns.has('tracking_error')) {
      const x = run.values('x'), y = run.values('y'), xr = run.values('x_reference'), yr = run.values('y_reference');
      made.set('tracking_error', computed(run, 'tracking_error', 'tracking error', 'm', 'distance from the reference',
                                          (i) => Math.hypot(x[i] - xr[i], y[i] - yr[i])));
    }
    if (run.friction !== null && run.columns.has('friction_demand')) {
      made.set('friction', computed(run, 'friction', 'coefficient of friction', '1', 'what the surface gives', () => run.friction, beside('Friction demand')));
    }
    return made;
  }

  // In a live page, the motion of the run before, thin and pale.
  function beforeOf(curves) {
    const {before} = bbsim.data;
    if (!before) return [];
    return curves.filter(({role, name}) => role === 'main' && before.columns.has(name)).map((curve) => ({
      ...fromColumn(before, curve.name, {colour: () => palette.now().rim, width: 1, pattern: curve.axis === 2 ? [3, 3] : null, layer: 0.5}),
      label: `${labelOf(curve.name)} before`,
    }));
  }

  function ofOneRun() {
    const more = derived(lead), used = new Set(), plots = [];
    for (const {title, columns} of scene.plots) {
      const curves = [];
      const added = [...more.values()].filter((curve) => curve.plot === title);
      for (const {name, unit, role, axis} of [...columns, ...added]) {
        if (used.has(name)) continue;
        const curve = more.get(name) || (lead.columns.has(name) ? fromColumn(lead, name) : null);
        // In a table without units, the name alone decides.
        if (!curve || (curve.unit !== unit && (lead.unitsKnown || curve.unit !== ''))) continue;
        used.add(name);
        curves.push({...curve, role, axis});
      }
      if (curves.length === 0) continue;
      const styled = curves.map((curve) => ({...curve, ...styleOf(curve, curves)}));
      plots.push({title, unit: curves[0].unit, curves: [...styled, ...beforeOf(curves)]});
    }
    // Columns in no plot above: a plot for each unit, with at most four curves.
    const rest = new Map();
    for (const [name, column] of lead.columns) {
      if (used.has(name) || name.startsWith('ball_q')) continue;
      // Columns without a unit may be unrelated, so each has its own plot.
      const key = column.unit || name;
      if (!rest.has(key)) rest.set(key, []);
      rest.get(key).push(name);
    }
    for (const names of rest.values()) {
      const {unit} = lead.columns.get(names[0]);
      for (let from = 0; from < names.length; from += 4) {
        const some = names.slice(from, from + 4);
        plots.push({title: some.map(labelOf).join(', '), unit, curves: some.map((name, i) => numbered(fromColumn(lead, name), i))});
      }
    }
    return plots;
  }

  // For several runs: a plot for each column of two or more runs, and distances from the first run.
  function ofSeveral() {
    const plots = [];
    const apart = runs.slice(1).map((run) => numbered(computed(
        lead, 'apart', `${run.name} from ${lead.name}`, 'm', 'distance of the contact points', (i) => {
          const t = lead.t[i];
          if (t < run.start || t > run.last) return NaN;
          return Math.hypot(run.at(t, 'x') - lead.values('x')[i], run.at(t, 'y') - lead.values('y')[i]);
        }), run.index));
    const one = (name, title) => {
      const curves = [];
      for (const run of runs) {
        if (run.columns.has(name)) {
          curves.push(numbered({...fromColumn(run, name), label: run.name}, run.index));
        }
      }
      if (lead.columns.has(name + '_reference')) {
        curves.push({...fromColumn(lead, name + '_reference'), label: 'reference', ...firstBand});
      }
      // A curve with an unknown unit leaves the plot without a unit.
      const units = new Set(curves.map((curve) => curve.unit)), unit = units.has('') ? '' : [...units][0];
      if (curves.length > 0) plots.push({title, unit, curves: curves.filter((curve) => unit === '' || curve.unit === unit)});
    };
    one('x', 'x');
    one('y', 'y');
    plots.push({title: 'Distance between the runs', unit: runs.every((run) => run.unitsKnown) ? 'm' : '', curves: apart});
    const seen = new Set(['x', 'y', 'x_reference', 'y_reference', 'x_measured', 'y_measured']);
    for (const {columns} of scene.plots) {
      for (const {name} of columns) {
        if (seen.has(name) || runs.filter((run) => run.columns.has(name)).length < 2) continue;
        seen.add(name);
        one(name, labelOf(name));
      }
    }
    return plots;
  }

  return () => (runs.length > 1 ? ofSeveral() : ofOneRun());
})();
