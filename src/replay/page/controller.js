// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The viewer's own controller in a live page: a script with step(sample), as in
// docs/reference/controllers.md. `use(script)` lets it control, and use('') the scenario's law.

// The text of a scenario with this script as comments, since no key of bbsim holds it.
bbsim.withController = (yaml, script) => {
  if (script === '') return yaml;
  const lines = script.trimEnd().split('\n').map((line) => `# ${bbsim.text.visible(line)}`.trimEnd());
  return ['# A controller of the page ran in place of the law, which bbsim runs from this file. The controller is at the end.',
          yaml.trimEnd(), '', '# The controller of the page, JavaScript:', ...lines, ''].join('\n');
};

bbsim.makeControllerCard = (use) => {
  const {element} = bbsim.text;
  const {examples} = bbsim;
  const area = element('textarea', {class: 'editor', spellcheck: 'false', rows: '14', 'aria-label': 'The controller, JavaScript'});
  area.value = examples.PD;
  let mine = null;  // what the viewer wrote, while an example is shown
  const own = element('option', {value: '', hidden: true}, 'Yours');
  const choice = element('select', {'aria-label': 'Begin from'}, ...Object.keys(examples).map((name) => element('option', {value: name}, name)), own);
  choice.addEventListener('change', () => {
    if (!Object.values(examples).includes(area.value)) mine = area.value;
    own.hidden = mine === null;
    area.value = choice.value === '' ? mine : examples[choice.value];
  });
  const off = element('button', {'aria-disabled': 'true', onclick: () => { if (off.getAttribute('aria-disabled') !== 'true') use(''); }}, 'Use the scenario\'s law');
  const on = element('button', {onclick: () => use(area.value)}, 'Use this controller');
  const root = element('details', {class: 'card'}, element('summary', {}, element('h3', {}, 'Your controller')),
                       element('p', {class: 'buttons'}, choice, on, off), area,
                       element('p', {class: 'fine'}, 'step(sample) gets {sample, t, ball, reference, reference_rate, reference_acceleration, servo, servo_rate, period} in SI units, once a sampling period, and returns [phi, theta]. It runs in this page alone, without network.'));
  return {
    root,
    // Shows a script from elsewhere. It runs when the viewer uses it.
    offer(script) {
      area.value = mine = script;
      own.hidden = false;
      choice.value = '';
      root.open = true;
      root.scrollIntoView({block: 'nearest'});
    },
    // The script that controls now.
    show(script) {
      off.setAttribute('aria-disabled', String(script === ''));
      if (script !== '') area.value = script;
    },
  };
};
