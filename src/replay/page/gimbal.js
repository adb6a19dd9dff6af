// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The rig at its true size: the base, the ring that turns by phi, and the plate that turns by theta
// in it, perhaps with push rods; or three legs under the plate in place of base and ring. Frames as
// in docs/explanation/model.md: R = R_x(base tilt) R_y(phi) R_z(skew) R_x(theta) R_z(yaw - skew).
bbsim.gimbal = (() => {
  const {runs, scene: {stage}} = bbsim.data;

  // The links of a run's gimbal, each in the frame of the one before.
  function linksOf({mounting: {skew, yaw, baseTilt}}) {
    const [base, ring, cross, hinge, plane] = Array.from({length: 5}, () => new THREE.Group());
    base.rotation.x = baseTilt;
    cross.rotation.z = skew;
    plane.rotation.z = yaw - skew;
    [base, ring, cross, hinge].forEach((link, i) => link.add([ring, cross, hinge, plane][i]));
    return {
      base, ring, cross, hinge, plane,
      set(phi, theta) {
        ring.rotation.y = phi;
        hinge.rotation.x = theta;
      },
    };
  }

  // A rod between two points of an axis, 'x' or 'y'.
  function rod(axis, from, to, radius, material) {
    const mesh = new THREE.Mesh(new THREE.CylinderBufferGeometry(radius, radius, Math.abs(to - from), 20), material);
    if (axis === 'x') mesh.rotation.z = Math.PI / 2;
    mesh.position[axis] = (from + to) / 2;
    return mesh;
  }

  // A frame of round bars about the origin, whose middle lines are at +-x and +-y.
  function frame(x, y, bar, material) {
    const group = new THREE.Group(), add = (part, at = [part.position.x, part.position.y]) => {
      part.position.set(...at, 0);
      group.add(part);
    };
    if (stage.round) add(new THREE.Mesh(new THREE.TorusBufferGeometry(x, bar / 2, 16, 96), material));
    for (const side of stage.round ? [] : [-1, 1]) {
      add(rod('x', -x, x, bar / 2, material), [0, side * y]);
      add(rod('y', -y, y, bar / 2, material), [side * x, 0]);
      for (const end of [-1, 1]) add(new THREE.Mesh(new THREE.SphereBufferGeometry(bar / 2, 20, 14), material), [side * x, end * y]);
    }
    return group;
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
    for (let many = Math.ceil(size / 2 / spacing) - 1, n = -many; n <= many; ++n) {
      ink.lineWidth = n === 0 ? 2 * line : line;
      ink.stroke(new Path2D(`M${width / 2 + n * spacing} 0V${depth}M0 ${depth / 2 + n * spacing}H${width}`));
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
    const {height} = run.mounting, links = linksOf(run), {base, ring, cross, hinge, plane} = links;
    const legs = run.legs ? bbsim.legs.build(run, height - 2 * thickness, size, materials) : null;
    const postY = halfY + bar + 0.7 * gap, foot = legs ? legs.depth : Math.min(0.46 * size, 0.16 * size + 0.6 * Math.min(stage.width, stage.depth));

    if (legs) base.add(legs.group);
    for (const side of legs ? [] : [-1, 1]) {
      const y = side * (postY + bar / 2);
      const post = box([1.5 * bar, bar, foot], [0, y, -foot / 2], materials.metal);
      const bearing = rod('y', -bar / 2, bar / 2, 0.95 * bar, materials.metal);
      bearing.position.set(0, y, 0);
      base.add(post, bearing, box([5 * bar, 1.6 * bar, 0.35 * bar], [0, y, -foot], materials.metal));
      ring.add(rod('y', side * (halfY + bar * 0.6), side * (postY + 1.25 * bar), 0.32 * bar, materials.axle));
      hinge.add(rod('x', side * (stage.width / 2 - gap), side * (halfX + bar * 0.5), 0.28 * bar, materials.axle));
    }
    if (!legs) {
      base.add(box([1.5 * bar, 2 * postY, 0.35 * bar], [0, 0, -foot], materials.metal));
      ring.add(frame(halfX + bar / 2, halfY + bar / 2, bar, materials.frame));
    }
    // Push rods turn the ends of the axles: phi's from the base, theta's from the ring.
    const ends = [-postY - 1.25 * bar, halfX + 1.5 * bar];
    const rods = run.rods.map((one, axis) => one && bbsim.legs.buildRod(one, axis, ends[axis], size, materials));
    rods.forEach((one, axis) => one && [base, cross][axis].add(one.group));
    if (rods[1]) hinge.add(rod('x', halfX, ends[1], 0.28 * bar, materials.axle));
    const solids = [];
    base.traverse((part) => { if (part.isMesh) solids.push(part); });

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

    const set = (phi, theta, servos = null) => {
      links.set(phi, theta);
      if (legs) legs.set(phi, theta, servos);
      rods.forEach((one, axis) => one && one.set([phi, theta][axis]));
    };

    // The points of the world that must be in the picture: some of each part's, from its least to its greatest angles.
    const parts = [];
    base.traverse((part) => { if (part.isMesh) parts.push(part); });
    let factor = 1, outline = null;
    function findOutline() {
      const [phis, thetas] = ['phi', 'theta'].map((name) => {
        const seen = runs.map((one) => one.columns.get(name)).filter(Boolean);
        const within = (angle) => Math.min(Math.max(factor * angle, -Math.PI), Math.PI);
        const low = within(Math.min(0, ...seen.map(({least}) => least))), high = within(Math.max(0, ...seen.map(({greatest}) => greatest)));
        const steps = Math.ceil((high - low) / 0.7) || 1;
        return Array.from({length: steps + 1}, (_, i) => low + i / steps * (high - low));
      });
      const points = [], now = [ring.rotation.y, hinge.rotation.x];
      for (const [phi, theta] of phis.flatMap((one) => thetas.map((other) => [one, other]))) {
        set(phi, theta);
        base.parent.updateMatrixWorld(true);
        for (const {geometry: {attributes: {position}}, matrixWorld} of parts) {
          const every = Math.ceil(position.count / 24);
          for (let i = 0; i < position.count; i += every) points.push(new THREE.Vector3().fromBufferAttribute(position, i).applyMatrix4(matrixWorld));
        }
      }
      set(...now);
      base.parent.updateMatrixWorld(true);
      return points;
    }
    return {
      ...links, size, foot, legs, rods, solids,
      ballRadius: run.ball.radius, ball: new THREE.Vector3(),
      long: stage.depth > 2 * stage.width ? 'y' : 'x',
      outline: () => outline || (outline = findOutline()),
      reach(value) { [factor, outline] = [value, null]; },
      set,
    };
  }

  // The gimbal of a run that does not lead: its links and the edge of its plate.
  function buildGhost(run, line) {
    const links = linksOf(run), corners = stage.round ? 96 : 4;
    const outline = new THREE.BufferGeometry().setFromPoints(Array.from({length: corners + 1}, (_, i) => {
      const angle = 2 * Math.PI * (i + (stage.round ? 0 : 0.5)) / corners;
      const [x, y] = [Math.cos(angle), Math.sin(angle)].map((part) => (stage.round ? part : Math.sign(part)));
      return new THREE.Vector3(x * stage.width / 2, y * stage.depth / 2, run.mounting.height);
    }));
    for (const [name, of] of [['normal', 3], ['uv', 2]]) {
      outline.setAttribute(name, new THREE.BufferAttribute(new Float32Array(of * (corners + 1)), of));
    }
    links.plane.add(new THREE.Line(outline, line));
    return links;
  }

  return {linksOf, build, buildGhost, paintPlate, gridSpacing};
})();
