// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Places labels beside points of a picture so that they do not overlap.
bbsim.placeLabels = (wanted) => {
  // wanted: the middle and the size {x, y, width, height} of each label, pixels. Returns how far
  // each one moves up, or null if there is no room for it.
  const placed = [];
  return wanted.map(({x, y, width, height}) => {
    for (let up = 0; up <= 4 * height; up += height) {
      const box = [x - width / 2, y - up - height / 2, x + width / 2, y - up + height / 2];
      if (placed.some((other) => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3])) continue;
      placed.push(box);
      return up;
    }
    return null;
  });
};
