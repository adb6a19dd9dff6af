'use strict';
// Formulas, the colors of replays, and what the copy buttons take.
(() => {
  for (const element of document.querySelectorAll('.arithmatex')) {
    const text = element.textContent.trim();
    // \( ... \) in a line, \[ ... \] on lines of its own.
    katex.render(text.slice(2, -2), element, {displayMode: text.startsWith('\\['), throwOnError: false});
  }

  const frames = document.querySelectorAll('iframe.replay');
  const theme = () => (document.body.dataset.mdColorScheme === 'slate' ? 'dark' : 'light');
  function paint() {
    for (const frame of frames) frame.src = `${frame.getAttribute('src').split('#')[0]}#theme=${theme()}`;
  }
  if (frames.length > 0) {
    paint();
    new MutationObserver(paint).observe(document.body, {attributes: true, attributeFilter: ['data-md-color-scheme']});
  }

  // Commands alone, without prompts and without what they print.
  for (const block of document.querySelectorAll('.language-console.highlight')) {
    const button = block.querySelector('[data-clipboard-target]');
    if (!button) continue;
    const commands = [];
    let goesOn = false;
    for (const line of block.querySelector('code').textContent.split('\n')) {
      if (goesOn) commands.push(line);
      else if (line.startsWith('$ ')) commands.push(line.slice(2));
      else continue;
      goesOn = line.endsWith('\\');
    }
    button.dataset.clipboardText = commands.join('\n');
  }
})();
