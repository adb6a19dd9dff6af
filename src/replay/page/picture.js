'use strict';
// The picture: rig, ball, trail, reference, what the sensor saw, and what happened where, at the clock's time.
// It is drawn when something has changed, and else costs nothing.
bbsim.makePicture = (canvas) => {
  const {scene, runs} = bbsim.data;
  const {stage} = scene;
  const {palette, paint, text} = bbsim;
  const lead = runs[0];
  const size = Math.max(stage.width, stage.depth);

  // As large as it will be from the start: its buffers are made once.
  const sizeOf = () => {
    const box = canvas.parentElement.getBoundingClientRect();
    return [Math.max(1, Math.round(box.width)), Math.max(1, Math.round(box.height))];
  };
  [canvas.width, canvas.height] = sizeOf();
  let [width, height] = sizeOf();
  const renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: false});
  renderer.debug.checkShaderErrors = false;  // asking whether they compiled waits for them one by one
  if (window.devicePixelRatio > 1) renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
  const world = new THREE.Scene();
  world.background = new THREE.Color();

  const plate = document.createElement('canvas');
  plate.width = plate.height = 1024;
  const plateTexture = new THREE.CanvasTexture(plate);
  plateTexture.anisotropy = 4;
  const materials = {
    face: paint.lit({map: plateTexture, gloss: 0.16}),
    slab: paint.lit({gloss: 0.05}),
    frame: paint.lit({gloss: 0.25}),
    axle: paint.lit({gloss: 0.4}),
    metal: paint.lit({gloss: 0.15}),
    path: paint.flat(), future: paint.flat(), reference: paint.flat(), target: paint.flat(), x: paint.flat(),
    y: paint.flat(), event: paint.flat(), eventRim: paint.flat(), sensor: paint.flat({transparent: true, opacity: 0.85}),
  };
  const rig = bbsim.gimbal.build(lead, materials);
  rig.width = stage.width + 0.2 * size;
  rig.depth = stage.depth + 0.26 * size;
  world.add(rig.base);
  const floor = paint.shadow(0.3);
  floor.scale.set(0.62 * rig.width, 0.62 * rig.depth, 1);
  floor.position.z = -rig.foot - 0.012 * size;
  world.add(floor);

  // Painted on the plate, layer by layer.
  const layer = (n) => lead.mounting.height + n * 0.00025 * size;
  function onPlate(object, n, plane = rig.plane) {
    object.position.z = layer(n);
    object.traverse((part) => { part.renderOrder = n; });
    plane.add(object);
    return object;
  }

  const trailWidth = 0.0055 * size;
  const visible = {trail: true, reference: true, sensor: true, events: true, axes: true, gimbal: true};
  const labels = [];
  const parts = {axes: new THREE.Group(), events: new THREE.Group(), reference: new THREE.Group(), sensor: new THREE.Group()};
  for (const group of Object.values(parts)) rig.plane.add(group);

  for (const axis of ['x', 'y']) {
    onPlate(paint.arrow(axis, 0.13 * size, 0.0085 * size, materials[axis]), 2, parts.axes);
  }

  // Runs: their balls and trails, the leading one's on the plate, the others' on plates of their own.
  const actors = runs.map((run) => {
    const leads = run === lead;
    const edge = new THREE.LineBasicMaterial({transparent: true, opacity: 0.7});
    const links = leads ? rig : run.hasAngles ? bbsim.gimbal.buildGhost(run, edge) : null;
    if (links && !leads) world.add(links.base);
    const plane = links ? links.plane : rig.plane;
    const ball = bbsim.ball.build(run.ball.radius, !leads);
    ball.mesh.renderOrder = 10;
    plane.add(ball.mesh);
    const xs = run.values('x'), ys = run.values('y');
    const dash = leads ? null : palette.dash(run.index).slice(0, 2).map((n) => n * 0.0022 * size);
    const past = new THREE.Mesh(paint.ribbon(xs, ys, trailWidth, dash), paint.flat());
    const tip = new THREE.Mesh(new THREE.PlaneBufferGeometry(1, trailWidth), past.material);
    const future = new THREE.Mesh(leads ? paint.ribbon(xs, ys, 0.55 * trailWidth) : past.geometry.clone(), paint.flat());
    future.visible = leads;
    const shadow = paint.shadow(0.55);
    shadow.scale.set(1.5 * run.ball.radius, 1.5 * run.ball.radius, 1);
    onPlate(future, 3, plane);
    onPlate(past, 5, plane);
    onPlate(tip, 5, plane);
    onPlate(shadow, 8, plane);
    return {run, leads, links, plane, ball, past, tip, future, shadow, edge};
  });
  const leader = actors[0];

  const hasPath = lead.path.length >= 4;
  if (hasPath) {
    const xs = lead.path.filter((_, i) => i % 2 === 0), ys = lead.path.filter((_, i) => i % 2 === 1);
    onPlate(new THREE.Mesh(paint.ribbon(xs, ys, 0.0042 * size, [0.012 * size, 0.009 * size]), materials.reference), 4,
            parts.reference);
  }
  const target = onPlate(paint.target(Math.max(1.45 * lead.ball.radius, 0.02 * size), materials.target), 7, parts.reference);
  target.visible = lead.hasReference || lead.path.length === 2;

  // The last points that the sensor saw.
  const seen = [];
  if (lead.isMeasured) {
    for (let i = 0; i < 12; ++i) seen.push(onPlate(paint.cross(0.016 * size, materials.sensor), 6, parts.sensor));
  }

  // Of very many events the first hundred and the last are marked; all are listed beside the picture.
  const marked = lead.events.filter((_, i) => i < 100 || i === lead.events.length - 1);
  for (const event of marked) {
    const mark = onPlate(paint.eventMark(event.action, 0.016 * size, materials.event, materials.eventRim), 6, parts.events);
    mark.position.x = event.x;
    mark.position.y = event.y;
  }

  function label(words, colour, at, group, pixels) {
    const mesh = paint.label(words, colour, palette.now().plate, pixels);
    world.add(mesh);
    labels.push({mesh, at, group});
  }

  function makeLabels() {
    for (const {mesh} of labels) {
      world.remove(mesh);
      mesh.geometry.dispose();
      mesh.material.uniforms.map.value.dispose();
      mesh.material.dispose();
    }
    labels.length = 0;
    const colours = palette.now(), high = layer(2) + 0.02 * size;
    label('x', colours.x, new THREE.Vector3(0.155 * size, 0, high), parts.axes);
    label('y', colours.y, new THREE.Vector3(0, 0.155 * size, high), parts.axes);
    const named = [];
    for (const event of marked) {
      // One word for those that are close to each other.
      if (named.length > 11 || named.some((other) => other.name === event.name &&
          Math.hypot(other.x - event.x, other.y - event.y) < 0.08 * size)) continue;
      named.push(event);
      label(text.visible(event.name), colours.ink, new THREE.Vector3(event.x, event.y, high + Math.max(0.03 * size, 2.6 * lead.ball.radius)), parts.events, 13);
    }
  }

  function faceLabels() {
    const pixel = 2 * Math.tan(eyes.fov * Math.PI / 360) / Math.max(canvas.clientHeight, 1);
    for (const {mesh, at, group} of labels) {
      mesh.visible = group.visible;
      mesh.face(at.clone().applyMatrix4(rig.plane.matrixWorld), eyes.camera, pixel);
      mesh.updateMatrixWorld();
    }
  }

  // The plate's colour through which a trail shines that is still to come.
  function mixed(colour, part) {
    return new THREE.Color(palette.now().plate).lerp(new THREE.Color(colour), part);
  }

  function recolour() {
    const colours = palette.now();
    world.background.set(colours.background);
    paint.lights.sky.value.set(colours.sky).multiplyScalar(colours.hemisphere);
    paint.lights.earth.value.set(colours.earth).multiplyScalar(colours.hemisphere);
    paint.lights.lampColour.value.setScalar(colours.light);
    bbsim.gimbal.paintPlate(plate, colours);
    plateTexture.needsUpdate = true;
    materials.slab.color.set(colours.grid);
    materials.frame.color.set(colours.frame);
    materials.axle.color.set(colours.rim);
    materials.metal.color.set(colours.metal);
    materials.reference.color.set(colours.reference);
    materials.target.color.set(colours.reference);
    materials.x.color.set(colours.x);
    materials.y.color.set(colours.y);
    materials.event.color.set('#ffd23f');
    materials.eventRim.color.set('#14181e');
    materials.sensor.color.set(colours.sensor);
    for (const actor of actors) {
      const colour = palette.run(actor.run.index);
      actor.ball.colour(colours.cream, colour);
      actor.past.material.color.set(colour);
      actor.future.material.color.copy(mixed(colour, colours.faint));
      actor.edge.color.set(colour);
    }
    makeLabels();
    invalidate();
  }

  let factor = 1, waiting = false;
  const turn = new THREE.Quaternion();
  const last = runs.map(() => ({x: 0, y: 0}));

  // Puts everything where it is at time t.
  function pose(t) {
    const phi = lead.at(t, 'phi', 0), theta = lead.at(t, 'theta', 0);
    rig.set(factor * phi, factor * theta);
    for (const actor of actors) {
      const {run} = actor;
      if (actor.links && !actor.leads) actor.links.set(factor * run.at(t, 'phi', 0), factor * run.at(t, 'theta', 0));
      // Where a row has no number the ball stays where it was.
      const place = last[run.index];
      place.x = run.at(t, 'x', place.x);
      place.y = run.at(t, 'y', place.y);
      const height = (actor.links ? run : lead).mounting.height;
      actor.ball.mesh.position.set(place.x, place.y, height + run.ball.radius);
      actor.ball.mesh.quaternion.copy(run.orientationAt(t, turn));
      const shown = run.shown;
      actor.ball.mesh.visible = shown;
      actor.shadow.visible = shown;
      actor.shadow.position.x = place.x + 0.12 * run.ball.radius;
      actor.shadow.position.y = place.y - 0.25 * run.ball.radius;
      const row = run.row(t), {until} = actor.past.geometry;
      actor.past.visible = shown && visible.trail;
      actor.future.visible = shown && visible.trail && actor.leads;
      actor.past.geometry.setDrawRange(0, until[row + 1]);
      // From the last row to the ball.
      const dx = place.x - run.values('x')[row], dy = place.y - run.values('y')[row], length = Math.hypot(dx, dy);
      actor.tip.visible = shown && visible.trail && length > 0;
      if (length > 0) {
        actor.tip.position.x = place.x - dx / 2;
        actor.tip.position.y = place.y - dy / 2;
        actor.tip.rotation.z = Math.atan2(dy, dx);
        actor.tip.scale.x = length;
      }
      if (actor.links && !actor.leads) actor.links.base.visible = shown;
    }
    if (target.visible) {
      target.position.x = lead.at(t, 'x_reference', lead.path[0]);
      target.position.y = lead.at(t, 'y_reference', lead.path[1]);
    }
    // One point a sample, of which the rows between two have the same.
    let row = lead.row(t);
    const xs = lead.values('x_measured'), ys = lead.values('y_measured');
    for (const mark of seen) {
      mark.visible = row >= 0 && Number.isFinite(xs[row]) && Number.isFinite(ys[row]);
      if (!mark.visible) continue;
      mark.position.x = xs[row];
      mark.position.y = ys[row];
      const [x, y] = [xs[row], ys[row]];
      while (row >= 0 && xs[row] === x && ys[row] === y) --row;
    }
    for (const [name, group] of Object.entries(parts)) group.visible = visible[name];
    for (const part of rig.base.children) if (part !== rig.ring) part.visible = visible.gimbal;
    for (const part of [...rig.ring.children, ...rig.hinge.children]) if (part.isMesh) part.visible = visible.gimbal;
    floor.visible = visible.gimbal;
    world.updateMatrixWorld(true);
  }

  function draw() {
    waiting = false;
    begun = true;
    pose(bbsim.clock.now);
    eyes.update();
    faceLabels();
    renderer.render(world, eyes.camera);
  }
  function invalidate() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { if (waiting) draw(); });
  }

  const eyes = bbsim.makeCamera(canvas, rig, invalidate);

  let begun = false;
  function resize() {
    const [w, h] = sizeOf();
    if (begun && w === width && h === height) return;
    if (w !== width || h !== height) renderer.setSize(w, h, false);
    [width, height] = [w, h];
    eyes.resize(w, h);
    if (!eyes.touched) eyes.restore(eyes.view);  // all is in the picture, whatever its shape
    if (begun) draw();
  }
  bbsim.clock.onTime(invalidate);
  palette.onChange(recolour);

  return {
    eyes, rig, actors, visible, hasPath, target, lead, renderer,
    get factor() { return factor; },
    invalidate, resize, draw, recolour,
    // Draws, and comes back when that is done and not only asked for.
    drawn() {
      draw();
      const gl = renderer.getContext();
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    },
    exaggerate(value) {
      factor = value;
      invalidate();
    },
    show(name, on) {
      visible[name] = on;
      invalidate();
    },
    // The centre of the leading ball in the window, CSS pixels.
    ballOnScreen() {
      pose(bbsim.clock.now);
      eyes.update();
      const box = canvas.getBoundingClientRect();
      const centre = leader.ball.mesh.getWorldPosition(new THREE.Vector3()).project(eyes.camera);
      return [box.left + (centre.x + 1) / 2 * box.width, box.top + (1 - centre.y) / 2 * box.height];
    },
    // What a test projects by: column-major matrices, and the canvas in the window.
    view() {
      draw();
      const box = canvas.getBoundingClientRect();
      return {
        view: eyes.camera.matrixWorldInverse.toArray(), projection: eyes.camera.projectionMatrix.toArray(),
        canvas: [box.left, box.top, box.width, box.height],
      };
    },
    // The plate's tilt now: its size, and where downhill is in the plate's frame; both as they are, not as drawn.
    tilt() {
      const t = bbsim.clock.now;
      const {skew, yaw, baseTilt} = lead.mounting;
      const rotation = new THREE.Matrix4().makeRotationX(baseTilt)
          .multiply(new THREE.Matrix4().makeRotationY(lead.at(t, 'phi', 0)))
          .multiply(new THREE.Matrix4().makeRotationZ(skew))
          .multiply(new THREE.Matrix4().makeRotationX(lead.at(t, 'theta', 0)))
          .multiply(new THREE.Matrix4().makeRotationZ(yaw - skew));
      const up = new THREE.Vector3(0, 0, 1).transformDirection(new THREE.Matrix4().getInverse(rotation));
      return {angle: Math.atan2(Math.hypot(up.x, up.y), up.z), x: -up.x, y: -up.y};
    },
  };
};
