// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The text of a live page's scenario. `take(text)` gets it when typing pauses.
bbsim.makeEditor = ({yaml, take}) => {
  const {element} = bbsim.text;
  const area = element('textarea', {class: 'editor', spellcheck: 'false', 'aria-label': 'The scenario, YAML', rows: '16'});
  area.value = yaml;
  const root = element('details', {class: 'card'}, element('summary', {}, element('h3', {}, 'Text')), area);
  let typing = 0;
  // Takes what was typed at once, before another change.
  function flush() {
    if (typing === 0) return;
    clearTimeout(typing);
    typing = 0;
    take(area.value);
  }
  area.addEventListener('input', () => {
    clearTimeout(typing);
    typing = setTimeout(flush, 300);
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
