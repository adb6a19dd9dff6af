// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Copies a canvas for printing: one that is redrawn during printing may be printed empty, as may a
// 3D canvas.
bbsim.copyForPaper = (from) => {
  const made = bbsim.text.element('canvas', {class: 'printed'});
  [made.width, made.height] = [from.width, from.height];
  let ink = from.getContext('2d');
  if (!ink) {
    ink = Object.assign(document.createElement('canvas'), {width: from.width, height: from.height}).getContext('2d', {willReadFrequently: true});
    ink.drawImage(from, 0, 0);
  }
  made.getContext('2d').putImageData(ink.getImageData(0, 0, from.width, from.height), 0, 0);
  return made;
};
