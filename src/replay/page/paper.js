// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A canvas that is redrawn during printing may be printed empty, and so may a 3D canvas. Copies of
// their pixels are printed instead.
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
