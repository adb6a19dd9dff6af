// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Three legs under a plate: positions of axes, horns' ends and joints
// (docs/explanation/rig-model.md, "Three servos"), and their drawing.
bbsim.legs = (() => {
  // Kinematics of a run's legs. `at(phi, theta, servos)` returns the points axis, knee and joint of
  // each leg, from the center of the joints at home, m. Without the servos' angles, the plate keeps
  // its height at home.
  function kinematics({legs, phiOffset, thetaOffset}) {
    const parts = legs.map((leg) => ({...leg, ex: Math.cos(leg.angle), ey: Math.sin(leg.angle)}));
    let xx = 0, xy = 0, yy = 0;
    parts.forEach((leg, i) => {
      const next = parts[(i + 1) % 3], last = parts[(i + 2) % 3];
      leg.twist = next.ex * last.ey - next.ey * last.ex;
      xx += leg.ey * leg.ey;
      xy -= leg.ey * leg.ex;
      yy += leg.ex * leg.ex;
    });
    // The horn's elevation, knee outward, for a joint at (x, z) from the servo's axis.
    const elevation = ({horn, rod}, x, z) => {
      const far = Math.hypot(x, z), cosine = (far * far + horn * horn - rod * rod) / (2 * horn * far);
      return Math.atan2(z, x) - Math.acos(Math.min(1, Math.max(-1, cosine)));
    };
    for (const leg of parts) leg.home = elevation(leg, leg.plate - leg.base, leg.height);

    function at(phi, theta, servos) {
      const [f, t] = [phi - phiOffset, theta - thetaOffset];
      const p = Math.sin(f) * Math.cos(t), q = -Math.sin(t), n = Math.cos(f) * Math.cos(t), w = 1 / (1 + n);
      let a = 0, b = 0, c = 0;
      for (const leg of parts) {
        leg.e = leg.ex * p + leg.ey * q;
        leg.f = leg.ex * q - leg.ey * p;
        a -= leg.twist * leg.plate * w * leg.e * leg.f;
        b += leg.twist * leg.plate * (1 - w * leg.f * leg.f);
        c += leg.twist * leg.joint * leg.f;
      }
      const square = a * a + b * b, root = Math.sign(b) * Math.sqrt(Math.max(0, square - c * c));
      const cosine = (b * root - a * c) / square, sine = -(b * c + a * root) / square;
      let gx = 0, gy = 0;
      for (const leg of parts) {
        const falls = leg.plate * (cosine * leg.e + sine * leg.f);
        const beside = leg.plate * sine - w * leg.f * falls + leg.joint * leg.f;
        leg.along = leg.plate * cosine - w * leg.e * falls + leg.joint * leg.e;
        leg.z = leg.joint * n - falls;
        gx -= leg.ey * beside;
        gy += leg.ex * beside;
      }
      const size = xx * yy - xy * xy, shift = [-(yy * gx - xy * gy) / size, -(xx * gy - xy * gx) / size];
      let lift = 0;
      parts.forEach((leg, i) => {
        leg.x = leg.along + shift[0] * leg.ex + shift[1] * leg.ey;
        if (!servos) return;
        // The rod determines the joint's height above the horn's end.
        const horn = leg.home + leg.offset + leg.direction * servos[i];
        const out = leg.x - leg.base - leg.horn * Math.cos(horn);
        lift += (leg.joint - leg.height + leg.horn * Math.sin(horn) +
                 Math.sqrt(Math.max(0, leg.rod * leg.rod - out * out)) - leg.z) / 3;
      });
      return parts.map((leg) => {
        const foot = leg.joint - leg.height, z = leg.z + lift;
        const horn = elevation(leg, leg.x - leg.base, z - foot), end = leg.base + leg.horn * Math.cos(horn);
        const point = (out, up) => [out * leg.ex, out * leg.ey, up];
        return {horn, axis: point(leg.base, foot), knee: point(end, foot + leg.horn * Math.sin(horn)), joint: point(leg.x, z)};
      });
    }
    return {at, depth: Math.max(...parts.map((leg) => leg.height - leg.joint)), reach: Math.max(...parts.map((leg) => leg.base + leg.horn))};
  }

  // The legs as meshes in a group; set() moves them. `level`: height of the joints' center at home.
  function build(run, level, size, materials) {
    const chain = kinematics(run.legs), group = new THREE.Group();
    const thick = 0.012 * size, up = new THREE.Vector3(0, 1, 0);
    const bar = (radius, material) => {
      const mesh = new THREE.Mesh(new THREE.CylinderBufferGeometry(radius, radius, 1, 16), material);
      group.add(mesh);
      return mesh;
    };
    const ball = (radius, material) => {
      const mesh = new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 20, 12), material);
      group.add(mesh);
      return mesh;
    };
    const limbs = run.legs.legs.map((leg) => {
      const servo = new THREE.Mesh(new THREE.BoxBufferGeometry(3 * thick, 2 * thick, 3 * thick), materials.metal);
      servo.rotation.z = leg.angle;
      group.add(servo);
      return {servo, horn: bar(thick, materials.axle), rod: bar(0.5 * thick, materials.frame), joint: ball(0.9 * thick, materials.axle)};
    });
    const stretch = (mesh, from, to) => {
      const way = to.clone().sub(from);
      mesh.position.copy(from).addScaledVector(way, 0.5);
      mesh.scale.set(1, way.length(), 1);
      mesh.quaternion.setFromUnitVectors(up, way.normalize());
    };
    let points = [];
    return {
      group,
      depth: chain.depth - level + 2 * thick,
      reach: chain.reach,
      // Axis, knee and joint of each leg in the base's frame, m.
      points: () => points,
      set(phi, theta, servos) {
        points = chain.at(phi, theta, servos);
        points.forEach((leg, i) => {
          for (const name of ['axis', 'knee', 'joint']) leg[name][2] += level;
          const [axis, knee, joint] = ['axis', 'knee', 'joint'].map((name) => new THREE.Vector3(...leg[name]));
          limbs[i].servo.position.copy(axis);
          limbs[i].joint.position.copy(joint);
          stretch(limbs[i].horn, axis, knee);
          stretch(limbs[i].rod, knee, joint);
        });
      },
    };
  }

  return {kinematics, build};
})();
