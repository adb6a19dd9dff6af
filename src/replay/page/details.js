// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Describes the run: the scenario's text, the outcome, the model, poles, statistics.
bbsim.makeDetails = (container) => {
  const {data, text} = bbsim;
  const {element} = text;

  function card(title, ...content) {
    return element('details', {class: 'card', open: true}, element('summary', {}, element('h3', {}, title)), ...content);
  }

  // A JSON object as rows of names and values.
  function rowsOf(value) {
    const list = element('dl', {class: 'rows'});
    for (const [name, member] of Object.entries(value)) {
      const shown = Array.isArray(member) ? member.map((m) => (typeof m === 'object' ? JSON.stringify(m) : String(m))).join('\n')
                  : member !== null && typeof member === 'object' ? JSON.stringify(member)
                  : typeof member === 'number' ? text.number(member, 8) : String(member);
      if (shown === '' || shown === 'null') continue;
      list.append(element('div', {}, element('dt', {}, name.replaceAll('_', ' ')), element('dd', {}, shown)));
    }
    return list;
  }

  // The peaks of the motors' loads: {peak_torque_phi, peak_torque_phi_at, ...}.
  function peaksOf(motors) {
    const peaks = [['torque φ', 'peak_torque_phi', 'N m'], ['torque θ', 'peak_torque_theta', 'N m'], ['power', 'peak_power', 'W']];
    return Object.fromEntries(peaks.filter(([, key]) => typeof motors[key] === 'number').map(([name, key, unit]) => {
      const shown = text.shownIn(unit, Math.abs(motors[key])), at = motors[`${key}_at`];
      return [name, `${text.number(motors[key] * shown.factor)} ${shown.unit}${typeof at === 'number' ? ` at ${text.number(at, 6)} s` : ''}`];
    }));
  }

  function rowsNote(run) {
    const kept = run.t.length - (run.hasEndRow ? 1 : 0);
    const end = run.hasEndRow ? ' After them comes the instant at which the run stopped.' : '';
    if (kept === run.rows) return `All ${run.rows} rows are in this page.${end}`;
    return `Of ${run.rows} rows ${kept} are in this page: those with the least and the greatest value of each column in ` +
        `${run.buckets} stretches, and those needed to draw the motion within ` +
        `${run.motionError <= 1 ? 'half a thousandth' : `${text.number(Math.max(1, run.motionError) * 0.05, 2)} %`} of its extent. ` +
        `The result file has all rows.${end}`;
  }

  function section(run) {
    const several = data.runs.length > 1;
    const root = element('section', {class: 'run'}, element('h2', {}, several ? run.name : 'What was run'));
    if (run.title && (several || run.title !== data.scene.title)) root.append(element('p', {}, run.title));
    if (run.status && run.status !== 'done') {
      root.append(element('p', {class: `why ${run.status}`}, element('b', {}, `${run.status} `), run.reason));
    }
    const {scenario, summary} = run;
    if (scenario.text) {
      root.append(Object.assign(card(scenario.file || 'scenario', bbsim.save.copyable(bbsim.highlight(scenario.text), {'aria-label': 'The scenario'}, scenario.text)), {className: 'card text'}));
    }
    if (scenario.overrides.length > 0) {
      root.append(card('Set beside the text', element('pre', {}, scenario.overrides.join('\n'))));
    }
    if (run.events.length > 0) root.append(eventsOf(run));
    if (run.poles && run.poles.values.length > 0) root.append(card('Poles about home', element('figure', {}, ...bbsim.showPoles(run.poles))));
    if (run.check.length > 0) root.append(card('Model', element('pre', {class: 'wrap'}, run.check.join('\n'))));
    if (summary) {
      const {statistics, events, model_notes, motors, measures, expectations, ...rest} = summary;
      root.append(card('Summary', rowsOf(rest)));
      if (measures && Object.keys(measures).length > 0) root.append(card('Measures', rowsOf(measures)));
      if (expectations && expectations.length > 0) {
        root.append(card('Expectations', element('pre', {class: 'wrap'}, expectations.map(({text: words, holds}) => `${holds ? '✓' : '✗'} ${words}`).join('\n'))));
      }
      if (motors && typeof motors === 'object') root.append(card(`Peaks of the motors, with ${motors.carries || 'ball'}`, rowsOf(peaksOf(motors))));
      if (statistics) root.append(card('Statistics', rowsOf(statistics)));
    }
    const notes = [rowsNote(run)];
    if (!run.turns) notes.push('How the ball turns is not known, so it is drawn without marks: the columns ball_qw to ball_qz would show it.');
    else if (!run.orientationGiven) notes.push('The ball is drawn as one that rolls straight from row to row: its orientation was not recorded.');
    if (!run.unitsKnown) notes.push('The units of the file are not known: its summary or --scenario would give them.');
    if (run.version) notes.push(`Run by bbsim ${run.version}.`);
    root.append(element('p', {class: 'fine'}, notes.join(' ')));
    if (several) root.append(element('button', {onclick: () => bbsim.save.csv(run)}, 'Save as CSV'));
    return root;
  }

  function lengthText(value) {
    const shown = text.shownIn('m', Math.abs(value) || 0.1);
    return `${text.number(value * shown.factor)} ${shown.unit}`;
  }

  function eventsOf(run) {
    const list = element('ol', {class: 'events'});
    for (const event of run.events.slice(0, 50)) {
      list.append(element('li', {}, element('button', {class: 'link', onclick: () => {
        bbsim.clock.pause();
        bbsim.clock.seek(event.t);
      }}, `${event.action === 'stop' ? '■' : '◆'} ${text.number(event.t, 6)} s`), ` ${event.name}, ${event.action === 'stop' ? 'stopped' : 'noted'}, ` +
        `at x ${lengthText(event.x)}, y ${lengthText(event.y)}`));
    }
    const more = run.eventCount - 50;
    return card(`Events (${run.eventCount})`, list, more > 0 ? element('p', {class: 'fine'}, `and ${more} more`) : null);
  }

  // Cards stay open or closed when the run changes.
  function fill() {
    const closed = new Set([...container.querySelectorAll('.card:not([open]) h3')].map((one) => one.textContent));
    container.replaceChildren(...data.runs.map(section));
    for (const heading of container.querySelectorAll('.card h3')) {
      if (closed.has(heading.textContent)) heading.closest('.card').open = false;
    }
  }
  fill();
  return {fill};
};
