// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Three legs under a plate, or push rods beside it: positions of servos' axes, of horns' ends
// (knees) and of joints (docs/explanation/rig-model.md, "Linkages", "Three servos"), and their
// drawing.
bbsim.legs = (() => {
  // The angle of a horn from which a rod leads to a point (x, z), seen from the horn's axis; `side`
  // of that line on which the knee lies: 1 counterclockwise, -1 clockwise.
  function bend({horn, rod}, x, z, side) {
    const far = Math.hypot(x, z), cosine = (far * far + horn * horn - rod * rod) / (2 * horn * far);
    return Math.atan2(z, x) + side * Math.acos(Math.min(1, Math.max(-1, cosine)));
  }

  // Kinematics of a run's legs. `at(phi, theta, servos)` returns the points axis, knee and joint of
  // each leg, from the center of the joints at home, m. Without the servos' angles, the plate keeps
  // its height at home.
  function kinematics({legs, phiOffset, thetaOffset}) {
    const parts = legs.map((leg) => ({
      ...leg, home: bend(leg, leg.plate - leg.base, leg.height, -1),
      out: new THREE.Vector3(Math.cos(leg.angle), Math.sin(leg.angle), 0), aside: new THREE.Vector3(-Math.sin(leg.angle), Math.cos(leg.angle), 0),
    }));
    // A sum over the legs in which a shift of the plate cancels.
    const between = (i, k) => parts[i].out.clone().cross(parts[k].out).z;
    const sum = (termOf) => parts.reduce((all, leg, i) => all + between((i + 1) % 3, (i + 2) % 3) * termOf(leg), 0);

    // The joints on a tilted plate, turned about its normal and shifted such that each is in its leg's plane.
    function jointsOn(normal) {
      const tilt = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), normal);
      const tilted = (vector) => vector.clone().applyQuaternion(tilt);
      // The turn: a cos + b sin + c = 0.
      const a = sum(({plate, aside, out}) => plate * aside.dot(tilted(out))), b = sum(({plate, aside}) => plate * aside.dot(tilted(aside)));
      const c = sum(({joint, aside}) => joint * aside.dot(normal));
      const square = a * a + b * b, root = Math.sign(b) * Math.sqrt(Math.max(0, square - c * c));
      const cosine = (b * root - a * c) / square, sine = -(b * c + a * root) / square;
      const joints = parts.map(({plate, joint, out, aside}) => tilted(out).multiplyScalar(plate * cosine)
          .addScaledVector(tilted(aside), plate * sine).addScaledVector(normal, joint));
      const [p, q] = parts.map(({aside}) => aside), far = p.dot(joints[0]), other = q.dot(joints[1]);
      const shift = new THREE.Vector3(other * p.y - far * q.y, far * q.x - other * p.x, 0).divideScalar(between(0, 1));
      return joints.map((joint) => joint.add(shift));
    }

    function at(phi, theta, servos) {
      const [f, t] = [phi - phiOffset, theta - thetaOffset];
      const joints = jointsOn(new THREE.Vector3(Math.sin(f) * Math.cos(t), -Math.sin(t), Math.cos(f) * Math.cos(t)));
      // The rods determine the joints' heights above the horns' ends.
      const lifts = servos ? parts.map((leg, i) => {
        const horn = leg.home + leg.offset + leg.direction * servos[i], out = joints[i].dot(leg.out) - leg.base - leg.horn * Math.cos(horn);
        return leg.joint - leg.height + leg.horn * Math.sin(horn) + Math.sqrt(Math.max(0, leg.rod * leg.rod - out * out)) - joints[i].z;
      }) : [0, 0, 0];
      const lift = (lifts[0] + lifts[1] + lifts[2]) / 3;
      return parts.map((leg, i) => {
        const foot = leg.joint - leg.height, far = joints[i].dot(leg.out), z = joints[i].z + lift;
        const horn = bend(leg, far - leg.base, z - foot, -1), point = (out, up) => leg.out.clone().multiplyScalar(out).setZ(up).toArray();
        return {axis: point(leg.base, foot), knee: point(leg.base + leg.horn * Math.cos(horn), foot + leg.horn * Math.sin(horn)), joint: point(far, z)};
      });
    }
    return {at, depth: Math.max(...parts.map((leg) => leg.height - leg.joint))};
  }

  // A servo with horn, rod and joint; place() moves them.
  function limbIn(group, size, materials) {
    const thick = 0.012 * size, up = new THREE.Vector3(0, 1, 0);
    const add = (geometry, material) => {
      const mesh = new THREE.Mesh(geometry, material);
      group.add(mesh);
      return mesh;
    };
    const bar = (radius, material) => add(new THREE.CylinderBufferGeometry(radius, radius, 1, 16), material);
    const servo = add(new THREE.BoxBufferGeometry(3 * thick, 2 * thick, 3 * thick), materials.metal);
    const horn = bar(thick, materials.axle), rod = bar(0.5 * thick, materials.frame);
    const joint = add(new THREE.SphereBufferGeometry(0.9 * thick, 20, 12), materials.axle);
    const stretch = (mesh, from, to) => {
      const way = to.clone().sub(from);
      mesh.position.copy(from).addScaledVector(way, 0.5);
      mesh.scale.set(1, way.length(), 1);
      mesh.quaternion.setFromUnitVectors(up, way.normalize());
    };
    return {
      thick, servo, bar, stretch,
      place(points) {
        const [axis, knee, end] = ['axis', 'knee', 'joint'].map((name) => new THREE.Vector3(...points[name]));
        servo.position.copy(axis);
        joint.position.copy(end);
        stretch(horn, axis, knee);
        stretch(rod, knee, end);
      },
    };
  }

  // A push rod that turns axis 0 (phi, about y) or 1 (theta, about x); `at`: its place along that axis.
  function buildRod(run, axis, at, size, materials) {
    const {arm, offset: [x, z], zero} = run, group = new THREE.Group(), limb = limbIn(group, size, materials);
    const crank = limb.bar(limb.thick, materials.axle), center = new THREE.Vector3().setComponent(1 - axis, at);
    // From the linkage's plane, where the gimbal's axis is at the origin, to the gimbal's frame.
    const inSpace = ([along, up]) => (axis === 0 ? [-along, at, up] : [at, along, up]);
    const wrapped = (angle) => Math.atan2(Math.sin(angle), Math.cos(angle));
    const bySize = (a, b) => Math.abs(wrapped(a)) - Math.abs(wrapped(b));
    // The run keeps the branch on which horn and arm are nearest to home when the servo is at zero.
    const [first] = [1, -1].map((side) => bend({horn: arm, rod: run.rod}, run.horn - x, -z, side)).sort(bySize);
    const hornAt = (angle, side) => bend(run, x + arm * Math.cos(angle), z + arm * Math.sin(angle), side);
    const [branch] = [1, -1].sort((a, b) => bySize(hornAt(first, a), hornAt(first, b)));
    function placesAt(angle) {
      const turned = angle - zero, horn = hornAt(turned, branch);
      const places = {axis: [-x, -z], knee: [run.horn * Math.cos(horn) - x, run.horn * Math.sin(horn) - z], joint: [arm * Math.cos(turned), arm * Math.sin(turned)]};
      return {horn, ...Object.fromEntries(Object.entries(places).map(([name, place]) => [name, inSpace(place)]))};
    }
    let places = null;
    return {
      group,
      places: () => places,
      set(angle) {
        places = placesAt(angle);
        limb.place(places);
        limb.stretch(crank, center, new THREE.Vector3(...places.joint));
      },
    };
  }

  // The legs as meshes in a group; set() moves them. `level`: height of the joints' center at home.
  function build(run, level, size, materials) {
    const chain = kinematics(run.legs), group = new THREE.Group();
    const limbs = run.legs.legs.map((leg) => {
      const limb = limbIn(group, size, materials);
      limb.servo.rotation.z = leg.angle;
      return limb;
    });
    let points = [];
    return {
      group,
      depth: chain.depth - level + 2 * limbs[0].thick,
      // Axis, knee and joint of each leg in the base's frame, m.
      points: () => points,
      set(phi, theta, servos) {
        points = chain.at(phi, theta, servos);
        points.forEach((leg, i) => {
          for (const name of ['axis', 'knee', 'joint']) leg[name][2] += level;
          limbs[i].place(leg);
        });
      },
    };
  }

  return {build, buildRod};
})();
