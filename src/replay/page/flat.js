// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The picture from above, drawn flat in the plate's frame, for browsers with slow 3D or without 3D.
// What stays is painted once, and the trails are added as they grow.
bbsim.makeFlat = (canvas) => {
  const {scene: {stage}, runs, shown} = bbsim.data;
  const {palette, text, visible} = bbsim;
  const [lead] = runs;
  const inkOf = (one) => one.getContext('2d', {willReadFrequently: true});
  const ink = inkOf(canvas), ground = inkOf(document.createElement('canvas')), base = inkOf(document.createElement('canvas'));
  let width = 0, height = 0, ratio = 1, scale = 1, waiting = false, stale = true;
  // For each run, the row up to which its trail is in `base`, the trail's length, and the ball's place.
  const trails = runs.map((run) => ({run, until: 0, along: 0, place: [0, 0]}));
  const turned = new THREE.Quaternion(), point = new THREE.Vector3();

  // From the plane to the canvas.
  const px = (x) => width / 2 + x * scale, py = (y) => height / 2 - y * scale;

  function setSize(box = canvas.parentElement.getBoundingClientRect(), most = 0) {
    ratio = Math.max(Math.min(Math.max(window.devicePixelRatio || 1, 1), 2), most);
    [width, height] = [Math.max(1, Math.round(box.width * ratio)), Math.max(1, Math.round(box.height * ratio))];
    // Leaves room for the dial and the buttons: beside the plate, or on a narrow screen above and
    // below it.
    const [beside, above] = box.width > 560 ? [104, 54] : [14, 88];
    scale = Math.min(Math.max(width - 2 * beside * ratio, 0.5 * width) / stage.width, Math.max(height - 2 * above * ratio, 0.5 * height) / stage.depth);
    for (const one of [ink, ground, base]) [one.canvas.width, one.canvas.height] = [width, height];
    stale = true;
  }

  function pen(on, colour, line, dash = []) {
    Object.assign(on, {strokeStyle: colour, fillStyle: colour, lineWidth: line * ratio, lineJoin: 'round', lineDashOffset: 0});
    on.setLineDash(dash.map((n) => n * ratio));
    on.beginPath();
  }

  // A line through points; one that is too far away to be drawn leaves a gap.
  function path(on, xs, ys, from = 0, to = xs.length) {
    let joined = false;
    for (let i = from; i < to; ++i) {
      const here = shown(xs[i]) && shown(ys[i]);
      if (here) on[joined ? 'lineTo' : 'moveTo'](px(xs[i]), py(ys[i]));
      joined = here;
    }
    on.stroke();
  }

  function paintAxes(colours, words) {
    const far = 0.13 * Math.max(stage.width, stage.depth) * scale, head = 6 * ratio;
    for (const [name, dx, dy] of [['x', 1, 0], ['y', 0, -1]]) {
      const x = px(0) + dx * far, y = py(0) + dy * far;
      pen(ground, colours[name], 3);
      ground.moveTo(px(0), py(0));
      ground.lineTo(x, y);
      for (const side of [-1, 1]) {
        ground.moveTo(x, y);
        ground.lineTo(x - (dx + side * dy) * head, y - (dy + side * dx) * head);
      }
      ground.stroke();
      words.push({words: name, x: x + dx * 18 * ratio, y: y + dy * 18 * ratio, colour: colours[name]});
    }
  }

  function paintEvents(colours, words) {
    for (const event of bbsim.markedEvents(lead)) {
      if (!shown(event.x) || !shown(event.y)) continue;
      const sides = event.action === 'stop' ? 8 : 4, x = px(event.x), y = py(event.y);
      pen(ground, '#14181e', 2);
      for (let i = 0; i < sides; ++i) {
        const angle = 2 * Math.PI * (i + (sides === 8 ? 0.5 : 0)) / sides;
        ground.lineTo(x + 6 * ratio * Math.cos(angle), y + 6 * ratio * Math.sin(angle));
      }
      ground.closePath();
      ground.fillStyle = '#ffd23f';
      ground.fill();
      ground.stroke();
    }
    for (const {name, x, y} of bbsim.namedEvents(lead, 60 * ratio / scale)) {
      if (shown(x) && shown(y)) words.push({words: text.visible(name), x: px(x), y: py(y) - 16 * ratio, colour: colours.ink});
    }
  }

  // The plate with its marks, and the whole path of the leading run, pale.
  function paintGround() {
    const colours = palette.now(), words = [], across = stage.width * scale;
    ground.fillStyle = colours.background;
    ground.fillRect(0, 0, width, height);
    ground.save();
    ground.translate(px(-stage.width / 2), py(stage.depth / 2));
    ground.beginPath();
    if (stage.round) ground.arc(across / 2, across / 2, across / 2, 0, 2 * Math.PI);
    else ground.rect(0, 0, across, stage.depth * scale);
    ground.clip();
    bbsim.gimbal.paintPlate(ground, across, stage.depth * scale, colours);
    ground.restore();
    if (visible.axes) paintAxes(colours, words);
    if (visible.reference && lead.path.length >= 4) {
      pen(ground, colours.reference, 2, [7, 5]);
      path(ground, ...[0, 1].map((axis) => lead.path.filter((_, i) => i % 2 === axis)));
    }
    if (visible.trail && lead.shown) {
      pen(ground, palette.run(0), 2, [5, 3]);
      ground.globalAlpha = colours.faint;
      path(ground, lead.values('x'), lead.values('y'));
      ground.globalAlpha = 1;
    }
    if (visible.events) paintEvents(colours, words);
    bbsim.writeWords(ground, words, ratio);
  }

  // Adds the new part of the trails, or all of it if time has gone back.
  function paintTrails(t) {
    const rows = runs.map((run) => run.row(t));
    if (stale || trails.some(({until}, i) => rows[i] < until)) {
      base.drawImage(ground.canvas, 0, 0);
      for (const trail of trails) Object.assign(trail, {until: 0, along: 0});
    }
    stale = false;
    for (const [i, trail] of trails.entries()) {
      const {run, until} = trail, xs = run.values('x'), ys = run.values('y');
      trail.until = rows[i];
      if (rows[i] === until || !visible.trail || !run.shown) continue;
      pen(base, palette.run(run.index), 3, (i > 0 && palette.dash(run.index)) || []);
      base.lineDashOffset = trail.along;  // dashes go on from piece to piece
      path(base, xs, ys, until, rows[i] + 1);
      for (let k = until + 1; i > 0 && k <= rows[i]; ++k) trail.along += scale * Math.hypot(xs[k] - xs[k - 1], ys[k] - ys[k - 1]) || 0;
    }
  }

  function paintPlus(x, y, from, to) {
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      ink.moveTo(px(x) + dx * from, py(y) + dy * from);
      ink.lineTo(px(x) + dx * to, py(y) + dy * to);
    }
  }

  // The ball from above, with the three circles that part the octants of ball.js, and their dot.
  function paintBall({run, place: [x, y]}, colours) {
    const radius = run.ball.radius * scale, ring = radius < 5 * ratio, light = ink.createRadialGradient(
        px(x) - 0.3 * radius, py(y) - 0.4 * radius, 0, px(x), py(y), radius);
    light.addColorStop(0, 'rgba(255, 255, 255, .35)');
    light.addColorStop(1, 'rgba(0, 0, 0, .4)');
    ink.globalAlpha = run === lead ? 1 : 0.75;
    for (const [colour, size] of ring ? [[colours.ink, 2.5], [palette.run(run.index), 1.5]] : []) {
      pen(ink, colour, 2 * size);
      ink.arc(px(x), py(y), 8 * ratio, 0, 2 * Math.PI);
      ink.stroke();
    }
    pen(ink, palette.run(run.index), 1);
    ink.arc(px(x), py(y), radius, 0, 2 * Math.PI);
    ink.fill();
    const at = (a, b, c) => point.set(a, b, c).normalize().applyQuaternion(turned);
    if (run.turns) {
      run.orientationAt(bbsim.clock.now, turned);
      pen(ink, colours.cream, Math.max(1, 0.14 * radius / ratio));
      for (let circle = 0; circle < 3; ++circle) {
        for (let i = 0, joined = false; i <= 48; ++i) {
          const [a, b] = [Math.cos(i * Math.PI / 24), Math.sin(i * Math.PI / 24)];
          at(...[[a, b, 0], [0, a, b], [b, 0, a]][circle]);
          if (point.z > 0) ink[joined ? 'lineTo' : 'moveTo'](px(x) + point.x * radius, py(y) - point.y * radius);
          joined = point.z > 0;
        }
      }
      ink.stroke();
      pen(ink, '#14181e', 1);
      at(0.53, 0.66, 0.53);
      if (point.z > 0) ink.arc(px(x) + point.x * radius, py(y) - point.y * radius, 0.18 * radius, 0, 2 * Math.PI);
      ink.fill();
    }
    ink.fillStyle = light;
    ink.beginPath();
    ink.arc(px(x), py(y), radius, 0, 2 * Math.PI);
    ink.fill();
    ink.globalAlpha = 1;
  }

  function draw() {
    waiting = false;
    if (width === 0) setSize();
    const t = bbsim.clock.now, colours = palette.now();
    if (stale) paintGround();
    paintTrails(t);
    ink.drawImage(base.canvas, 0, 0);
    pen(ink, colours.sensor, 2);
    for (const [x, y] of visible.sensor ? bbsim.lastSeen(lead, t) : []) if (shown(x) && shown(y)) paintPlus(x, y, 0, 5 * ratio);
    ink.stroke();
    const [x, y] = ['x', 'y'].map((name, axis) => lead.at(t, `${name}_reference`, lead.path[axis]));
    if (visible.reference && (lead.hasReference || lead.path.length === 2) && shown(x) && shown(y)) {
      const far = Math.max(1.45 * lead.ball.radius * scale, 9 * ratio);
      pen(ink, colours.reference, 2);
      ink.arc(px(x), py(y), far, 0, 2 * Math.PI);
      paintPlus(x, y, far - 4 * ratio, far + 4 * ratio);
      ink.stroke();
    }
    for (const trail of [...trails].reverse()) {
      const found = trail.run.placeAt(t);
      if (Array.isArray(found)) trail.place = found;
      if (trail.run.shown && found !== 'beyond') paintBall(trail, colours);
    }
  }
  function ask() {
    if (waiting || !flat.active) return;
    waiting = true;
    requestAnimationFrame(() => { if (waiting) draw(); });
  }
  function invalidate() {
    stale = true;
    ask();
  }

  const flat = {
    canvas, draw, invalidate, lead, factor: 1,
    get zoom() { return ratio; },
    active: false,
    resize() {
      const box = canvas.parentElement.getBoundingClientRect();
      if (!flat.active || (Math.round(box.width * ratio) === width && Math.round(box.height * ratio) === height)) return;
      setSize();
      draw();
    },
    whole() {
      draw();
      return canvas;
    },
    print(w, h) {
      setSize({width: w, height: h}, 2);
      return flat.whole();
    },
    printed() {
      setSize();
      draw();
    },
    // The point [x, y] of the plate at a point of the window, CSS pixels.
    plateAt(left, top) {
      const box = canvas.getBoundingClientRect();
      return [((left - box.left) / box.width * width - width / 2) / scale, (height / 2 - (top - box.top) / box.height * height) / scale];
    },
    // The center of the leading ball in the window, CSS pixels.
    ballOnScreen() {
      if (width === 0) setSize();
      const box = canvas.getBoundingClientRect(), found = lead.placeAt(bbsim.clock.now);
      const [x, y] = Array.isArray(found) ? found : trails[0].place;
      return [box.left + px(x) / width * box.width, box.top + py(y) / height * box.height];
    },
  };
  bbsim.clock.onTime(ask);
  palette.onChange(invalidate);
  bbsim.data.onChange(({sameStage}) => {
    for (const trail of trails) trail.place = [0, 0];
    if (!sameStage) width = 0;  // measures the room anew
    invalidate();
  });
  return flat;
};
