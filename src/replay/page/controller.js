// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The viewer's own controller in a live page: a script with step(sample), as in
// docs/reference/controllers.md, and three to begin from.
bbsim.makeControllerCard = (use) => {
  const {element} = bbsim.text;
  const script = element('textarea', {class: 'editor', spellcheck: 'false', rows: '14', 'aria-label': 'The controller, JavaScript'});
  const choice = element('select', {'aria-label': 'Begin from', onchange: () => { script.value = bbsim.examples[choice.value]; }},
                         ...Object.keys(bbsim.examples).map((name) => element('option', {value: name}, name)));
  script.value = bbsim.examples.PD;
  const off = element('button', {type: 'button', disabled: true, onclick: () => {
    off.disabled = true;
    use('');
  }}, 'Use the scenario\'s law');
  const on = element('button', {type: 'button', onclick: () => {
    off.disabled = false;
    use(script.value);
  }}, 'Use this controller');
  return element('details', {class: 'card'}, element('summary', {}, element('h3', {}, 'Your controller')),
                 element('p', {class: 'buttons'}, choice, on, off), script,
                 element('p', {class: 'fine'}, 'step(sample) gets {sample, t, ball, reference, reference_rate, reference_acceleration, servo, servo_rate, period} in SI units, once a sampling period, and returns [phi, theta]. It runs in this page alone, without network.'));
};
