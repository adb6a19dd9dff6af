// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The names that continue the line at the caret of a YAML text: the next parts of `paths` below the
// keys of lesser indentation before it. {from, names}; `from`: where the name begins.
bbsim.completions = (yaml, caret, paths) => {
  const lines = yaml.slice(0, caret).split('\n'), line = lines.pop(), begun = /^( *)(\w*)$/.exec(line);
  if (!begun || /^[^\n]*\S/.test(yaml.slice(caret).split('\n')[0])) return {from: caret, names: []};
  const parents = [];
  let depth = begun[1].length;
  for (const above of lines.reverse()) {
    const key = /^( *)(\w+):\s*(#.*)?$/.exec(above);
    if (depth === 0) break;
    if (/^ *\S/.test(above) && above.search(/\S/) < depth && above[above.search(/\S/)] !== '#') {
      if (!key) return {from: caret, names: []};  // within a list, or below a value
      depth = key[1].length;
      parents.unshift(key[2]);
    }
  }
  const start = parents.map((part) => `${part}.`).join('');
  const names = new Set(paths.filter((path) => path.startsWith(start + begun[2])).map((path) => path.slice(start.length).split('.')[0]));
  names.delete(begun[2]);
  return {from: caret - begun[2].length, names: [...names].filter((name) => /^[a-z]/.test(name))};
};

// The text of a live page's scenario. `take(text)` gets it when typing pauses. `paths()` is fulfilled
// with all keys that a scenario may have.
bbsim.makeEditor = ({yaml, take, paths}) => {
  const {element} = bbsim.text;
  const area = element('textarea', {class: 'editor', spellcheck: 'false', 'aria-label': 'The scenario, YAML', rows: '16'});
  area.value = yaml;
  const offers = element('p', {class: 'buttons offers', 'aria-label': 'Keys that fit here'});
  const root = element('details', {class: 'card'}, element('summary', {}, element('h3', {}, 'Text')), area, offers);
  let typing = 0;
  // Takes what was typed at once, before another change.
  function flush() {
    if (typing === 0) return;
    clearTimeout(typing);
    typing = 0;
    take(area.value);
  }
  const typed = () => {
    clearTimeout(typing);
    typing = setTimeout(flush, 300);
  };
  // Offers the keys that fit at the caret as buttons, which come after the text for the keyboard too.
  async function offer() {
    const {from, names} = bbsim.completions(area.value, area.selectionStart, await paths());
    offers.replaceChildren(...names.slice(0, 12).map((name) => element('button', {onclick: () => {
      area.setRangeText(`${name}: `, from, area.selectionStart, 'end');
      offers.replaceChildren();
      area.focus();
      typed();
    }}, name)));
  }
  area.addEventListener('input', () => {
    typed();
    offer();
  });
  return {
    root, flush,
    // Shows another text, except to someone who writes.
    show(words) {
      if (typing === 0 && document.activeElement !== area && area.value !== words) area.value = words;
    },
    goTo(line) {
      root.open = true;
      const lines = area.value.split('\n'), from = lines.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
      area.focus();
      area.setSelectionRange(from, from + (lines[line - 1] || '').length);
    },
  };
};
