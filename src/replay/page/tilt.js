// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// The plate's true tilt at a time, without exaggeration: its angle, and the downhill direction in
// the plate's frame. Null if the run does not give both angles; on a beam the other angle is zero.
bbsim.tilt = (run, t) => {
  const phi = run.angleAt(t, 'phi'), theta = run.angleAt(t, 'theta');
  if (!Number.isFinite(phi) || !Number.isFinite(theta)) return null;
  const {skew, yaw, baseTilt} = run.mounting;
  // Turns the vertical back into the plate's frame, link by link.
  let [x, y, z] = [0, Math.sin(baseTilt), Math.cos(baseTilt)];
  const turn = (a, b, angle) => [a * Math.cos(angle) + b * Math.sin(angle), b * Math.cos(angle) - a * Math.sin(angle)];
  [z, x] = turn(z, x, phi);
  [x, y] = turn(x, y, skew);
  [y, z] = turn(y, z, theta);
  [x, y] = turn(x, y, yaw - skew);
  return {angle: Math.atan2(Math.hypot(x, y), z), x: -x, y: -y};
};
