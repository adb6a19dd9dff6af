// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Saves a picture of the view, and the numbers of the page.
bbsim.save = (() => {
  const {text} = bbsim;

  function offer(blob, name) {
    const url = URL.createObjectURL(blob);
    const link = text.element('a', {href: url, download: name});
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(url), 10000);
  }

  // A file name, made of a result's name without characters that file systems refuse.
  function fileName(name, ending) {
    const stem = name.split('/').pop().replace(/\.(csv|h5|hdf5|yaml|yml)$/i, '').replace(/[^\p{L}\p{N}._-]+/gu, '-');
    return (stem.replace(/^[-.]+/, '') || 'replay') + ending;
  }

  // The shortest decimal that reads back to the same float.
  function float(value) {
    if (!Number.isFinite(value)) return Number.isNaN(value) ? 'nan' : value > 0 ? 'inf' : '-inf';
    for (let digits = 6; digits < 9; ++digits) {
      const short = Number(value.toPrecision(digits));
      if (Math.fround(short) === value) return String(short);
    }
    return String(Number(value.toPrecision(9)));
  }

  function csvOf(run) {
    const columns = [...run.columns.values()];
    const lines = [['t', ...columns.map((column) => column.name)].join(',')];
    for (let row = 0; row < run.t.length; ++row) {
      lines.push([String(run.t[row]), ...columns.map((column) => float(column.values[row]))].join(','));
    }
    return lines.join('\n') + '\n';
  }

  function csv(run) {
    offer(new Blob([csvOf(run)], {type: 'text/csv'}), fileName(run.name, '-page.csv'));
  }

  // The view with its title and time below, as wide as on the screen.
  function png(picture, timeText) {
    const view = picture.whole(), {zoom} = picture, time = timeText(bbsim.clock.now), colours = bbsim.palette.now();
    const canvas = Object.assign(document.createElement('canvas'), {width: view.width, height: view.height + Math.round(34 * zoom)});
    const ink = canvas.getContext('2d');
    ink.fillStyle = colours.background;
    ink.fillRect(0, 0, canvas.width, canvas.height);
    ink.drawImage(view, 0, 0);
    Object.assign(ink, {fillStyle: colours.ink, font: `600 ${15 * zoom}px system-ui, sans-serif`});
    const caption = `${text.visible(bbsim.data.scene.title)}, t = ${time} s${picture.factor === 1 ? '' : `, tilt drawn ${picture.factor} times`}`;
    ink.fillText(caption, 14 * zoom, view.height + 22 * zoom, canvas.width - 28 * zoom);
    canvas.toBlob((blob) => offer(blob, fileName(picture.lead.name, `-${time}s.png`)), 'image/png');
  }

  // A text with a button that copies it. `code` shows it; `words` are copied.
  function copyable(code, attributes = {}, words = code.textContent) {
    const button = text.element('button', {class: 'copy', onclick: async () => {
      try {
        await navigator.clipboard.writeText(words);
        button.textContent = 'Copied';
      } catch {
        // Without access to the clipboard, selects the text, so that one key copies it.
        getSelection().selectAllChildren(code);
        button.textContent = 'Marked';
      }
      setTimeout(() => { button.textContent = 'Copy'; }, 1500);
    }}, 'Copy');
    return text.element('div', {class: 'copyable'}, button, text.element('pre', {tabindex: '0', ...attributes}, code));
  }

  return {copyable, csv, csvOf, png, offer, fileName};
})();
