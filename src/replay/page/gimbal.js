// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The rig at its true size: the base, the ring that turns by phi, and the plate that turns by theta
// in it; or three legs under the plate in place of base and ring. Frames as in docs/explanation/model.md: R = R_x(base tilt) R_y(phi) R_z(skew) R_x(theta)
// R_z(yaw - skew).
bbsim.gimbal = (() => {
  const {runs, scene: {stage}} = bbsim.data;

  // A frame of square bars with rounded corners, centered at the origin; halfX and halfY are half
  // its inner width.
  function frameGeometry(halfX, halfY, bar, round) {
    const outline = (x, y, radius, path) => {
      if (round) return path.absarc(0, 0, x, 0, 2 * Math.PI, false);
      path.moveTo(x, -y + radius);
      path.lineTo(x, y - radius);
      path.absarc(x - radius, y - radius, radius, 0, Math.PI / 2, false);
      path.lineTo(-x + radius, y);
      path.absarc(-x + radius, y - radius, radius, Math.PI / 2, Math.PI, false);
      path.lineTo(-x, -y + radius);
      path.absarc(-x + radius, -y + radius, radius, Math.PI, 1.5 * Math.PI, false);
      path.lineTo(x - radius, -y);
      path.absarc(x - radius, -y + radius, radius, 1.5 * Math.PI, 2 * Math.PI, false);
    };
    const shape = new THREE.Shape(), hole = new THREE.Path();
    outline(halfX + bar, halfY + bar, 2 * bar, shape);
    outline(halfX, halfY, bar, hole);
    shape.holes.push(hole);
    const bevel = 0.18 * bar;
    const geometry = new THREE.ExtrudeBufferGeometry(shape, {
      depth: bar - 2 * bevel, bevelThickness: bevel, bevelSize: bevel, bevelOffset: -bevel, bevelSegments: 2,
      curveSegments: round ? 40 : 5,
    });
    geometry.translate(0, 0, -bar / 2 + bevel);
    return geometry;
  }

  // A rod between two points of an axis, 'x' or 'y'.
  function rod(axis, from, to, radius, material) {
    const mesh = new THREE.Mesh(new THREE.CylinderBufferGeometry(radius, radius, Math.abs(to - from), 20), material);
    if (axis === 'x') mesh.rotation.z = Math.PI / 2;
    mesh.position[axis] = (from + to) / 2;
    return mesh;
  }

  function box(size, at, material) {
    const mesh = new THREE.Mesh(new THREE.BoxBufferGeometry(...size), material);
    mesh.position.set(...at);
    return mesh;
  }

  // Grid lines at 1, 2 or 5 times a power of ten, about a dozen across the plate.
  const gridSpacing = () => bbsim.text.roundUp(0.085 * Math.max(stage.width, stage.depth));

  // The plate's face with its grid and its rim, so large in pixels, in meters from its corner.
  function paintPlate(ink, across, down, palette) {
    const {width, depth} = stage, size = Math.max(width, depth);
    ink.save();
    ink.scale(across / width, down / depth);
    ink.fillStyle = palette.plate;
    ink.fillRect(0, 0, width, depth);
    const spacing = gridSpacing(), line = size / 460;
    ink.strokeStyle = palette.grid;
    for (let n = 0; n * spacing < size / 2; ++n) {
      ink.lineWidth = n === 0 ? 2 * line : line;
      ink.beginPath();
      for (const side of n === 0 ? [0] : [-n, n]) {
        ink.moveTo(width / 2 + side * spacing, 0);
        ink.lineTo(width / 2 + side * spacing, depth);
        ink.moveTo(0, depth / 2 + side * spacing);
        ink.lineTo(width, depth / 2 + side * spacing);
      }
      ink.stroke();
    }
    ink.strokeStyle = palette.rim;
    ink.lineWidth = 5 * line;
    ink.setLineDash(stage.plateGiven ? [] : [size / 40, size / 60]);  // dashed if fitted
    ink.beginPath();
    if (stage.round) ink.arc(width / 2, depth / 2, width / 2 - 2.5 * line, 0, 2 * Math.PI);
    else ink.rect(2.5 * line, 2.5 * line, width - 5 * line, depth - 5 * line);
    ink.stroke();
    ink.restore();
  }

  function build(run, materials) {
    const size = Math.max(stage.width, stage.depth);
    const bar = 0.03 * size, gap = 0.025 * size, thickness = 0.014 * size;
    const halfX = stage.width / 2 + gap, halfY = stage.depth / 2 + gap;
    const {height, skew, yaw, baseTilt} = run.mounting;
    const legs = run.legs ? bbsim.legs.build(run, height - 2 * thickness, size, materials) : null;
    const postY = halfY + bar + 0.7 * gap, foot = legs ? legs.depth : Math.min(0.46 * size, 0.16 * size + 0.6 * Math.min(stage.width, stage.depth));

    const base = new THREE.Group();
    base.rotation.x = baseTilt;
    if (legs) base.add(legs.group);
    for (const side of legs ? [] : [-1, 1]) {
      const y = side * (postY + bar / 2);
      const post = box([1.5 * bar, bar, foot], [0, y, -foot / 2], materials.metal);
      const bearing = rod('y', -bar / 2, bar / 2, 0.95 * bar, materials.metal);
      bearing.position.set(0, y, 0);
      base.add(post, bearing, box([5 * bar, 1.6 * bar, 0.35 * bar], [0, y, -foot], materials.metal));
    }
    if (!legs) base.add(box([1.5 * bar, 2 * postY, 0.35 * bar], [0, 0, -foot], materials.metal));

    const ring = new THREE.Group();
    if (!legs) ring.add(new THREE.Mesh(frameGeometry(halfX, halfY, bar, stage.round), materials.frame));
    for (const side of legs ? [] : [-1, 1]) {
      ring.add(rod('y', side * (halfY + bar * 0.6), side * (postY + 1.25 * bar), 0.32 * bar, materials.axle));
    }
    const cross = new THREE.Group();
    cross.rotation.z = skew;
    const hinge = new THREE.Group();
    for (const side of legs ? [] : [-1, 1]) {
      hinge.add(rod('x', side * (stage.width / 2 - gap), side * (halfX + bar * 0.5), 0.28 * bar, materials.axle));
    }
    const plane = new THREE.Group();
    plane.rotation.z = yaw - skew;
    const disc = stage.round
        ? new THREE.CylinderBufferGeometry(stage.width / 2, stage.width / 2, thickness, 96).rotateX(Math.PI / 2)
        : new THREE.BoxBufferGeometry(stage.width, stage.depth, thickness);
    const slab = new THREE.Mesh(disc, materials.slab);
    slab.position.z = height - thickness / 2 - 0.002 * size;
    const face = new THREE.Mesh(stage.round ? new THREE.CircleBufferGeometry(stage.width / 2, 96)
                                            : new THREE.PlaneBufferGeometry(stage.width, stage.depth), materials.face);
    face.position.z = height;
    plane.add(slab, face);
    if (Math.abs(height) > thickness && !legs) {
      plane.add(box([2 * bar, 2 * bar, Math.abs(height)], [0, 0, height / 2 - thickness / 2], materials.axle));
    }

    base.add(ring);
    ring.add(cross);
    cross.add(hinge);
    hinge.add(plane);
    // The points that must be in the picture: ends of the posts, and corners of the ring and the
    // plate at all of their angles.
    function outlineAt(factor) {
      const angles = (name) => {
        const seen = runs.map((one) => one.columns.get(name)).filter(Boolean);
        const within = (angle) => Math.min(Math.max(factor * angle, -Math.PI), Math.PI);
        const low = within(Math.min(0, ...seen.map((column) => column.least)));
        const high = within(Math.max(0, ...seen.map((column) => column.greatest)));
        const steps = Math.min(10, Math.ceil((high - low) / 0.3)) || 1;
        return Array.from({length: steps + 1}, (_, i) => low + i / steps * (high - low));
      };
      const points = [], turned = new THREE.Matrix4().makeRotationX(baseTilt);
      const add = (matrix, x, y, z) => points.push(new THREE.Vector3(x, y, z).applyMatrix4(matrix));
      const corners = stage.round ? Array.from({length: 12}, (_, i) => [Math.cos(i * Math.PI / 6), Math.sin(i * Math.PI / 6)])
                                  : [[-1, -1], [-1, 1], [1, -1], [1, 1]];
      for (const [x, y] of legs ? corners : []) add(turned, x * legs.reach, y * legs.reach, -foot);
      for (const y of legs ? [] : [-1, 1]) {
        for (const x of [-1, 1]) add(turned, x * 2.5 * bar, y * (postY + bar), -foot);
        add(turned, 0, y * (postY + 1.4 * bar), bar);
      }
      const thetas = angles('theta');
      for (const phi of angles('phi')) {
        const outer = turned.clone().multiply(new THREE.Matrix4().makeRotationY(phi));
        for (const [x, y] of legs ? [] : corners) {
          for (const z of [-1.5 * bar, 1.5 * bar]) add(outer, x * (halfX + bar), y * (halfY + bar), z);
        }
        for (const theta of thetas) {
          const inner = outer.clone().multiply(new THREE.Matrix4().makeRotationZ(skew))
              .multiply(new THREE.Matrix4().makeRotationX(theta)).multiply(new THREE.Matrix4().makeRotationZ(yaw - skew));
          for (const [x, y] of corners) add(inner, x * stage.width / 2, y * stage.depth / 2, height);
        }
      }
      return points;
    }
    let outline = outlineAt(1);
    return {
      base, ring, hinge, plane, size, foot, legs,
      ballRadius: run.ball.radius, ball: new THREE.Vector3(),
      long: stage.depth > 2 * stage.width ? 'y' : 'x',
      outline: () => outline,
      reach(factor) { outline = outlineAt(factor); },
      set(phi, theta, servos) {
        ring.rotation.y = phi;
        hinge.rotation.x = theta;
        if (legs) legs.set(phi, theta, servos);
      },
    };
  }

  // The gimbal of a run that does not lead: its links and the edge of its plate.
  function buildGhost(run, line) {
    const base = new THREE.Group(), ring = new THREE.Group(), cross = new THREE.Group(), hinge = new THREE.Group(),
          plane = new THREE.Group();
    base.rotation.x = run.mounting.baseTilt;
    cross.rotation.z = run.mounting.skew;
    plane.rotation.z = run.mounting.yaw - run.mounting.skew;
    base.add(ring);
    ring.add(cross);
    cross.add(hinge);
    hinge.add(plane);
    const points = [];
    const corners = stage.round ? 96 : 4;
    for (let i = 0; i <= corners; ++i) {
      const angle = 2 * Math.PI * (i + (stage.round ? 0 : 0.5)) / corners;
      const c = Math.cos(angle), s = Math.sin(angle);
      points.push(stage.round ? new THREE.Vector3(c * stage.width / 2, s * stage.depth / 2, 0)
                              : new THREE.Vector3(Math.sign(c) * stage.width / 2, Math.sign(s) * stage.depth / 2, 0));
    }
    const outline = new THREE.BufferGeometry().setFromPoints(points);
    for (const [name, of] of [['normal', 3], ['uv', 2]]) {
      outline.setAttribute(name, new THREE.BufferAttribute(new Float32Array(of * points.length), of));
    }
    const edge = new THREE.Line(outline, line);
    edge.position.z = run.mounting.height;
    plane.add(edge);
    return {
      base, plane,
      set(phi, theta) {
        ring.rotation.y = phi;
        hinge.rotation.x = theta;
      },
    };
  }

  return {build, buildGhost, paintPlate, gridSpacing};
})();
