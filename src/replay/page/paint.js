// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Paints on the plate: paths as ribbons, marks, and small labels that face the eye.
bbsim.paint = (() => {
  // A ribbon along points (xs, ys), with one quad for each segment. `dash` cuts it into dashes of
  // lengths [on, off]. Points too far away to be drawn leave a gap. The material sets the ribbon's
  // width (`spread`); `width` is its usual value. The returned geometry has `until`, the number of
  // indices for the first n points, and `reached`, the last of these points that the ribbon
  // reaches.
  function ribbon(xs, ys, width, dash = null) {
    const positions = [], aside = [], indices = [], until = new Uint32Array(xs.length + 1), reached = new Int32Array(xs.length + 1);
    const [on, off] = dash || [Number.MAX_VALUE, 0];
    reached[0] = -1;
    let along = 0;
    const quad = (ax, ay, bx, by, ux, uy) => {
      const first = positions.length / 3, nx = -uy / 2, ny = ux / 2;
      const ox = dash ? 0 : 0.3 * ux, oy = dash ? 0 : 0.3 * uy;  // closes gaps at corners
      positions.push(ax, ay, 0, bx, by, 0, bx, by, 0, ax, ay, 0);
      aside.push(-ox - nx, -oy - ny, 0, ox - nx, oy - ny, 0, ox + nx, oy + ny, 0, nx - ox, ny - oy, 0);
      indices.push(first, first + 1, first + 2, first, first + 2, first + 3);
    };
    let last = -1;
    for (let i = 0; i < xs.length; ++i) {
      if (bbsim.data.shown(xs[i]) && bbsim.data.shown(ys[i])) {
        if (last >= 0) {
          const ax = xs[last], ay = ys[last], length = Math.hypot(xs[i] - ax, ys[i] - ay);
          // A fifth of the width is too short to be seen.
          if (length > width / 5) {
            const ux = (xs[i] - ax) / length, uy = (ys[i] - ay) / length;
            for (let from = 0; from < length;) {
              const phase = (along + from) % (on + off), drawn = phase < on;
              const to = Math.min(length, from + Math.max((drawn ? on : on + off) - phase, 1e-6 * on));
              if (drawn) quad(ax + ux * from, ay + uy * from, ax + ux * to, ay + uy * to, ux, uy);
              from = to;
            }
            along += length;
            last = i;
          }
        } else {
          last = i;
        }
      } else {
        last = -1;
      }
      until[i + 1] = indices.length;
      reached[i + 1] = last;
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(positions), 3));
    // All bodies have the same attributes, so that only one program is compiled.
    geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(aside), 3));
    geometry.setAttribute('uv', new THREE.BufferAttribute(new Float32Array(positions.length / 3 * 2), 2));
    geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(indices), 1));
    Object.assign(geometry, {until, reached});
    return geometry;
  }

  const white = new THREE.DataTexture(new Uint8Array([255, 255, 255, 255]), 1, 1, THREE.RGBAFormat);
  white.needsUpdate = true;
  const lights = {
    lamp: {value: new THREE.Vector3(-0.35, 0.75, 1.25).normalize()},
    lampColour: {value: new THREE.Color()}, sky: {value: new THREE.Color()}, earth: {value: new THREE.Color()},
  };

  // One small program draws everything, because the first picture waits for the compilation of
  // programs. Light comes from the sky above, the earth below and one lamp. The lamp's gleam moves
  // over a plate that tilts.
  const vertexShader = `
    precision highp float;
    attribute vec3 position, normal;
    attribute vec2 uv;
    uniform mat4 modelMatrix, modelViewMatrix, projectionMatrix;
    uniform vec3 cameraPosition;
    uniform float spread;
    varying vec3 direction, toEye;
    varying vec2 place;
    void main() {
      vec4 here = vec4(position + spread * normal, 1.0), world = modelMatrix * here;
      direction = mat3(modelMatrix[0].xyz, modelMatrix[1].xyz, modelMatrix[2].xyz) * normal / length(modelMatrix[0].xyz);
      toEye = cameraPosition - world.xyz;
      place = uv;
      gl_Position = projectionMatrix * modelViewMatrix * here;  // exact about a small ball, too
    }`;
  const fragmentShader = `
    precision highp float;
    uniform sampler2D map;
    uniform vec3 color, lamp, lampColour, sky, earth;
    uniform float opacity, gloss, lit;
    varying vec3 direction, toEye;
    varying vec2 place;
    void main() {
      vec4 texel = texture2D(map, place);
      vec3 base = texel.rgb * color;
      vec3 n = normalize(direction + vec3(0.0, 0.0, 1e-6));
      vec3 light = mix(earth, sky, 0.5 + 0.5 * n.z) + lampColour * max(dot(n, lamp), 0.0);
      float gleam = pow(max(dot(n, normalize(lamp + normalize(toEye))), 0.0), 50.0);
      gl_FragColor = vec4(mix(base, base * light + gloss * gleam, lit), texel.a * opacity);
    }`;

  function material({map = white, opacity = 1, gloss = 0, lit = 1, spread = 0, ...options}) {
    const uniforms = {
      ...lights, map: {value: map}, color: {value: new THREE.Color(0xffffff)}, opacity: {value: opacity},
      gloss: {value: gloss}, lit: {value: lit}, spread: {value: spread},
    };
    const made = new THREE.RawShaderMaterial({uniforms, vertexShader, fragmentShader, ...options});
    made.color = uniforms.color.value;
    made.spread = uniforms.spread;
    made.map = null;  // only materials of three.js itself use it
    return made;
  }
  // Materials of bodies, and of paint on them.
  const lit = (options = {}) => material(options);
  const flat = (options = {}) => material({
    lit: 0, depthWrite: false, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -4, ...options,
  });

  // The mark of the reference: a ring with a cross.
  function target(radius, material) {
    const group = new THREE.Group();
    group.add(new THREE.Mesh(new THREE.RingBufferGeometry(0.88 * radius, radius, 48), material));
    for (const turn of [0, 0.5, 1, 1.5].map((part) => part * Math.PI)) {
      const bar = new THREE.Mesh(new THREE.PlaneBufferGeometry(0.5 * radius, 0.12 * radius), material);
      bar.rotation.z = turn;
      bar.position.set(1.05 * radius * Math.cos(turn), 1.05 * radius * Math.sin(turn), 0);
      group.add(bar);
    }
    return group;
  }

  // An arrow from the origin along x or y.
  function arrow(axis, length, width, material) {
    const neck = length - 3.2 * width;
    const shape = new THREE.Shape([[0, -0.5], [neck, -0.5], [neck, -1.6], [length, 0], [neck, 1.6], [neck, 0.5], [0, 0.5]]
        .map(([x, y]) => new THREE.Vector2(x, y * width)));
    const mesh = new THREE.Mesh(new THREE.ShapeBufferGeometry(shape), material);
    if (axis === 'y') mesh.rotation.z = Math.PI / 2;
    return mesh;
  }

  // The mark of an event: an octagon if it stopped the run, a diamond if it was noted.
  function eventMark(action, radius, fill, rim) {
    const [sides, turn] = action === 'stop' ? [8, Math.PI / 8] : [4, 0];
    const outer = new THREE.Mesh(new THREE.CircleBufferGeometry(radius, sides, turn), rim);
    const inner = new THREE.Mesh(new THREE.CircleBufferGeometry(0.68 * radius, sides, turn), fill);
    inner.renderOrder = 0.5;  // draws it above the other one, which is in the same plane
    return new THREE.Group().add(outer, inner);
  }

  // Places a mesh with sizes in pixels and turns it to the camera. `pixel` is the size of a pixel at
  // distance 1.
  function face(mesh, place, camera, pixel) {
    const deep = Math.max(-place.clone().applyMatrix4(camera.matrixWorldInverse).z, 1e-30);
    mesh.quaternion.setFromRotationMatrix(camera.matrixWorld);
    mesh.scale.setScalar(deep * pixel);
    mesh.position.copy(place);
    mesh.updateMatrixWorld(true);
  }

  // A ring of constant size, in pixels, about a ball that is too small to be seen.
  function marker(fill, rim) {
    const group = new THREE.Group();
    for (const [inner, outer, material, order] of [[5.5, 10.5, rim, 14], [6.5, 9.5, fill, 15]]) {
      const ring = new THREE.Mesh(new THREE.RingBufferGeometry(inner, outer, 40), material);
      ring.renderOrder = order;
      group.add(ring);
    }
    return group;
  }

  // A soft round shadow.
  function shadow(darkness) {
    const canvas = bbsim.text.element('canvas', {width: 128, height: 128});
    const ink = canvas.getContext('2d', {willReadFrequently: true});
    const fade = ink.createRadialGradient(64, 64, 0, 64, 64, 64);
    for (const [at, part] of [[0, 1], [0.45, 0.75], [0.7, 0.32], [1, 0]]) {
      fade.addColorStop(at, `rgba(0, 0, 0, ${darkness * part})`);
    }
    ink.fillStyle = fade;
    ink.fillRect(0, 0, 128, 128);
    return new THREE.Mesh(new THREE.PlaneBufferGeometry(2, 2), flat({map: new THREE.CanvasTexture(canvas), transparent: true}));
  }

  // The mark of a sensor point: an upright cross.
  function cross(size, material) {
    const bars = [[size, 0.22 * size], [0.22 * size, size]].map((sides) => new THREE.Mesh(new THREE.PlaneBufferGeometry(...sides), material));
    return new THREE.Group().add(...bars);
  }

  return {lights, ribbon, lit, flat, target, arrow, eventMark, face, marker, shadow, cross};
})();
