// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Formulas, tables, and what the copy buttons copy.
(() => {
  // If a table is wider than a phone, numbers and names are not broken, and sentences have room.
  for (const cell of document.querySelectorAll('.md-typeset td')) {
    const {length} = cell.textContent;
    if (length <= 14) cell.classList.add('short');
    else if (length >= 30) cell.classList.add('long');
  }

  // Cells are measured before formulas are in them.
  for (const element of document.querySelectorAll('.arithmatex')) {
    const text = element.textContent.trim();
    // \( ... \) in a line, \[ ... \] on lines of its own.
    katex.render(text.slice(2, -2), element, {displayMode: text.startsWith('\\['), throwOnError: false});
  }

  // A copy button copies only the commands, without prompts and output. Its text must be set before the theme's
  // own listener reads it.
  document.addEventListener('click', (event) => {
    const button = event.target.closest('[data-clipboard-target]');
    const block = button && button.closest('.language-console');
    if (!block) return;
    const commands = [];
    let goesOn = false;
    for (const line of block.querySelector('code').textContent.split('\n')) {
      if (goesOn) commands.push(line);
      else if (line.startsWith('$ ')) commands.push(line.slice(2));
      else continue;
      goesOn = line.endsWith('\\');
    }
    button.dataset.clipboardText = commands.join('\n');
  }, true);
})();
