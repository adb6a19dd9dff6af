// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The picture from above, drawn flat in the plate's frame, for browsers with slow 3D or without 3D.
// It draws static parts once, and then only the changes.
bbsim.makeFlat = (canvas) => {
  const {scene, runs, shown} = bbsim.data;
  const {stage} = scene;
  const {palette, text} = bbsim;
  const [lead] = runs;
  const visible = {trail: true, reference: true, sensor: true, events: true, axes: true, gimbal: true};
  const make = () => {
    const made = document.createElement('canvas');
    return made.getContext('2d', {willReadFrequently: true});
  };
  const ink = canvas.getContext('2d', {willReadFrequently: true});
  const ground = make(), base = make();  // static parts; these with the trails so far
  let width = 0, height = 0, ratio = 1, scale = 1, waiting = false, stale = true, dirty = [];
  // Parts that move in every frame are small canvases above the large one. A frame draws and
  // composes only these.
  function piece(name) {
    const made = make();
    made.canvas.className = 'piece';
    made.canvas.setAttribute('aria-label', text.visible(name));
    canvas.parentElement.append(made.canvas);
    return made;
  }
  const target = piece('where the ball is wanted');
  // For each run, the row up to which its trail is in `base`. Ghosts are below the leading ball.
  const actors = runs.map((run) => ({run, until: 0, turn: new THREE.Quaternion(), last: [0, 0]}));
  for (const actor of [...actors].reverse()) actor.sprite = piece(`the ball of ${actor.run.name}`);

  // From the plane to the canvas.
  const px = (x) => width / 2 + x * scale, py = (y) => height / 2 - y * scale;
  const least = 5;  // pixels: a smaller ball gets a ring

  function size_(box = canvas.parentElement.getBoundingClientRect(), most = 0) {
    ratio = Math.max(Math.min(Math.max(window.devicePixelRatio || 1, 1), 2), most);
    [width, height] = [Math.max(1, Math.round(box.width * ratio)), Math.max(1, Math.round(box.height * ratio))];
    // Leaves room for the dial and the buttons: beside the plate, or on a narrow screen above and
    // below it.
    const [beside, above] = box.width > 560 ? [104, 54] : [14, 88];
    scale = Math.min(Math.max(width - 2 * beside * ratio, 0.5 * width) / stage.width, Math.max(height - 2 * above * ratio, 0.5 * height) / stage.depth);
    for (const one of [ink, ground, base]) [one.canvas.width, one.canvas.height] = [width, height];
    stale = true;
  }

  function path(into, xs, ys, from, to) {
    let on = false;
    into.beginPath();
    for (let i = from; i < to; ++i) {
      if (!shown(xs[i]) || !shown(ys[i])) {
        on = false;
      } else if (on) {
        into.lineTo(px(xs[i]), py(ys[i]));
      } else {
        into.moveTo(px(xs[i]), py(ys[i]));
        on = true;
      }
    }
    into.stroke();
  }

  const dashOf = (run) => (palette.dash(run.index) || []).map((n) => n * 1.2 * ratio);

  function paintGround() {
    const colours = palette.now(), line = ratio;
    Object.assign(ground, {fillStyle: colours.background, lineJoin: 'round', lineCap: 'butt'});
    ground.fillRect(0, 0, width, height);
    ground.save();
    ground.translate(px(-stage.width / 2), py(stage.depth / 2));
    const plate = document.createElement('canvas');
    [plate.width, plate.height] = [Math.max(1, Math.round(stage.width * scale)), Math.max(1, Math.round(stage.depth * scale))];
    bbsim.gimbal.paintPlate(plate, colours);
    if (stage.round) {
      ground.beginPath();
      ground.arc(plate.width / 2, plate.height / 2, plate.width / 2, 0, 2 * Math.PI);
      ground.clip();
    }
    ground.drawImage(plate, 0, 0);
    ground.restore();
    const words = [];
    if (visible.axes) {
      for (const [name, dx, dy] of [['x', 1, 0], ['y', 0, -1]]) {
        const far = 0.13 * Math.max(stage.width, stage.depth) * scale, [x, y] = [px(0) + dx * far, py(0) + dy * far];
        ground.strokeStyle = ground.fillStyle = colours[name];
        ground.lineWidth = 3 * line;
        ground.beginPath();
        ground.moveTo(px(0), py(0));
        ground.lineTo(x, y);
        ground.stroke();
        ground.beginPath();
        for (const [along, aside] of [[9, 0], [-3, 5], [-3, -5]]) {
          ground.lineTo(x + (dx * along - dy * aside) * line, y + (dy * along + dx * aside) * line);
        }
        ground.fill();
        words.push({words: name, x: x + dx * 18 * line, y: y + dy * 18 * line, colour: colours[name], pixels: 15});
      }
    }
    if (visible.reference && lead.path.length >= 4) {
      ground.strokeStyle = colours.reference;
      ground.lineWidth = 2 * line;
      ground.setLineDash([7 * line, 5 * line]);
      path(ground, lead.path.filter((_, i) => i % 2 === 0), lead.path.filter((_, i) => i % 2 === 1), 0, lead.path.length / 2);
    }
    if (visible.trail && lead.shown) {
      ground.strokeStyle = palette.run(0);
      ground.globalAlpha = colours.faint;
      ground.lineWidth = 2 * line;
      ground.setLineDash([5 * line, 3 * line]);
      path(ground, lead.values('x'), lead.values('y'), 0, lead.t.length);
      ground.globalAlpha = 1;
    }
    ground.setLineDash([]);
    if (visible.events) {
      for (const event of lead.events.filter((_, i) => i < 100 || i === lead.events.length - 1)) {
        if (!shown(event.x) || !shown(event.y)) continue;
        const sides = event.action === 'stop' ? 8 : 4, r = 6 * line;
        ground.beginPath();
        for (let i = 0; i < sides; ++i) {
          const angle = 2 * Math.PI * (i + (sides === 8 ? 0.5 : 0)) / sides;
          ground.lineTo(px(event.x) + r * Math.cos(angle), py(event.y) + r * Math.sin(angle));
        }
        ground.closePath();
        Object.assign(ground, {fillStyle: '#ffd23f', strokeStyle: '#14181e', lineWidth: 2 * line});
        ground.fill();
        ground.stroke();
        if (!words.some((other) => other.words === event.name && Math.hypot(other.x - px(event.x), other.y - py(event.y)) < 60 * line)) {
          words.push({words: text.visible(event.name), x: px(event.x), y: py(event.y) - 16 * line, colour: colours.ink, pixels: 13});
        }
      }
    }
    Object.assign(ground, {textAlign: 'center', textBaseline: 'middle', strokeStyle: colours.plate, lineWidth: 4 * line});
    for (const one of words) {
      ground.font = `600 ${one.pixels * line}px system-ui, sans-serif`;
      Object.assign(one, {width: ground.measureText(one.words).width + 4 * line, height: 1.2 * one.pixels * line});
    }
    bbsim.placeLabels(words).forEach((up, i) => {
      if (up === null) return;
      ground.font = `600 ${words[i].pixels * line}px system-ui, sans-serif`;
      ground.fillStyle = words[i].colour;
      ground.strokeText(words[i].words, words[i].x, words[i].y - up);
      ground.fillText(words[i].words, words[i].x, words[i].y - up);
    });
  }

  // Draws the new part of the trails, or all of it if time has gone back.
  function paintTrails(t) {
    const rows = runs.map((run) => run.row(t));
    if (stale || actors.some((actor, i) => rows[i] < actor.until)) {
      base.drawImage(ground.canvas, 0, 0);
      for (const actor of actors) actor.until = 0;
      dirty = null;
    }
    stale = false;
    for (const [i, actor] of actors.entries()) {
      const {run} = actor;
      if (rows[i] > actor.until && visible.trail && run.shown) {
        const xs = run.values('x'), ys = run.values('y');
        Object.assign(base, {strokeStyle: palette.run(run.index), lineWidth: 3 * ratio, lineJoin: 'round', lineCap: 'round'});
        base.setLineDash(i === 0 ? [] : dashOf(run));
        base.lineDashOffset = actor.along || 0;
        path(base, xs, ys, actor.until, rows[i] + 1);
        let [left, top, right, bottom] = [Infinity, Infinity, -Infinity, -Infinity];
        for (let k = actor.until; k <= rows[i]; ++k) {
          if (!shown(xs[k]) || !shown(ys[k])) continue;
          [left, right] = [Math.min(left, px(xs[k])), Math.max(right, px(xs[k]))];
          [top, bottom] = [Math.min(top, py(ys[k])), Math.max(bottom, py(ys[k]))];
          // Dashes continue from piece to piece.
          if (k > actor.until && shown(xs[k - 1])) actor.along = (actor.along || 0) + scale * (Math.hypot(xs[k] - xs[k - 1], ys[k] - ys[k - 1]) || 0);
        }
        if (dirty && left <= right) dirty.push([left - 3 * ratio, top - 3 * ratio, right + 3 * ratio, bottom + 3 * ratio]);
      }
      actor.until = rows[i];
    }
  }

  const lamp = [-0.23, 0.5, 0.835];
  const rgb = (colour) => { const c = new THREE.Color(colour); return [c.r * 255, c.g * 255, c.b * 255]; };

  // Draws the ball as seen from above: octants as in ball.js, shaded.
  function paintBall(actor, radius) {
    const {sprite, run, turn} = actor, ring = radius < least * ratio;
    const wide = 2 * Math.ceil(Math.max(radius, ring ? 11 * ratio : 0)) + 2, step = Math.max(1, Math.ceil(radius / 60));
    const colours = palette.now(), dark = rgb(palette.run(run.index)), light = rgb(colours.cream);
    if (sprite.canvas.width !== wide) sprite.canvas.width = sprite.canvas.height = wide;
    const image = sprite.createImageData(wide, wide);
    const m = new THREE.Matrix4().makeRotationFromQuaternion(turn).elements;
    for (let j = 0; j < wide; j += step) {
      for (let i = 0; i < wide; i += step) {
        const x = (i + step / 2 - wide / 2) / radius, y = (wide / 2 - j - step / 2) / radius, flat = x * x + y * y;
        const cover = Math.min(1, Math.max(0, (1 - Math.sqrt(flat)) * radius + 0.5));
        if (cover <= 0) continue;
        const z = Math.sqrt(Math.max(0, 1 - flat));
        let colour = dark;
        if (run.turns) {
          const a = m[0] * x + m[1] * y + m[2] * z, b = m[4] * x + m[5] * y + m[6] * z, c = m[8] * x + m[9] * y + m[10] * z;
          if (a * b * c > 0) colour = light;
          if (0.53 * a + 0.66 * b + 0.53 * c > 0.975) colour = [20, 24, 30];
        }
        const shade = 0.62 + 0.42 * Math.max(0, lamp[0] * x + lamp[1] * y + lamp[2] * z);
        for (let dj = 0; dj < step && j + dj < wide; ++dj) {
          for (let di = 0; di < step && i + di < wide; ++di) {
            const at = 4 * ((j + dj) * wide + i + di);
            for (let k = 0; k < 3; ++k) image.data[at + k] = Math.min(255, colour[k] * shade);
            image.data[at + 3] = 255 * cover * (run === lead ? 1 : 0.75);
          }
        }
      }
    }
    sprite.putImageData(image, 0, 0);
    if (!ring) return;
    for (const [colour, line] of [[colours.ink, 5], [palette.run(run.index), 3]]) {
      Object.assign(sprite, {strokeStyle: colour, lineWidth: line * ratio});
      sprite.beginPath();
      sprite.arc(wide / 2, wide / 2, 8 * ratio, 0, 2 * Math.PI);
      sprite.stroke();
    }
  }

  function paintTarget() {
    const r = Math.max(1.45 * lead.ball.radius * scale, 9 * ratio), wide = 2 * Math.ceil(r + 6 * ratio), middle = wide / 2;
    target.canvas.width = target.canvas.height = wide;
    Object.assign(target, {strokeStyle: palette.now().reference, lineWidth: 2 * ratio});
    target.beginPath();
    target.arc(middle, middle, r, 0, 2 * Math.PI);
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      target.moveTo(middle + dx * (r - 4 * ratio), middle + dy * (r - 4 * ratio));
      target.lineTo(middle + dx * (r + 4 * ratio), middle + dy * (r + 4 * ratio));
    }
    target.stroke();
  }

  // Centers a piece at a point of the canvas, or hides it.
  function put(one, x, y, on) {
    const half = one.canvas.width / 2;
    one.at = on ? [x - half, y - half] : null;
    one.canvas.hidden = !on;
    Object.assign(one.canvas.style, {width: `${2 * half / ratio}px`, height: `${2 * half / ratio}px`,
                                     transform: `translate(${(x - half) / ratio}px, ${(y - half) / ratio}px)`});
  }

  // Draws the last points of the sensor and returns their rectangles.
  function paintSeen(t) {
    const boxes = [];
    if (!visible.sensor || !lead.isMeasured) return boxes;
    const xs = lead.values('x_measured'), ys = lead.values('y_measured'), r = 5 * ratio;
    Object.assign(ink, {strokeStyle: palette.now().sensor, lineWidth: 2 * ratio});
    ink.beginPath();
    for (let row = lead.row(t), n = 0; n < 12 && row >= 0 && shown(xs[row]) && shown(ys[row]); ++n) {
      const [x, y] = [xs[row], ys[row]], [cx, cy] = [px(x), py(y)];
      while (row >= 0 && xs[row] === x && ys[row] === y) --row;
      boxes.push([cx - r - ratio, cy - r - ratio, cx + r + ratio, cy + r + ratio]);
      ink.moveTo(cx - r, cy);
      ink.lineTo(cx + r, cy);
      ink.moveTo(cx, cy - r);
      ink.lineTo(cx, cy + r);
    }
    ink.stroke();
    return boxes;
  }

  // Draws the parts that need not follow every frame: the trails and the points of the sensor.
  function drawBase(t = bbsim.clock.now) {
    if (!flat.active || width === 0) return;
    if (stale) {
      paintGround();
      paintTarget();
      dirty = null;
    }
    paintTrails(t);
    if (dirty === null) {
      ink.drawImage(base.canvas, 0, 0);
    } else {
      for (const [left, top, right, bottom] of dirty) {
        const x = Math.max(0, Math.floor(left)), y = Math.max(0, Math.floor(top));
        const w = Math.min(width, Math.ceil(right)) - x, h = Math.min(height, Math.ceil(bottom)) - y;
        if (w > 0 && h > 0) ink.drawImage(base.canvas, x, y, w, h, x, y, w, h);
      }
    }
    dirty = paintSeen(t);
  }

  function drawMoving(t) {
    const x = lead.at(t, 'x_reference', lead.path[0]), y = lead.at(t, 'y_reference', lead.path[1]);
    const wanted = visible.reference && (lead.hasReference || lead.path.length === 2) && shown(x) && shown(y);
    put(target, px(x), py(y), wanted);
    for (const actor of actors) {
      const {run} = actor, found = run.placeAt(t), on = run.shown && found !== 'beyond';
      if (Array.isArray(found)) actor.last = found;
      if (run.turns) run.orientationAt(t, actor.turn);
      const looks = [...actor.turn.toArray(), run.ball.radius * scale, palette.run(run.index)].join();
      if (on && looks !== actor.looks) paintBall(actor, run.ball.radius * scale);
      actor.looks = looks;
      put(actor.sprite, px(actor.last[0]), py(actor.last[1]), on);
    }
  }

  function draw() {
    waiting = false;
    if (width === 0) size_();
    if (stale || !bbsim.clock.playing) drawBase();
    drawMoving(bbsim.clock.now);
    ++flat.draws;
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
    draws: 0,
    resize() {
      if (!flat.active) return;
      const box = canvas.parentElement.getBoundingClientRect();
      if (Math.round(box.width * ratio) === width && Math.round(box.height * ratio) === height) return;
      size_();
      draw();
    },
    // The whole picture in one canvas.
    whole() {
      drawBase();
      drawMoving(bbsim.clock.now);
      const made = make();
      [made.canvas.width, made.canvas.height] = [width, height];
      made.drawImage(canvas, 0, 0);
      for (const one of [target, ...actors.map((actor) => actor.sprite).reverse()]) if (one.at) made.drawImage(one.canvas, ...one.at);
      return made.canvas;
    },
    print(w, h) {
      size_({width: w, height: h}, 2);
      return flat.whole();
    },
    printed() {
      size_();
      draw();
    },
    show(name, on) {
      visible[name] = on;
      invalidate();
    },
    // The point [x, y] of the plate at a point of the window, CSS pixels.
    plateAt(left, top) {
      const box = canvas.getBoundingClientRect();
      return [((left - box.left) / box.width * width - width / 2) / scale, (height / 2 - (top - box.top) / box.height * height) / scale];
    },
    // The center of the leading ball in the window, CSS pixels.
    ballOnScreen() {
      if (width === 0) size_();
      const box = canvas.getBoundingClientRect(), found = lead.placeAt(bbsim.clock.now);
      const [x, y] = Array.isArray(found) ? found : actors[0].last;
      return [box.left + px(x) / width * box.width, box.top + py(y) / height * box.height];
    },
  };
  bbsim.clock.onTime(ask);
  bbsim.clock.onTimeRelaxed(drawBase);
  palette.onChange(invalidate);
  bbsim.data.onChange(({sameStage}) => {
    for (const actor of actors) actor.last = [0, 0];
    if (!sameStage) width = 0;  // measures the room anew
    invalidate();
  });
  return flat;
};
