// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The changes of a live page in its address: keys, and the viewer's controller. A link's changes are
// shown before they are applied. `changes()` returns {set: [[key, value], ...], script}; `apply(set)`
// sets keys, and `bring(script)` shows a controller, which is not run.
bbsim.makeLink = ({changes, apply, bring}) => {
  const {element} = bbsim.text;
  const root = element('div', {});
  let offered = '';  // a link's part of the address, until it is applied or ignored
  const fragmentOf = ({set, script}) => [set.length > 0 ? `set=${encodeURIComponent(JSON.stringify(set))}` : '',
                                         script ? `controller=${encodeURIComponent(script)}` : ''].filter(Boolean).join('&');

  function readSet() {
    const isSetting = (one) => Array.isArray(one) && one.length === 2 && one.every((words) => typeof words === 'string' && words.length <= 1000);
    try {
      const wanted = JSON.parse(bbsim.address.said('set'));
      return Array.isArray(wanted) && wanted.length <= 100 && wanted.every(isSetting) ? wanted : [];
    } catch {
      return [];
    }
  }

  function offer() {
    const set = readSet(), script = bbsim.address.said('controller') || '';
    if (set.length === 0 && !script) return;
    offered = fragmentOf({set, script});
    const end = () => {
      offered = '';
      root.replaceChildren();
    };
    const button = (words, action) => element('button', {onclick: action}, words);
    root.replaceChildren(element('div', {class: 'offer', role: 'group', 'aria-label': 'Changes of this link'},
                                 ...(set.length > 0 ? [element('p', {}, 'This link changes the scenario:'),
                                                       element('ul', {}, ...set.map(([key, value]) => element('li', {}, element('code', {}, `${key} = ${value}`))))] : []),
                                 ...(script ? [element('p', {}, 'This link brings a controller. Apply it to have it in Your controller; press Use this controller there to run it.'),
                                               element('pre', {}, script)] : []),
                                 element('p', {class: 'buttons'}, button('Apply', () => {
                                   end();
                                   if (set.length > 0) apply(set);
                                   if (script) bring(script);
                                 }), button('Ignore', end))));
  }
  offer();
  window.addEventListener('hashchange', offer);

  return {
    root,
    // A part of the page's address; may be empty.
    fragment: () => offered || fragmentOf(changes()),
  };
};
