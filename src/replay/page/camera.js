// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The camera. Its eye orbits in the world's frame, in the plate's frame, or about the ball.
bbsim.makeCamera = (canvas, rig, told) => {
  const fov = 30;
  const camera = new THREE.PerspectiveCamera(fov, 1, 1, 2);
  camera.matrixAutoUpdate = false;
  const eye = new THREE.PerspectiveCamera(fov, 1, 1, 2);  // in the frame in which it orbits
  eye.up.set(0, 0, 1);
  let view = 'free', touched = false, moving = null, usual = 1;
  const listeners = [];
  const notify = () => listeners.forEach((listener) => listener());
  function begun() {
    moving = null;
    touched = true;
    notify();
  }
  const controls = bbsim.makeOrbit(canvas, eye, {changed: told.changed, left: told.left, begun, ended: notify});
  // The unit of length is the longest side of the plate, as in the picture.
  const radius = () => rig.ballRadius / rig.size;
  controls.minDistance = Math.min(0.05, 3 * radius());
  controls.maxDistance = 20;
  const reduced = matchMedia('(prefers-reduced-motion: reduce)');
  const frameOf = (name) => (name === 'plate' || name === 'ball' ? name : 'world');

  // The position and the target, along a direction, that show all of the rig in the middle of the
  // picture.
  function fit(direction, up) {
    const back = direction.clone().normalize(), right = up.clone().cross(back).normalize(), over = back.clone().cross(right);
    const half = Math.tan(fov * Math.PI / 360) * 0.93, target = new THREE.Vector3();
    let far = 0;
    for (let again = 0; again < 3; ++again) {
      const seen = rig.outline().map((point) => point.clone().sub(target));
      far = Math.max(...seen.map((p) => p.dot(back) + Math.max(Math.abs(p.dot(over)) / half, Math.abs(p.dot(right)) / half / camera.aspect)));
      const heights = seen.map((p) => p.dot(over) / (far - p.dot(back)));
      target.addScaledVector(over, far * (Math.max(...heights) + Math.min(...heights)) / 2);
    }
    return {target, position: back.multiplyScalar(far).add(target)};
  }

  // The world's horizontal axis about which the plate is tilted now; the axis of phi if it is
  // level.
  function tiltAxis() {
    const normal = new THREE.Vector3(0, 0, 1).transformDirection(rig.plane.matrixWorld);
    const axis = new THREE.Vector3(-normal.y, normal.x, 0);
    return axis.length() > 1e-9 ? axis.normalize() : new THREE.Vector3(0, 1, 0);
  }

  // A long plate is seen from its longer side.
  const corner = () => (rig.long === 'y' ? new THREE.Vector3(1, -0.5, 0.72) : new THREE.Vector3(0.5, -1, 0.72));

  function place(name) {
    const up = new THREE.Vector3(0, 0, 1);
    if (name === 'above') return fit(new THREE.Vector3(0, -1e-4, 1), up);
    if (name === 'front') return fit(new THREE.Vector3(0, -1, 0.09), up);
    if (name === 'axis') return fit(tiltAxis().negate().add(new THREE.Vector3(0, 0, 0.06)), up);
    // The ball takes a sixth of the picture's height.
    if (name === 'ball') return {target: new THREE.Vector3(), position: corner().setLength(6 * radius() / Math.tan(fov * Math.PI / 360))};
    return fit(corner(), up);
  }

  function set(to) {
    eye.position.copy(to.position);
    controls.target.copy(to.target);
    controls.update();
  }

  function glide(to) {
    const begun = performance.now(), target = controls.target.clone();
    // Moves around the target, not through it.
    const from = eye.position.clone().sub(target), way = to.position.clone().sub(to.target);
    moving = to;
    requestAnimationFrame(function frame(time) {
      if (moving !== to) return;
      const part = Math.min(1, (time - begun) / 350), eased = part * part * (3 - 2 * part);
      const now = target.clone().lerp(to.target, eased), far = from.length() + eased * (way.length() - from.length());
      set({position: from.clone().lerp(way, eased).setLength(far).add(now), target: now});
      if (part < 1) return requestAnimationFrame(frame);
      moving = null;
      notify();
    });
  }

  function go(name, atOnce = false) {
    const to = place(name);
    const sameFrame = frameOf(view) === frameOf(name) && name !== 'ball';
    view = name;
    touched = false;
    if (atOnce || reduced.matches || !sameFrame) {
      moving = null;
      set(to);
    } else {
      glide(to);
    }
    notify();
  }

  return {
    camera, controls, fov, go,
    get view() { return view; },
    get touched() { return touched; },  // the user has turned or zoomed the view
    onChange: (listener) => listeners.push(listener),
    resize(width, height) {
      for (const c of [camera, eye]) c.aspect = width / height;
    },
    // Fits the rig into the picture again, unless the user has turned or zoomed the view.
    refit() {
      usual = place('free').position.length();
      if (!touched) this.restore(view);
    },
    // The distance to the target, relative to that of the view from a corner.
    farness: () => eye.position.distanceTo(controls.target) / usual,
    // Sets the camera from the eye and its frame, before a picture is drawn.
    update() {
      const far = eye.position.distanceTo(controls.target);
      camera.near = Math.max(far / 100, far - 4);
      camera.far = far + 8;
      camera.updateProjectionMatrix();
      camera.matrix.copy(eye.matrix);
      if (frameOf(view) !== 'world') {
        const frame = rig.plane.matrixWorld.clone();
        if (view === 'ball') frame.multiply(new THREE.Matrix4().makeTranslation(rig.ball.x, rig.ball.y, rig.ball.z));
        camera.matrix.premultiply(frame.multiply(new THREE.Matrix4().makeScale(rig.size, rig.size, rig.size)));
      }
      camera.updateMatrixWorld(true);
    },
    zoom(factor) {
      begun();
      controls.zoom(factor);
    },
    turn(left, up) {
      begun();
      controls.turn(left, up);
    },
    // Numbers for the page's address.
    state: () => [...eye.position.toArray(), ...controls.target.toArray()],
    restore(name, numbers) {
      view = name;
      moving = null;
      touched = Boolean(numbers);
      if (numbers) set({position: new THREE.Vector3(...numbers.slice(0, 3)), target: new THREE.Vector3(...numbers.slice(3))});
      else set(place(name));
      notify();
    },
  };
};
