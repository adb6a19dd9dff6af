'use strict';
// Which curves stand in which plot: those that one looks at together, where the runs have them.
bbsim.groups = (() => {
  const {runs} = bbsim.data;
  const {palette, text} = bbsim;
  const lead = runs[0];

  // curve: {run, name, label, values, colour(), pattern, dots, faint}
  const fromColumn = (run, name, style = {}) => ({
    run, name, label: text.columnName(name), values: run.values(name), meaning: run.columns.get(name).meaning,
    unit: run.columns.get(name).unit, ...style,
  });

  function computed(run, name, label, unit, meaning, from, style = {}) {
    const values = new Float64Array(run.t.length);
    for (let i = 0; i < values.length; ++i) values[i] = from(i);
    return {run, name, label, values, meaning, unit, ...style};
  }

  const xColour = () => palette.now().x, yColour = () => palette.now().y;
  const sensor = () => palette.now().sensor;
  const ink = () => palette.now().reference, warm = () => palette.run(0);

  // Columns of one plot, with the colour and the pattern of each.
  const families = [
    ['Position', 'm', [['x', xColour], ['y', yColour], ['x_reference', xColour, [7, 4]], ['y_reference', yColour, [7, 4]],
                       ['x_measured', sensor, 'dots'], ['y_measured', sensor, 'dots']]],
    ['Gimbal', 'rad', [['phi', xColour], ['theta', yColour], ['phi_command', xColour, [2, 2]], ['theta_command', yColour, [2, 2]],
                       ['tilt', ink, [9, 3, 2, 3]]]],
    ['Distance', 'm', [['tracking_error', warm], ['distance', ink, [7, 4]]]],
    ['Velocity', 'm/s', [['speed', warm], ['vx', xColour, [7, 4]], ['vy', yColour, [7, 4]]]],
    ['Turn of the ball', 'rad', [['gamma', warm]]],
    ['Rates', 'rad/s', [['phi_rate', xColour], ['theta_rate', yColour], ['tilt_rate', ink, [9, 3, 2, 3]], ['spin', warm, [7, 4]]]],
    ['Accelerations', 'rad/s^2', [['phi_acceleration', xColour], ['theta_acceleration', yColour], ['phi_command', xColour, [2, 2]],
                                  ['theta_command', yColour, [2, 2]]]],
    ['Friction demand', '1', [['friction_demand', warm], ['friction', ink, [7, 4]]]],
    ['Forces', 'N', [['normal_force', xColour], ['friction_force', warm, [7, 4]]]],
    ['Torques', 'N m', [['motor_torque_phi', xColour], ['motor_torque_theta', yColour], ['torque_phi', xColour, [7, 4]],
                        ['torque_theta', yColour, [7, 4]]]],
    ['Power', 'W', [['motor_power', warm], ['power', ink, [7, 4]]]],
    ['Energy', 'J', [['energy', warm]]],
  ];

  function derived(run) {
    const vx = run.values('vx'), vy = run.values('vy');
    const made = new Map();
    if (vx && vy) made.set('speed', computed(run, 'speed', 'speed', 'm/s', 'size of (vx, vy)', (i) => Math.hypot(vx[i], vy[i])));
    if (run.hasReference && !run.columns.has('tracking_error')) {
      const x = run.values('x'), y = run.values('y'), xr = run.values('x_reference'), yr = run.values('y_reference');
      made.set('tracking_error', computed(run, 'tracking_error', 'tracking error', 'm', 'distance from the reference',
                                          (i) => Math.hypot(x[i] - xr[i], y[i] - yr[i])));
    }
    if (run.friction !== null && run.columns.has('friction_demand')) {
      made.set('friction', computed(run, 'friction', 'coefficient of friction', '1', 'what the surface gives', () => run.friction));
    }
    return made;
  }

  function styled(curve, colour, pattern) {
    return {...curve, colour, pattern: Array.isArray(pattern) ? pattern : null, dots: pattern === 'dots'};
  }

  function ofOneRun() {
    const more = derived(lead), used = new Set(), plots = [];
    for (const [title, unit, columns] of families) {
      const curves = [];
      for (const [name, colour, pattern] of columns) {
        if (used.has(name)) continue;
        const curve = more.get(name) || (lead.columns.has(name) ? fromColumn(lead, name) : null);
        if (!curve || curve.unit !== unit) continue;
        used.add(name);
        curves.push(styled(curve, colour, pattern));
      }
      if (curves.length > 0) plots.push({title, unit, curves});
    }
    // What no family knows: a plot for each unit.
    const rest = new Map();
    for (const [name, column] of lead.columns) {
      if (used.has(name) || name.startsWith('ball_q')) continue;
      if (!rest.has(column.unit)) rest.set(column.unit, []);
      rest.get(column.unit).push(name);
    }
    for (const [unit, names] of rest) {
      for (let from = 0; from < names.length; from += 4) {
        const some = names.slice(from, from + 4);
        plots.push({title: some.map(text.columnName).join(', '), unit, curves: some.map((name, i) =>
          styled(fromColumn(lead, name), () => palette.run(i), palette.dash(i)))});
      }
    }
    return plots;
  }

  // Of several runs: a plot for each column that more than one has, and how far they are from the first.
  function ofSeveral() {
    const plots = [];
    const apart = runs.slice(1).map((run) => styled(computed(
        lead, 'apart', `${run.name} from ${lead.name}`, 'm', 'distance of the contact points', (i) => {
          const t = lead.t[i];
          if (t < run.start || t > run.last) return NaN;
          return Math.hypot(run.at(t, 'x') - lead.values('x')[i], run.at(t, 'y') - lead.values('y')[i]);
        }), () => palette.run(run.index), palette.dash(run.index)));
    const one = (name, title) => {
      const curves = [];
      for (const run of runs) {
        if (run.columns.has(name)) {
          curves.push(styled({...fromColumn(run, name), label: run.name}, () => palette.run(run.index), palette.dash(run.index)));
        }
      }
      if (lead.columns.has(name + '_reference')) {
        curves.push(styled({...fromColumn(lead, name + '_reference'), label: 'reference'}, ink, [2, 4]));
      }
      if (curves.length > 0) plots.push({title, unit: curves[0].unit, curves: curves.filter((c) => c.unit === curves[0].unit)});
    };
    one('x', 'x');
    one('y', 'y');
    plots.push({title: 'Distance between the runs', unit: 'm', curves: apart});
    const seen = new Set(['x', 'y', 'x_reference', 'y_reference', 'x_measured', 'y_measured']);
    for (const [, , columns] of families) {
      for (const [name] of columns) {
        if (seen.has(name) || runs.filter((run) => run.columns.has(name)).length < 2) continue;
        seen.add(name);
        one(name, text.columnName(name));
      }
    }
    return plots;
  }

  return () => (runs.length > 1 ? ofSeveral() : ofOneRun());
})();
