// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The changes of a live page in its address. A link's changes are shown before they are applied.
// `changes()` returns [[key, value], ...]; `apply` makes them.
bbsim.makeLink = ({changes, apply}) => {
  const {element} = bbsim.text;
  const root = element('div', {});
  let offered = '';  // a link's part of the address, until it is applied or ignored

  function read(part) {
    let wanted;
    try {
      wanted = JSON.parse(decodeURIComponent(part));
    } catch {
      return null;
    }
    const valid = Array.isArray(wanted) && wanted.length > 0 && wanted.length <= 100 &&
        wanted.every((one) => Array.isArray(one) && one.length === 2 && one.every((words) => typeof words === 'string' && words.length <= 1000));
    return valid ? wanted : null;
  }

  function offer() {
    const [, part] = /(?:^|[#&])set=([^&]*)/.exec(location.hash) || [], wanted = part === undefined ? null : read(part);
    if (!wanted) return;
    offered = `set=${part}`;
    const end = () => {
      offered = '';
      root.replaceChildren();
    };
    const button = (words, action) => element('button', {type: 'button', onclick: action}, words);
    root.replaceChildren(element('div', {class: 'offer', role: 'group', 'aria-label': 'Changes of this link'},
                                 element('p', {}, 'This link changes the scenario:'),
                                 element('ul', {}, ...wanted.map(([key, value]) => element('li', {}, element('code', {}, `${key} = ${value}`)))),
                                 element('p', {class: 'buttons'}, button('Apply', () => {
                                   end();
                                   apply(wanted);
                                 }), button('Ignore', end))));
  }
  offer();
  window.addEventListener('hashchange', offer);

  return {
    root,
    // A part of the page's address; may be empty.
    fragment() {
      if (offered) return offered;
      const set = changes();
      return set.length > 0 ? `set=${encodeURIComponent(JSON.stringify(set))}` : '';
    },
  };
};
