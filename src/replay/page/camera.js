'use strict';
// Where the picture is seen from. The eye orbits in the world, or in the plate's own frame.
bbsim.makeCamera = (canvas, rig, changed) => {
  const fov = 30;
  const camera = new THREE.PerspectiveCamera(fov, 1, 1, 2);
  camera.matrixAutoUpdate = false;
  const eye = new THREE.PerspectiveCamera(fov, 1, 1, 2);  // in the frame that it orbits in
  eye.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(eye, canvas);
  controls.enableKeys = false;
  controls.screenSpacePanning = true;
  controls.rotateSpeed = 0.8;
  controls.minDistance = 0.05 * rig.size;
  controls.maxDistance = 20 * rig.size;
  let view = 'free', touched = false, moving = null;
  const listeners = [];
  const reduced = matchMedia('(prefers-reduced-motion: reduce)');

  // Where to look from along a direction to have all of the rig in the picture, in its middle.
  function fit(direction, up) {
    const back = direction.clone().normalize(), right = up.clone().cross(back).normalize(), over = back.clone().cross(right);
    const half = Math.tan(fov * Math.PI / 360) * 0.93, target = new THREE.Vector3();
    let far = 0;
    for (let again = 0; again < 3; ++again) {
      const seen = rig.outline.map((point) => point.clone().sub(target));
      far = Math.max(...seen.map((p) => p.dot(back) + Math.max(Math.abs(p.dot(over)) / half, Math.abs(p.dot(right)) / half / camera.aspect)));
      const heights = seen.map((p) => p.dot(over) / (far - p.dot(back)));
      target.addScaledVector(over, far * (Math.max(...heights) + Math.min(...heights)) / 2);
    }
    return {target, position: back.multiplyScalar(far).add(target)};
  }

  // The world's horizontal axis about which the plate is tilted now; phi's where it is level.
  function tiltAxis() {
    const normal = new THREE.Vector3(0, 0, 1).transformDirection(rig.plane.matrixWorld);
    const axis = new THREE.Vector3(-normal.y, normal.x, 0);
    return axis.length() > 1e-9 ? axis.normalize() : new THREE.Vector3(0, 1, 0);
  }

  function place(name) {
    const up = new THREE.Vector3(0, 0, 1);
    if (name === 'above') return fit(new THREE.Vector3(0, -1e-4, 1), up);
    if (name === 'front') return fit(new THREE.Vector3(0, -1, 0.09), up);
    if (name === 'axis') return fit(tiltAxis().negate().add(new THREE.Vector3(0, 0, 0.06)), up);
    return fit(new THREE.Vector3(0.5, -1.0, 0.72), up);
  }

  function set(to) {
    eye.position.copy(to.position);
    controls.target.copy(to.target);
    controls.update();
    changed();
  }

  function glide(to) {
    const from = {position: eye.position.clone(), target: controls.target.clone()}, begun = performance.now();
    moving = to;
    const frame = (time) => {
      if (moving !== to) return;
      const part = Math.min(1, (time - begun) / 350), eased = part * part * (3 - 2 * part);
      // Round the target, not through it.
      const a = new THREE.Spherical().setFromVector3(yUp(from.position.clone().sub(from.target)));
      const b = new THREE.Spherical().setFromVector3(yUp(to.position.clone().sub(to.target)));
      // Straight from above there is no azimuth to come from or go to.
      if (a.phi < 0.01) a.theta = b.theta;
      if (b.phi < 0.01) b.theta = a.theta;
      const turn = Math.atan2(Math.sin(b.theta - a.theta), Math.cos(b.theta - a.theta));
      const now = new THREE.Spherical(a.radius + eased * (b.radius - a.radius), a.phi + eased * (b.phi - a.phi),
                                      a.theta + eased * turn);
      const target = from.target.clone().lerp(to.target, eased);
      set({position: zUp(new THREE.Vector3().setFromSpherical(now)).add(target), target});
      if (part < 1) requestAnimationFrame(frame);
      else {
        moving = null;
        set(to);
        tell();
      }
    };
    requestAnimationFrame(frame);
  }
  const yUp = (v) => new THREE.Vector3(v.y, v.z, v.x);
  const zUp = (v) => new THREE.Vector3(v.z, v.x, v.y);
  const tell = () => listeners.forEach((listener) => listener());

  function go(name, atOnce = false) {
    const to = place(name);
    const sameFrame = (view === 'plate') === (name === 'plate');
    view = name;
    touched = false;
    if (atOnce || reduced.matches || !sameFrame) {
      moving = null;
      set(to);
    } else {
      glide(to);
    }
    tell();
  }

  controls.addEventListener('change', changed);
  controls.addEventListener('start', () => {
    moving = null;
    touched = true;
    tell();
  });
  controls.addEventListener('end', tell);

  return {
    camera, controls, fov, go,
    get view() { return view; },
    get touched() { return touched; },  // turned or zoomed away from where the view is from
    onChange: (listener) => listeners.push(listener),
    resize(width, height) {
      for (const c of [camera, eye]) c.aspect = width / height;
    },
    // Before a picture is drawn: the camera, from the eye and the frame that it is in.
    update() {
      eye.updateMatrix();
      const far = eye.position.distanceTo(controls.target);
      camera.near = Math.max(far / 100, far - 4 * rig.size);
      camera.far = far + 8 * rig.size;
      camera.updateProjectionMatrix();
      camera.matrix.copy(eye.matrix);
      if (view === 'plate') camera.matrix.premultiply(rig.plane.matrixWorld);
      camera.updateMatrixWorld(true);
    },
    zoom(factor) {
      eye.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
      touched = true;
      controls.update();
      changed();
      tell();
    },
    turn(left, up) {
      const around = new THREE.Spherical().setFromVector3(yUp(eye.position.clone().sub(controls.target)));
      around.theta += left;
      around.phi = Math.min(Math.max(around.phi - up, 0.001), Math.PI - 0.001);
      touched = true;
      set({position: zUp(new THREE.Vector3().setFromSpherical(around)).add(controls.target), target: controls.target.clone()});
      tell();
    },
    // Numbers for the page's address.
    state: () => [...eye.position.toArray(), ...controls.target.toArray()],
    restore(name, numbers) {
      view = name;
      moving = null;
      touched = Boolean(numbers);
      if (numbers) set({position: new THREE.Vector3(...numbers.slice(0, 3)), target: new THREE.Vector3(...numbers.slice(3))});
      else set(place(name));
      tell();
    },
  };
};
