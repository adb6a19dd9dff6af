// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Turns, moves and zooms an eye about a target, by mouse, wheel and fingers. The page can still
// scroll: a wheel is for the view only with Ctrl or after a click on the view, and one finger only
// after a tap. Two fingers are always for the view.
bbsim.makeOrbit = (canvas, eye, told) => {
  const target = new THREE.Vector3(), tiny = 1e-4;
  const fingers = new Map();  // pointers that are down: their last positions
  let way = null, last = null, tapped = null;  // the start of a touch that may be a tap
  const taken = () => document.activeElement === canvas;
  // Converts between spherical coordinates about z and those of three.js, about y.
  const yUp = (v) => new THREE.Vector3(v.y, v.z, v.x), zUp = (v) => new THREE.Vector3(v.z, v.x, v.y);
  const around = () => new THREE.Spherical().setFromVector3(yUp(eye.position.clone().sub(target)));

  function stand(at) {
    at.radius = Math.min(Math.max(at.radius, orbit.minDistance), orbit.maxDistance);
    at.phi = Math.min(Math.max(at.phi, tiny), Math.PI - tiny);
    eye.position.copy(zUp(new THREE.Vector3().setFromSpherical(at))).add(target);
    eye.lookAt(target);
    eye.updateMatrix();
    told.changed();
  }

  // The eye moves around its target, or nearer.
  const step = (left, up, factor) => {
    const {radius, phi, theta} = around();
    stand(new THREE.Spherical(radius * factor, phi - up, theta + left));
  };
  const turn = (left, up) => step(left, up, 1), zoom = (factor) => step(0, 0, factor);

  function move(dx, dy) {
    const pixel = 2 * Math.tan(eye.fov * Math.PI / 360) * eye.position.distanceTo(target) / canvas.clientHeight;
    const shift = new THREE.Vector3().setFromMatrixColumn(eye.matrix, 0).multiplyScalar(-dx * pixel)
        .addScaledVector(new THREE.Vector3().setFromMatrixColumn(eye.matrix, 1), dy * pixel);
    target.add(shift);
    eye.position.add(shift);
    stand(around());
  }

  // The middle of the fingers and the distance between them.
  function hand() {
    const [a, b] = [...fingers.values()];
    return b ? {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y)} : {...a, apart: 0};
  }

  function begin(event) {
    const touch = event.pointerType === 'touch', first = fingers.size === 0;
    fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    tapped = touch && first && !taken() ? {x: event.clientX, y: event.clientY} : null;
    if (touch && fingers.size === 1 && !taken()) return;
    if (!touch) {
      event.preventDefault();
      canvas.focus();
    }
    if (way === null) told.begun();
    way = touch ? (fingers.size > 1 ? 'both' : 'turn')
        : event.button !== 0 || event.ctrlKey || event.metaKey || event.shiftKey ? 'move' : 'turn';
    last = hand();
    canvas.setPointerCapture(event.pointerId);
  }

  function go(event) {
    if (!fingers.has(event.pointerId)) return;
    fingers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    if (tapped && Math.hypot(event.clientX - tapped.x, event.clientY - tapped.y) > 8) tapped = null;
    if (way === null) return;
    const now = hand(), dx = now.x - last.x, dy = now.y - last.y, whole = 2 * Math.PI * 0.8 / canvas.clientHeight;
    if (way === 'turn') turn(-dx * whole, dy * whole);
    else move(dx, dy);
    if (way === 'both' && now.apart > 0 && last.apart > 0) zoom(last.apart / now.apart);
    last = now;
  }

  function end(event) {
    if (!fingers.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && tapped && fingers.size === 0) canvas.focus();
    if (way === null) return;
    if (fingers.size > 0) {
      way = 'turn';
      last = hand();
      return;
    }
    way = null;
    told.ended();
  }

  canvas.addEventListener('pointerdown', begin);
  canvas.addEventListener('pointermove', go);
  for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, end);
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && !taken()) return told.left();
    event.preventDefault();
    told.begun();
    zoom(Math.exp(Math.min(Math.max(event.deltaY, -120), 120) * 5e-4));
    told.ended();
  }, {passive: false});
  // A finger that is for the view does not scroll the page as well.
  for (const name of ['focus', 'blur']) canvas.addEventListener(name, () => canvas.classList.toggle('taken', taken()));

  const orbit = {target, turn, zoom, minDistance: 0, maxDistance: Infinity, update: () => stand(around())};
  return orbit;
};
