// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The ball. Octants in two colors, the engineer's mark of a center of mass, show rotation about any
// axis. A dot on one of them distinguishes a whole turn from half a turn.
bbsim.ball = (() => {
  function paint(canvas, cream, colour, plain) {
    const ink = canvas.getContext('2d', {willReadFrequently: true});
    const {width, height} = canvas;
    ink.fillStyle = plain ? colour : cream;
    ink.fillRect(0, 0, width, height);
    if (plain) return;
    ink.fillStyle = colour;
    for (let sector = 0; sector < 4; ++sector) {
      ink.fillRect(sector * width / 4, sector % 2 === 0 ? 0 : height / 2, width / 4, height / 2);
    }
    ink.strokeStyle = 'rgba(20, 24, 30, .55)';
    ink.lineWidth = width / 160;
    const meridians = [0, 1, 2, 3, 4].map((sector) => `M${sector * width / 4} 0V${height}`);
    ink.stroke(new Path2D(`${meridians.join('')}M0 ${height / 2}H${width}`));
    ink.fillStyle = 'rgba(20, 24, 30, .8)';
    ink.beginPath();
    ink.ellipse(0.375 * width, 0.27 * height, width / 26, height / 18, 0, 0, 2 * Math.PI);
    ink.fill();
  }

  // A ball whose rotation is unknown is plain. Balls at the same place must not flicker: the ball of a
  // run covers those of later ones, which are drawn a little smaller and farther away.
  function build({ball: {radius}, index, turns}) {
    const plain = !turns, ghost = index > 0;
    const canvas = bbsim.text.element('canvas', {width: 512, height: 256});
    const texture = new THREE.CanvasTexture(canvas);
    const material = bbsim.paint.lit({
      map: texture, gloss: 0.3, transparent: ghost, opacity: ghost ? 0.72 : 1,
      polygonOffset: ghost, polygonOffsetFactor: index, polygonOffsetUnits: 8 * index,
    });
    const mesh = new THREE.Mesh(new THREE.SphereBufferGeometry(radius * (1 - 0.003 * index), 40, 28), material);
    return {
      mesh,
      dispose() {
        texture.dispose();
        material.dispose();
      },
      colour(cream, colour) {
        paint(canvas, cream, colour, plain);
        texture.needsUpdate = true;
      },
    };
  }

  return {build};
})();
