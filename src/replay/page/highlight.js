// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Colors a scenario's YAML for reading: comments, keys, strings, numbers. Makes text nodes only.
bbsim.highlight = (source) => {
  const {element, visible} = bbsim.text;
  const token = /(#[^\n]*)|("(?:[^"\\\n]|\\.)*"?|'(?:[^'\n]|'')*'?)|([A-Za-z_][\w.]*)(?=\s*:(?:\s|$))|([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.]))|([A-Za-z_][\w./()-]*)/g;
  const kinds = ['comment', 'string', 'key', 'number', null];
  const code = element('code', {});
  let last = 0;
  for (const found of source.matchAll(token)) {
    const kind = kinds[found.slice(1).findIndex((part) => part !== undefined)];
    if (!kind) continue;
    // A # directly after other text does not begin a comment.
    if (kind === 'comment' && found.index > 0 && !/\s/.test(source[found.index - 1])) continue;
    code.append(visible(source.slice(last, found.index)), element('span', {class: kind}, found[0]));
    last = found.index + found[0].length;
  }
  code.append(visible(source.slice(last)));
  return code;
};
