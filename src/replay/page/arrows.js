// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Arrows at the ball's center in the picture: its velocity relative to the plate, gravity, and the
// plate's force along its normal if the run has that column. Gravity, and the largest velocity and
// force of the run, are as long as `length`.
bbsim.makeArrows = (run, plane, length, materials) => {
  const along = new THREE.Vector3(1, 0, 0), turned = new THREE.Quaternion();
  // Two flat arrows across each other are seen from everywhere.
  const made = Object.fromEntries(Object.entries(materials).map(([name, material]) => {
    const arrow = bbsim.paint.arrow('x', length, 0.03 * length, material), other = arrow.clone(), both = new THREE.Group();
    other.rotation.x = Math.PI / 2;
    both.add(arrow, other);
    for (const part of both.children) part.renderOrder = 12;
    return [name, Object.assign(both, {tip: new THREE.Vector3()})];
  }));
  // The velocity from the columns, or between the rows beside the time.
  function velocityAt(t) {
    if (run.columns.has('vx') && run.columns.has('vy')) return [run.at(t, 'vx', 0), run.at(t, 'vy', 0)];
    const row = Math.max(1, Math.min(run.row(t) + 1, run.t.length - 1)), seconds = run.t[row] - run.t[row - 1];
    return ['x', 'y'].map((name) => (run.values(name)[row] - run.values(name)[row - 1]) / seconds || 0);
  }
  const fastest = bbsim.data.extent(Array.from(run.t, (t) => Math.hypot(...velocityAt(t)))).greatest;
  const force = run.columns.get('normal_force');
  return {
    // Each with the place of its name, `tip`.
    meshes: made,
    // Returns all numbers that they depend on.
    pose(t, place) {
      const [vx, vy] = velocityAt(t);
      const down = new THREE.Vector3(0, 0, -1).applyQuaternion(plane.getWorldQuaternion(turned).inverse());
      const vectors = {velocity: new THREE.Vector3(vx, vy, 0).divideScalar(fastest || 1), gravity: down,
                       'normal force': new THREE.Vector3(0, 0, force ? run.at(t, 'normal_force', 0) / (force.size || 1) : 0)};
      return Object.entries(vectors).flatMap(([name, vector]) => {
        const one = made[name], size = vector.length();
        one.visible = size > 1e-3;
        one.position.copy(place);
        one.tip.copy(place).addScaledVector(vector, 1.1 * length);
        if (one.visible) one.quaternion.setFromUnitVectors(along, vector.clone().normalize());
        one.scale.setScalar(Math.max(size, 1e-3));
        return vector.toArray();
      });
    },
  };
};
