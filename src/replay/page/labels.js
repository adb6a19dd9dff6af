// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// What both pictures mark: events, points of the sensor, and labels beside points, which must not
// overlap.

// What is switched on.
bbsim.visible = {trail: true, reference: true, sensor: true, events: true, axes: true, gimbal: true, arrows: false};

// The first hundred events and the last one.
bbsim.markedEvents = (run) => run.events.filter((_, i) => i < 100 || i === run.events.length - 1);

// Those whose names are shown: events of the same name that are close to each other share one.
bbsim.namedEvents = (run, apart) => bbsim.markedEvents(run).reduce((named, event) => {
  const has = named.some(({name, x, y}) => name === event.name && Math.hypot(x - event.x, y - event.y) < apart);
  return has || named.length > 11 ? named : [...named, event];
}, []);

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

// Writes words [{words, x, y, colour}] about points of a canvas, pixels; `ratio`: those of a CSS pixel.
bbsim.writeWords = (ink, words, ratio) => {
  Object.assign(ink, {font: `600 ${14 * ratio}px system-ui, sans-serif`, textAlign: 'center', textBaseline: 'middle',
                      strokeStyle: bbsim.palette.now().plate, lineWidth: 4 * ratio, lineJoin: 'round'});
  ink.setLineDash([]);
  const boxes = words.map((one) => ({...one, width: ink.measureText(one.words).width + 4 * ratio, height: 17 * ratio}));
  bbsim.placeLabels(boxes).forEach((up, i) => {
    if (up === null) return;
    const {words: name, x, y, colour} = words[i];
    ink.fillStyle = colour;
    ink.strokeText(name, x, y - up);
    ink.fillText(name, x, y - up);
  });
};
