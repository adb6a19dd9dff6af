// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A hundred rigs within their tolerances: in the plots, a band that holds all of them, and some of
// them as pale curves. `requestOf(state)` is what the engine needs of a state of the page.
bbsim.makeFan = (cases, requestOf) => {
  const {data, palette} = bbsim;
  const count = 100, ghosts = 20;
  const status = bbsim.text.element('span', {class: 'live-status', role: 'status'});
  const series = cases.makeSeries(status, 'rigs');

  class Fan {
    constructor(keys) {
      Object.assign(this, {keys, status: [], columns: {}});
    }

    // Takes the columns of the next cases, each an array of all their rows.
    add(status, columns) {
      for (const [name, values] of Object.entries(columns)) {
        const all = this.columns[name] || (this.columns[name] = []), rows = values.length / status.length;
        for (let i = 0; i < status.length; ++i) all.push(values.subarray(i * rows, (i + 1) * rows));
      }
      this.status.push(...status);
      // Rows for a picture, at most 400: their times, and the least and the greatest values.
      const t = this.columns.t || [], step = t.length > 0 ? Math.ceil(t[0].length / 400) : 1;
      this.rows = t.length > 0 ? Array.from({length: Math.ceil(t[0].length / step)}, (_, k) => k * step) : [];
      this.t = this.rows.map((row) => (t.find((one) => Number.isFinite(one[row])) || [])[row]);
      this.bands = {};
    }

    bandOf(name) {
      if (!this.columns[name]) return null;
      return this.bands[name] || (this.bands[name] = this.rows.map((row) => data.extent(this.columns[name].map((values) => values[row]))));
    }

    // The least and the greatest value in a plot, in the unit of the columns.
    reach(curves) {
      const bands = curves.filter(({role}) => role === 'main').map(({name}) => this.bandOf(name)).filter(Boolean).flat();
      return bands.length > 0 ? [Math.min(...bands.map(({least}) => least)), Math.max(...bands.map(({greatest}) => greatest))] : null;
    }

    paint(ink, area, graph, curves, factor) {
      ink.save();
      ink.clip(new Path2D(`M${area.x} ${area.y}h${area.w}v${area.h}h${-area.w}z`));
      for (const curve of curves) {
        const band = curve.role === 'main' && this.bandOf(curve.name);
        if (!band) continue;
        const x = this.t.map((t) => graph.toDomXCoord(t)), y = (value) => graph.toDomYCoord(value * factor);
        ink.fillStyle = ink.strokeStyle = curve.colour();
        ink.globalAlpha = palette.isDark() ? 0.22 : 0.16;
        ink.beginPath();
        band.forEach(({greatest}, k) => ink.lineTo(x[k], y(greatest)));
        for (let k = band.length - 1; k >= 0; --k) ink.lineTo(x[k], y(band[k].least));
        ink.fill();
        ink.globalAlpha = 0.35;
        ink.lineWidth = 0.7;
        for (const values of this.columns[curve.name].slice(0, ghosts)) {
          ink.beginPath();
          this.rows.forEach((row, k) => { if (Number.isFinite(values[row])) ink.lineTo(x[k], y(values[row])); });
          ink.stroke();
        }
      }
      ink.restore();
    }
  }

  // Columns of the page's run that plots show as motion.
  function columnsOf() {
    const main = new Set(data.scene.plots.flatMap(({columns}) => columns.filter(({role}) => role === 'main').map(({name}) => name)));
    return ['t', ...[...data.runs[0].columns.keys()].filter((name) => main.has(name) && !name.startsWith('ball_q'))];
  }

  let on = false;
  async function draw(state) {
    let fan = null;
    try {
      const request = requestOf(state);
      series.end();
      const {answer, arrays} = await cases.ask({...request, rigs: count});
      fan = new Fan(Object.fromEntries(Object.entries(answer.keys).map(([key, place]) => [key, arrays[place]])));
      const all = await series.begin(request, {keys: fan.keys, columns: columnsOf()}, (first, words, columns) => {
        fan.add(words, columns);
      }, () => {
        data.fan = fan;
        bbsim.plots.repaint();
      });
      if (!all) return null;
      const ended = fan.status.filter((word) => word !== 'done').length;
      if (ended > 0) status.textContent += `, ${ended} ended early`;
      status.title = `Drawn: ${Object.keys(fan.keys).join(', ')}`;
    } catch (error) {
      status.textContent = error.message;
    }
    return fan;
  }
  return {
    status,
    // Fulfilled with the rigs, when all are drawn; null if a newer wish came.
    show(state) {
      on = true;
      return draw(state);
    },
    hide() {
      on = false;
      series.end();
      status.textContent = '';
      data.fan = null;
      bbsim.plots.repaint();
    },
    // The page shows another state.
    follow(state) { if (on) draw(state); },
  };
};
