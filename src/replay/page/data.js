// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// Decodes the numbers of the page's scene, and makes runs that know their state at any time. A live
// page replaces the scene: runs keep their identity, and views listen with onChange().
bbsim.data = (() => {
  function bytes(text) {
    const raw = atob(text);
    const result = new Uint8Array(raw.length);
    for (let i = 0; i < raw.length; ++i) result[i] = raw.charCodeAt(i);
    return result;
  }
  // Numbers are encoded as text or, in a live page, places of these arrays, or arrays.
  let arrays = [];
  const decoded = (decode) => (given) => (typeof given === 'number' ? arrays[given] : typeof given === 'string' ? decode(bytes(given).buffer) : given);
  const floats = decoded((buffer) => new Float32Array(buffer));
  const doubles = decoded((buffer) => new Float64Array(buffer));
  const parts = decoded((buffer) => Float32Array.from(new Int16Array(buffer), (part) => part / 32767));

  // Times are listed or, if evenly spaced, given by start, step and count.
  function times(json) {
    if (typeof json !== 'object') return doubles(json);
    return Float64Array.from({length: json.count}, (_, i) => json.start + i * json.step);
  }

  function extent(values) {
    let least = Infinity, greatest = -Infinity;
    for (const value of values) {
      if (!Number.isFinite(value)) continue;
      if (value < least) least = value;
      if (value > greatest) greatest = value;
    }
    return least <= greatest ? {least, greatest, size: Math.max(Math.abs(least), Math.abs(greatest))}
                             : {least: 0, greatest: 0, size: 0};
  }

  // The value of a sorted list below which this part of it lies.
  const quantile = (sorted, part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];

  class Run {
    constructor(json, index) {
      this.index = index;
      this.shown = true;
      this.load(json);
    }

    // `hand`: the state while someone tilts the plate by hand (hand.js).
    load(json) {
      delete this.legs;
      Object.assign(this, json);
      this.t = times(json.time);
      this.columns = new Map();
      for (const column of json.columns) {
        const values = floats(column.data);
        this.columns.set(column.name, {...column, values, ...extent(values)});
      }
      // A beam lacks the column of one axis: the ball stays on the other one.
      this.absent = new Map();
      for (const name of ['x', 'y']) {
        if (!this.columns.has(name)) this.absent.set(name, new Float32Array(this.t.length));
      }
      this.quaternions = parts(json.orientation);
      this.turns = this.quaternions.length > 0;  // false if the ball's rotation is unknown
      this.path = floats(json.reference);
      this.start = this.t[0];
      this.last = this.t[this.t.length - 1];
      if (this.reached === null) this.reached = this.last;  // the end, perhaps after the last row
      this.hasAngles = this.columns.has('phi') || this.columns.has('theta');
      this.hasReference = this.columns.has('x_reference') && this.columns.has('y_reference');
      this.isMeasured = this.columns.has('x_measured') && this.columns.has('y_measured');
    }

    values(name) {
      const column = this.columns.get(name);
      return column ? column.values : this.absent.get(name);
    }

    // The last row at or before t, or else the first row.
    row(t) {
      let low = 0, high = this.t.length - 1;
      while (low < high) {
        const middle = (low + high + 1) >> 1;
        if (this.t[middle] <= t) low = middle;
        else high = middle - 1;
      }
      return low;
    }

    // The row before t, and the part of the way to the next one; 0 at the ends.
    rowAndPart(t) {
      const row = this.row(t), within = t > this.t[row] && row + 1 < this.t.length;
      return [row, within ? (t - this.t[row]) / (this.t[row + 1] - this.t[row]) : 0];
    }

    // Interpolates linearly between two rows.
    between(t, values) {
      const [row, part] = this.rowAndPart(t);
      return part > 0 ? values[row] + part * (values[row + 1] - values[row]) : values[row];
    }

    // The value of a column. `otherwise` if the run lacks the column or the number.
    at(t, name, otherwise = NaN) {
      if (this.hand && name in this.hand) return this.hand[name];
      const values = this.values(name);
      const value = values ? this.between(t, values) : NaN;
      return Number.isFinite(value) ? value : otherwise;
    }

    // phi or theta; NaN if unknown. A beam without x has phi = 0, and one without y has theta = 0.
    angleAt(t, name) {
      return this.columns.has(name) ? this.at(t, name) : this.absent.has(name === 'phi' ? 'x' : 'y') ? 0 : NaN;
    }

    // The angles of three servos; null if they are not all known.
    servosAt(t) {
      const angles = ['servo_phi', 'servo_theta', 'servo_third'].map((name) => this.at(t, name));
      return angles.every(Number.isFinite) ? angles : null;
    }

    // The ball's place [x, y], or why there is none: 'missing' from the rows, or 'beyond' the range
    // that can be drawn.
    placeAt(t) {
      if (this.hand) return [this.hand.x, this.hand.y];
      const [row, part] = this.rowAndPart(t), rows = part > 0 ? [row, row + 1] : [row];
      if (rows.some((one) => ['x', 'y'].some((name) => Math.abs(this.values(name)[one]) > scene.stage.largest))) return 'beyond';
      const place = [this.at(t, 'x'), this.at(t, 'y')];
      return place.every(Number.isFinite) ? place : 'missing';
    }

    // Writes the ball's orientation in the plane's frame to a THREE.Quaternion.
    orientationAt(t, into) {
      if (this.hand) return into.copy(this.hand.turned);
      const [row, part] = this.rowAndPart(t);
      const at = (one) => {
        const [w, x, y, z] = this.quaternions.subarray(4 * one, 4 * one + 4);
        return new THREE.Quaternion(x, y, z, w).normalize();
      };
      into.copy(at(row));
      return part > 0 ? into.slerp(at(row + 1), part) : into;
    }
  }

  const scene = JSON.parse(document.getElementById('bbsim-data').textContent);
  const runs = scene.runs.map((run, index) => new Run(run, index));
  const listeners = [];
  return {
    scene, runs, floats, doubles, extent, quantile,
    before: null,  // in a live page: the run to compare with
    fan: null,     // in a live page: many rigs (fan.js)
    get start() { return Math.min(...runs.map((run) => run.start)); },
    get end() { return Math.max(...runs.map((run) => run.last)); },
    // Whether a coordinate can be drawn.
    shown: (value) => Math.abs(value) <= scene.stage.largest,
    // A run with the same content, which stays as it is.
    copyOf: (run) => Object.assign(Object.create(Run.prototype), run),
    // Replaces the scene by another one with as many runs.
    replace(next, numbers) {
      arrays = numbers;
      const {stage} = scene;
      Object.assign(scene, next);
      const sameStage = JSON.stringify(stage) === JSON.stringify(next.stage);
      scene.stage = Object.assign(stage, next.stage);
      next.runs.forEach((json, index) => runs[index].load(json));
      for (const listener of listeners) listener({sameStage});
    },
    // `listener({sameStage})` after each replacement; returns its unsubscription.
    onChange(listener) {
      listeners.push(listener);
      return () => listeners.splice(listeners.indexOf(listener), 1);
    },
  };
})();
