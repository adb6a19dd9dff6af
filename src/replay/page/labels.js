// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// What both pictures mark: events, points of the sensor, and labels beside points, which must not
// overlap.

// The first hundred events and the last one.
bbsim.markedEvents = (run) => run.events.filter((_, i) => i < 100 || i === run.events.length - 1);

// The last points [x, y] of the sensor, one for each sample: the rows between two samples repeat it.
bbsim.lastSeen = (run, t, most = 12) => {
  const xs = run.values('x_measured'), ys = run.values('y_measured'), points = [];
  for (let row = run.row(t); run.isMeasured && points.length < most && row >= 0 && Number.isFinite(xs[row] + ys[row]);) {
    const [x, y] = [xs[row], ys[row]];
    points.push([x, y]);
    while (row >= 0 && xs[row] === x && ys[row] === y) --row;
  }
  return points;
};

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
