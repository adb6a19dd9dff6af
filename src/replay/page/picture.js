// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The picture at the clock's time: rig, ball, trail, reference, sensor points and events. It is
// drawn only after a change.
bbsim.makePicture = (canvas, left) => {
  const {scene, runs} = bbsim.data;
  const {stage} = scene;
  const {palette, paint, text, visible} = bbsim;
  const [lead] = runs;

  // The canvas gets its final size at the start, so that its buffers are made once.
  const sizeOf = () => {
    const box = canvas.parentElement.getBoundingClientRect();
    return [Math.max(1, Math.round(box.width)), Math.max(1, Math.round(box.height))];
  };
  let [width, height] = [canvas.width, canvas.height] = sizeOf();
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: false});
  renderer.debug.checkShaderErrors = false;  // a check would wait for each shader's compilation
  const sharp = () => Math.min(Math.max(window.devicePixelRatio || 1, 1), 2);
  if (sharp() > 1) renderer.setPixelRatio(sharp());
  // World coordinates are meters. The eye sees the longest side as 1, because floats of a graphics
  // card do not cover all sizes.
  const root = new THREE.Scene(), world = new THREE.Group();
  root.background = new THREE.Color();
  root.add(world);

  const plate = text.element('canvas', {width: 1024, height: 1024});
  const plateTexture = new THREE.CanvasTexture(plate);
  plateTexture.anisotropy = 4;
  const materials = {
    face: paint.lit({map: plateTexture, gloss: 0.16}),
    slab: paint.lit({gloss: 0.05}),
    frame: paint.lit({gloss: 0.25}),
    axle: paint.lit({gloss: 0.4}),
    metal: paint.lit({gloss: 0.15}),
    reference: paint.flat(), target: paint.flat(), x: paint.flat(),
    y: paint.flat(), event: paint.flat(), eventRim: paint.flat(), sensor: paint.flat({transparent: true, opacity: 0.85}),
    rim: paint.flat({depthTest: false}),
  };
  const labels = [];  // {words, colour, at, group}: at a place of the plate while the group is visible
  const words = document.getElementById('words').getContext('2d');
  // What furnish() makes of the runs.
  const rig = {}, parts = {};
  let arrows, size, trailWidth, layers, marks, ribbons, actors, leader, floor, target, targetLeast, seen;

  // Puts an object on the plate, in layer n.
  const layer = (n, near = 1) => lead.mounting.height + n * 0.00025 * size * near;
  function onPlate(object, n, plane = rig.plane) {
    layers.push({object, n});
    object.position.z = layer(n);
    object.traverse((part) => { part.renderOrder += n; });
    plane.add(object);
    return object;
  }

  function ribbonOf(part, make) {
    const material = paint.flat({spread: part * trailWidth});
    ribbons.push({material, width: part * trailWidth});
    return make(material);
  }

  // Removes everything, with its memory on the graphics card.
  function clear() {
    for (const group of [world, ...actors.map(({marker}) => marker)]) {
      group.traverse((part) => { if (part.geometry) part.geometry.dispose(); });
    }
    root.remove(...actors.map(({marker}) => marker));
    world.remove(...world.children);
    for (const {material} of ribbons) material.dispose();
    for (const {ball} of actors) ball.dispose();
  }

  // Builds the rig, the balls, trails, reference, sensor points and events.
  function furnish() {
    if (actors) clear();
    size = Math.max(stage.width, stage.depth);
    world.scale.setScalar(1 / size);
    trailWidth = 0.0055 * size;
    layers = [];
    marks = [];  // do not grow on the screen when the eye comes near
    ribbons = [];  // materials of ribbons, and their greatest widths
    Object.assign(rig, bbsim.gimbal.build(lead, materials));
    world.add(rig.base);
    floor = paint.shadow(0.3);
    floor.scale.set(0.62 * stage.width + 0.124 * size, 0.62 * stage.depth + 0.161 * size, 1);
    floor.position.z = -rig.foot - 0.012 * size;
    world.add(floor);

    Object.assign(parts, {axes: new THREE.Group(), events: new THREE.Group(), reference: new THREE.Group(), sensor: new THREE.Group(), arrows: new THREE.Group()});
    for (const group of Object.values(parts)) rig.plane.add(group);
    for (const axis of ['x', 'y']) {
      onPlate(paint.arrow(axis, 0.13 * size, 0.0085 * size, materials[axis]), 2, parts.axes);
    }

    arrows = bbsim.makeArrows(lead, rig.plane, 0.3 * size, {velocity: materials.x, gravity: materials.rim, 'normal force': materials.y});
    parts.arrows.add(...Object.values(arrows.meshes));

    // The balls and trails of all runs. The leading run is on the rig's plate; a run with angles has
    // a ghost plate.
    actors = runs.map((run) => {
      const leads = run === lead;
      const edge = paint.flat({transparent: true, opacity: 0.7});
      const links = leads ? rig : run.hasAngles ? bbsim.gimbal.buildGhost(run, edge) : null;
      if (links && !leads) world.add(links.base);
      const plane = links ? links.plane : rig.plane;
      const ball = bbsim.ball.build(run);
      ball.mesh.renderOrder = 10;
      plane.add(ball.mesh);
      const xs = run.values('x'), ys = run.values('y');
      const pattern = leads ? null : palette.dash(run.index);
      const dash = pattern && pattern.slice(0, 2).map((n) => n * 0.0022 * size);
      const past = ribbonOf(1, (material) => new THREE.Mesh(paint.ribbon(xs, ys, trailWidth, dash), material));
      // A ribbon of length 1 along x, with the width of its material.
      const tip = new THREE.Mesh(paint.ribbon([-0.5, 0.5], [0, 0], 1, [2, 0]), past.material);
      const future = ribbonOf(0.9, (material) => new THREE.Mesh(
          leads ? paint.ribbon(xs, ys, 0.9 * trailWidth, [0.02 * size, 0.009 * size]) : past.geometry.clone(), material));
      future.visible = leads;
      const shadow = paint.shadow(0.55);
      shadow.scale.set(1.5 * run.ball.radius, 1.5 * run.ball.radius, 1);
      onPlate(future, 3, plane);
      onPlate(past, 5, plane);
      onPlate(tip, 5, plane);
      onPlate(shadow, 8, plane);
      const marker = paint.marker(paint.flat({depthTest: false}), materials.rim);
      root.add(marker);
      return {run, leads, links, plane, ball, past, tip, future, shadow, edge, marker};
    });
    leader = actors[0];

    if (lead.path.length >= 4) {
      const xs = lead.path.filter((_, i) => i % 2 === 0), ys = lead.path.filter((_, i) => i % 2 === 1);
      onPlate(ribbonOf(0.75, (material) => {
        materials.reference = material;
        return new THREE.Mesh(paint.ribbon(xs, ys, 0.75 * trailWidth, [0.012 * size, 0.009 * size]), material);
      }), 4, parts.reference);
    }
    target = onPlate(paint.target(Math.max(1.45 * lead.ball.radius, 0.02 * size), materials.target), 7, parts.reference);
    target.visible = lead.hasReference || lead.path.length === 2;
    targetLeast = 1.45 * lead.ball.radius / Math.max(1.45 * lead.ball.radius, 0.02 * size);

    // The last points of the sensor.
    seen = [];
    if (lead.isMeasured) {
      for (let i = 0; i < 12; ++i) seen.push(onPlate(paint.cross(0.016 * size, materials.sensor), 6, parts.sensor));
      marks.push(...seen);
    }

    for (const event of bbsim.markedEvents(lead)) {
      const mark = onPlate(paint.eventMark(event.action, 0.016 * size, materials.event, materials.eventRim), 6, parts.events);
      mark.position.x = event.x;
      mark.position.y = event.y;
      marks.push(mark);
    }
    makeLabels();
  }

  function makeLabels() {
    const high = layer(2) + 0.02 * size, add = (words, colour, at, group) => labels.push({words, colour, at, group});
    labels.length = 0;
    add('x', 'x', new THREE.Vector3(0.155 * size, 0, high), parts.axes);
    add('y', 'y', new THREE.Vector3(0, 0.155 * size, high), parts.axes);
    for (const [words, colour] of [['velocity', 'x'], ['gravity', 'ink'], ['normal force', 'y']]) add(words, colour, arrows.meshes[words].tip, arrows.meshes[words]);
    for (const {name, x, y} of bbsim.namedEvents(lead, 0.08 * size)) {
      add(text.visible(name), 'ink', new THREE.Vector3(x, y, high + Math.max(0.03 * size, 2.6 * lead.ball.radius)), parts.events);
    }
  }

  furnish();

  // The size of a pixel at distance 1.
  const pixelSize = () => 2 * Math.tan(eyes.fov * Math.PI / 360) / height;

  // Writes the labels on a canvas above the picture.
  function writeLabels() {
    const ratio = Math.max(1, renderer.getPixelRatio()), colours = palette.now();
    Object.assign(words.canvas, {width: Math.round(width * ratio), height: Math.round(height * ratio)});
    const shown = labels.filter(({group}) => group.visible && group.parent.visible)
        .map((one) => ({...one, on: one.at.clone().applyMatrix4(rig.plane.matrixWorld).project(eyes.camera)})).filter(({on}) => on.z < 1);
    bbsim.writeWords(words, shown.map(({words: name, colour, on}) => ({
      words: name, colour: colours[colour], x: (on.x + 1) / 2 * width * ratio, y: (1 - on.y) / 2 * height * ratio,
    })), ratio);
  }

  // Adapts sizes to the screen. Ribbons and marks do not grow when the eye comes near. Balls that
  // are too small to be seen get markers.
  function sizeToScreen() {
    const near = Math.min(1, eyes.farness()), pixel = pixelSize();
    for (const {material, width: most} of ribbons) material.spread.value = most * near;
    for (const {object, n} of layers) object.position.z = layer(n, near);
    for (const mark of marks) mark.scale.setScalar(near);
    target.scale.setScalar(Math.max(near, targetLeast));
    for (const {ball, marker, run} of actors) {
      const place = ball.mesh.getWorldPosition(new THREE.Vector3());
      const deep = -place.clone().applyMatrix4(eyes.camera.matrixWorldInverse).z;
      marker.visible = ball.mesh.visible && deep > 0 && run.ball.radius / size < 7 * pixel * deep;
      if (marker.visible) paint.face(marker, place, eyes.camera, pixel);
    }
    root.updateMatrixWorld(true);
  }

  function recolour() {
    const colours = palette.now();
    root.background.set(colours.background);
    paint.lights.sky.value.set(colours.sky).multiplyScalar(colours.hemisphere);
    paint.lights.earth.value.set(colours.earth).multiplyScalar(colours.hemisphere);
    paint.lights.lampColour.value.setScalar(colours.light);
    bbsim.gimbal.paintPlate(plate.getContext('2d', {willReadFrequently: true}), plate.width, plate.height, colours);
    plateTexture.needsUpdate = true;
    for (const name of ['frame', 'metal', 'reference', 'x', 'y', 'sensor']) materials[name].color.set(colours[name]);
    for (const [name, colour] of Object.entries({slab: 'grid', axle: 'rim', target: 'reference', rim: 'ink'})) materials[name].color.set(colours[colour]);
    materials.event.color.set('#ffd23f');
    materials.eventRim.color.set('#14181e');
    for (const actor of actors) {
      const colour = palette.run(actor.run.index);
      actor.ball.colour(colours.cream, colour);
      actor.past.material.color.set(colour);
      // The plate shines through the trail ahead.
      actor.future.material.color.set(colours.plate).lerp(new THREE.Color(colour), colours.faint);
      actor.edge.color.set(colour);
      actor.marker.children[1].material.color.set(colour);
    }
    invalidate();
  }

  let factor = 1, waiting = false, forced = false, pixels = 1;
  const turn = new THREE.Quaternion();
  let last = runs.map(() => [0, 0]);
  // An unknown angle is drawn level; the page says so.
  const angle = (run, t, name) => run.angleAt(t, name) || 0;

  // Moves everything to its place at time t. Returns all numbers that the picture depends on.
  function pose(t) {
    const state = [factor * angle(lead, t, 'phi'), factor * angle(lead, t, 'theta')];
    // The servos' angles do not fit exaggerated tilts.
    const servos = factor === 1 && lead.legs ? lead.servosAt(t) : null;
    rig.set(...state, servos);
    if (servos) state.push(...servos);
    for (const actor of actors) {
      const {run} = actor;
      if (actor.links && !actor.leads) {
        const angles = [factor * angle(run, t, 'phi'), factor * angle(run, t, 'theta')];
        actor.links.set(...angles);
        state.push(...angles);
      }
      // If a row has no number, the ball stays where it was. A ball that is too far away is not
      // drawn.
      const found = run.placeAt(t), place = Array.isArray(found) ? found : last[run.index];
      last[run.index] = place;
      const [x, y] = place, height = (actor.links ? run : lead).mounting.height;
      actor.ball.mesh.position.set(x, y, height + run.ball.radius);
      if (actor.leads) rig.ball.copy(actor.ball.mesh.position);
      if (run.turns) actor.ball.mesh.quaternion.copy(run.orientationAt(t, turn));
      const shown = run.shown && found !== 'beyond';
      actor.ball.mesh.visible = shown;
      actor.shadow.visible = shown;
      actor.shadow.position.x = x + 0.12 * run.ball.radius;
      actor.shadow.position.y = y - 0.25 * run.ball.radius;
      const row = run.row(t), {until, reached} = actor.past.geometry;
      actor.past.visible = run.shown && visible.trail;
      actor.future.visible = run.shown && visible.trail && actor.leads;
      actor.past.geometry.setDrawRange(0, until[row + 1]);
      // The tip connects the end of the ribbon with the ball.
      const from = reached[row + 1], dx = x - run.values('x')[from], dy = y - run.values('y')[from], length = Math.hypot(dx, dy);
      actor.tip.visible = shown && visible.trail && from >= 0 && Array.isArray(found) && length > 0;
      if (actor.tip.visible) {
        actor.tip.position.x = x - dx / 2;
        actor.tip.position.y = y - dy / 2;
        actor.tip.rotation.z = Math.atan2(dy, dx);
        actor.tip.scale.x = length;
      }
      if (actor.links && !actor.leads) actor.links.base.visible = run.shown;
      state.push(x, y, shown ? 1 : 0, until[row + 1], from, ...actor.ball.mesh.quaternion.toArray());
    }
    if (target.visible) {
      target.position.x = lead.at(t, 'x_reference', lead.path[0]);
      target.position.y = lead.at(t, 'y_reference', lead.path[1]);
      state.push(target.position.x, target.position.y);
    }
    const points = bbsim.lastSeen(lead, t, seen.length);
    seen.forEach((mark, i) => {
      mark.visible = i < points.length;
      if (mark.visible) [mark.position.x, mark.position.y] = points[i];
    });
    for (const [name, group] of Object.entries(parts)) group.visible = visible[name];
    if (visible.arrows) state.push(...arrows.pose(t, leader.ball.mesh.position));
    for (const part of rig.solids) part.visible = visible.gimbal;
    floor.visible = visible.gimbal;
    root.updateMatrixWorld(true);
    return state;
  }

  let drawn = [];
  function draw(whole = true) {
    waiting = forced = false;
    begun = true;
    const state = pose(bbsim.clock.now);
    eyes.update();
    state.push(...eyes.camera.matrixWorld.elements);
    // Skips a picture in which nothing has moved.
    if (!whole && state.length === drawn.length && state.every((value, i) => value === drawn[i])) return;
    drawn = state;
    sizeToScreen();
    writeLabels();
    renderer.render(root, eyes.camera);
  }
  function ask(whole) {
    forced = forced || whole;
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { if (waiting) draw(forced); });
  }
  function invalidate() {
    if (picture.active) ask(true);
  }

  let begun = false;
  const eyes = bbsim.makeCamera(canvas, rig, {changed: () => picture.active && ask(false), left});

  function setSize(w, h) {
    if (w !== width || h !== height) renderer.setSize(w, h, false);
    [width, height] = [w, h];
    eyes.resize(w, h);
    eyes.refit();
    if (begun) draw();
  }
  // Takes the runs' new content. A picture that is not on the screen waits with it.
  let stale = false;
  function renew() {
    stale = false;
    last = runs.map(() => [0, 0]);
    furnish();
    rig.reach(factor);
    recolour();
    eyes.refit();
  }
  function resize() {
    if (picture.active && stale) renew();
    const [w, h] = sizeOf();
    if (picture.active && !(begun && w === width && h === height)) setSize(w, h);
  }

  const picture = {
    eyes, rig, lead, renderer, canvas,
    get actors() { return actors; },
    active: true,  // is on the screen
    get factor() { return factor; },
    get zoom() { return renderer.getPixelRatio(); },
    // The picture with its labels.
    whole() {
      draw();
      const made = Object.assign(document.createElement('canvas'), {width: canvas.width, height: canvas.height});
      for (const one of [canvas, words.canvas]) made.getContext('2d').drawImage(one, 0, 0, made.width, made.height);
      return made;
    },
    invalidate, resize, draw, recolour,
    // Draws with this part of the pixels; fewer are faster.
    setPixels(part) {
      if (part === pixels) return;
      pixels = part;
      renderer.setPixelRatio(sharp() * part);
      if (picture.active) draw();
    },
    // Draws for paper; the size is in CSS pixels.
    print(w, h) {
      renderer.setPixelRatio(2);
      setSize(w, h);
      return picture.whole();
    },
    printed() {
      renderer.setPixelRatio(sharp() * pixels);
      setSize(...sizeOf());
    },
    exaggerate(value) {
      factor = value;
      rig.reach(value);
      eyes.refit();
      invalidate();
    },
    // The point [x, y] of the plate at a point of the window, CSS pixels; null if there is none.
    plateAt(left, top) {
      const box = canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
      ray.setFromCamera(new THREE.Vector2((left - box.left) / box.width * 2 - 1, 1 - (top - box.top) / box.height * 2), eyes.camera);
      const into = new THREE.Matrix4().getInverse(rig.plane.matrixWorld);
      const from = ray.ray.origin.clone().applyMatrix4(into), to = ray.ray.origin.clone().add(ray.ray.direction).applyMatrix4(into);
      const part = (lead.mounting.height - from.z) / (to.z - from.z);
      return part > 0 && Number.isFinite(part) ? [from.x + part * (to.x - from.x), from.y + part * (to.y - from.y)] : null;
    },
    // The center of the leading ball in the window, CSS pixels.
    ballOnScreen() {
      pose(bbsim.clock.now);
      eyes.update();
      const box = canvas.getBoundingClientRect();
      const centre = leader.ball.mesh.getWorldPosition(new THREE.Vector3()).project(eyes.camera);
      return [box.left + (centre.x + 1) / 2 * box.width, box.top + (1 - centre.y) / 2 * box.height];
    },
    // For tests: the matrices of the projection, column-major, and the canvas in the window.
    view() {
      draw();
      const box = canvas.getBoundingClientRect();
      return {
        view: eyes.camera.matrixWorldInverse.clone().multiply(new THREE.Matrix4().makeScale(1 / size, 1 / size, 1 / size)).toArray(),
        projection: eyes.camera.projectionMatrix.toArray(),
        canvas: [box.left, box.top, box.width, box.height],
      };
    },
  };
  bbsim.clock.onTime(() => picture.active && ask(false));
  palette.onChange(recolour);
  bbsim.data.onChange(() => {
    stale = true;
    if (picture.active) renew();
  });
  return picture;
};
