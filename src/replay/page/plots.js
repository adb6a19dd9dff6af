// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

'use strict';
// A piece of a curve, for its name in a legend.
bbsim.swatch = ({dots, pattern, width}) => {
  const {svg} = bbsim.text;
  const shape = dots === 'cross' ? [svg('path', {d: 'M1.5 5h5m-2.5 -2.5v5M10.5 5h5m-2.5 -2.5v5M19.5 5h5m-2.5 -2.5v5', style: 'stroke-width: 1.4'})]
      : dots ? [4, 13, 22].map((x) => svg('circle', {cx: x, cy: 5, r: 2}))
      : [svg('path', {d: 'M1 5H25', 'stroke-dasharray': pattern ? pattern.join(' ') : 'none',
                      style: `stroke-width: ${Math.min(2.4, width || 1.8) + (width > 3 ? 3 : 0.4)}`})];
  return svg('svg', {viewBox: '0 0 26 10', class: 'swatch', 'aria-hidden': 'true'}, ...shape);
};

// Plots over time beside the picture, with one cursor in all of them, at the clock's time or at the
// pointer. `behind` paints below the curves; `pointed` receives the time at the pointer.
bbsim.makePlots = (container, {behind = null, pointed = null} = {}) => {
  const {clock, palette, text, data} = bbsim;
  const {element} = text;
  const plots = [], hidden = new Map();  // labels of curves that are not shown, by the plots' titles
  // Slightly more than the run, to have a number at its end.
  const wholeRange = () => (data.end > data.start ? [data.start, data.end + 1e-6 * (data.end - data.start)] : [data.start - 0.5, data.end + 0.5]);
  let whole = wholeRange();
  const timeLabel = data.runs.every((run) => run.unitsKnown) ? 't (s)' : 't';
  let hover = null, zooming = false, printing = false, range = bbsim.address.zoom();

  // Canvases of this size are faster to paint in memory than through a graphics card.
  Dygraph.getContext = (canvas) => canvas.getContext('2d', {willReadFrequently: true});

  // Draws points as dots or crosses, far enough apart to show each one and the curve below. With
  // `every`, omits only points on top of the one before.
  function drawPoint(cross, every) {
    let last = -Infinity, lastY = -Infinity;
    const hides = every ? (x, y) => Math.abs(x - last) < 1 && Math.abs(y - lastY) < 1 : (x) => x >= last && x < last + 7;
    return (graph, name, ink, x, y, colour, size) => {
      if (hides(x, y)) return;
      [last, lastY] = [x, y];
      if (cross) {
        ink.strokeStyle = colour;
        ink.lineWidth = 1.2;
        ink.stroke(new Path2D(`M${x - size} ${y}h${2 * size}M${x} ${y - size}v${2 * size}`));
      } else {
        ink.fillStyle = colour;
        ink.beginPath();
        ink.arc(x, y, size, 0, 2 * Math.PI);
        ink.fill();
      }
    };
  }

  // The rows of a plot's curves on one grid of times. There are gaps if the runs have different
  // times.
  function tableOf(curves, factor) {
    const runs = [...new Set(curves.map((curve) => curve.run))];
    const put = (value) => (Number.isFinite(value) ? value * factor : NaN);
    if (runs.length === 1) {
      const {t} = runs[0];
      const rows = new Array(t.length);
      for (let i = 0; i < t.length; ++i) {
        const row = [t[i]];
        for (const curve of curves) row.push(put(curve.values[i]));
        rows[i] = row;
      }
      return rows;
    }
    const rows = new Map();
    curves.forEach((curve, c) => {
      const {t} = curve.run;
      for (let i = 0; i < t.length; ++i) {
        let row = rows.get(t[i]);
        if (!row) rows.set(t[i], row = [t[i], ...curves.map(() => null)]);
        row[c + 1] = put(curve.values[i]);
      }
    });
    return [...rows.values()].sort((a, b) => a[0] - b[0]);
  }

  // Samples and commands of sampled loops hold from row to row; everything else is read off between rows.
  const holds = (curve) => Boolean(curve.dots) || (curve.role === 'command' && curve.run.isMeasured);
  function valueOf(curve, t) {
    const {run} = curve;
    const slack = 1e-9 * Math.max(1, Math.abs(t));
    if (t < run.start - slack || t > run.last + slack) return NaN;
    return holds(curve) ? curve.values[run.row(t + slack)] : run.between(t, curve.values);
  }

  // The range of a plot in which a few values are a thousand times farther out than all others, as
  // where a ball takes off: that of the others. Null if there are none.
  function innerRange(curves) {
    const sorted = (values) => values.filter(Number.isFinite).sort((a, b) => a - b);
    // A few hundred values tell nearly always that there are none.
    const some = sorted(curves.flatMap(({values}) => Array.from({length: Math.min(values.length, 100)}, (_, i) => values[Math.floor(i * values.length / 100)])));
    const extents = curves.map((curve) => data.extent(curve.values));
    const reach = Math.max(...extents.map(({greatest}) => greatest)) - Math.min(...extents.map(({least}) => least));
    if (some.length > 20 && reach < 500 * (data.quantile(some, 0.9) - data.quantile(some, 0.1))) return null;
    const values = sorted(curves.flatMap((curve) => Array.from(curve.values)));
    const few = Math.ceil(0.01 * values.length), low = values[few], high = values[values.length - 1 - few], span = high - low;
    if (values.length < 20 || !(span > 0) || reach < 1000 * span) return null;
    return {low: low - 0.5 * span, high: high + 0.5 * span};
  }

  // What a plot shows of a group of curves.
  function contentOf(group) {
    const {unit, curves} = group, inner = innerRange(curves);
    // If a few values are far beyond the others, these determine the unit.
    const size = inner ? Math.max(Math.abs(inner.low), Math.abs(inner.high)) : Math.max(...curves.map((curve) => data.extent(curve.values).size));
    // Later curves cover earlier ones: references, then points and commands, then the motion.
    const order = [...curves].sort((a, b) => a.layer - b.layer);
    return {group, curves, order, size, inner, shown: text.shownIn(unit, size)};
  }

  class Plot {
    constructor(group) {
      const {title, curves} = group;
      Object.assign(this, contentOf(group));
      if (!hidden.has(title)) hidden.set(title, new Set());
      this.hidden = hidden.get(title);
      this.readings = curves.map(() => element('output', {}));
      const legend = element('ul', {class: 'legend'}, ...curves.map((curve, i) => {
        const name = text.toggle(curve.label, {class: 'label', title: 'Hide or show this curve'}, (on) => {
          this.hidden[on ? 'delete' : 'add'](curve.label);
          if (this.graph) this.graph.updateOptions({visibility: this.visibility(), valueRange: this.valueRange()});
        }, !this.hidden.has(curve.label));
        name.prepend(bbsim.swatch(curve));
        const item = element('li', {title: text.visible(curve.meaning || '')}, name, this.readings[i]);
        item.style.setProperty('--colour', curve.colour());
        return item;
      }));
      this.legend = legend;
      this.canvas = element('div', {class: 'canvas'});
      this.cursor = element('div', {class: 'cursor', 'aria-hidden': 'true'});
      this.root = element('section', {class: 'plot', role: 'group', 'aria-label': text.visible(`${title} over time, in ${this.shown.unit || 'numbers'}`)},
                          element('header', {}, element('h3', {}, title, this.shown.unit ? element('small', {}, ` ${this.shown.unit}`) : null,
                                                      this.inner ? element('small', {}, ' (a few values are far beyond)') : null), legend),
                          element('div', {class: 'frame'}, this.canvas, this.cursor));
      this.graph = null;
    }

    build() {
      if (this.graph) return;
      const labels = ['t', ...this.order.map((_, i) => `c${i}`)];
      const series = {};
      this.order.forEach((curve, i) => {
        const cross = curve.dots === 'cross';
        const points = {strokeWidth: 0, drawPoints: true, pointSize: cross ? 2.6 : 1.6, highlightCircleSize: 3, drawPointCallback: drawPoint(cross, curve.every)};
        series[`c${i}`] = curve.dots ? points : {strokePattern: curve.pattern, strokeWidth: curve.width || 1.8, stepPlot: holds(curve)};
      });
      const mixed = new Set(this.curves.map((curve) => curve.run)).size > 1;
      this.graph = new Dygraph(this.canvas, tableOf(this.order, this.shown.factor), {
        labels, series, colors: this.order.map((curve) => curve.colour()), legend: 'never', connectSeparatedPoints: mixed,
        highlightCircleSize: 3.5, axisLabelFontSize: 11, drawGrid: true, animatedZooms: false, yRangePad: 6,
        gridLineWidth: 0.6, axisLineWidth: 0.8, rightGap: 8, xlabel: timeLabel, xLabelHeight: 13,
        axes: {
          x: {axisLabelFormatter: (t) => text.number(t, 6), valueFormatter: (t) => text.number(t, 6), axisLabelWidth: 44, pixelsPerLabel: 50},
          y: {axisLabelFormatter: (value) => text.number(value, 5), axisLabelWidth: 46, ticker: (low, high, pixels) => text.ticks(low, high, pixels / 26).map((v) => ({v, label: text.number(v, 5)}))},
        },
        ...this.colours(),
        visibility: this.visibility(),
        dateWindow: range || whole,
        valueRange: this.valueRange(),
        highlightCallback: (event, t) => point(t),
        unhighlightCallback: () => point(null),
        clickCallback: (event, t) => {
          clock.pause();
          clock.seek(t);
        },
        drawCallback: (graph, initial) => {
          if (!initial) this.placeCursor();
          if (!initial && !zooming && !printing) share(graph);
        },
        underlayCallback: (ink, area, graph) => {
          if (data.fan) data.fan.paint(ink, area, graph, this.visible, this.shown.factor);
          return behind ? behind(ink, area, graph, this.group) : this.paintEvents(ink, area, graph);
        },
      });
      this.placeCursor();
    }

    visibility() {
      return this.order.map(({label}) => !this.hidden.has(label));
    }
    get visible() {
      return this.curves.filter(({label}) => !this.hidden.has(label));
    }

    valueRange() {
      const reach = data.fan && !this.inner && data.fan.reach(this.visible);
      if (reach) {
        const extents = this.visible.map((curve) => data.extent(curve.values));
        const low = Math.min(reach[0], ...extents.map(({least}) => least)), high = Math.max(reach[1], ...extents.map(({greatest}) => greatest));
        const room = 0.04 * (high - low || 1);
        return [(low - room) * this.shown.factor, (high + room) * this.shown.factor];
      }
      return this.inner ? [this.inner.low * this.shown.factor, this.inner.high * this.shown.factor] : null;
    }

    // Takes the curves of another run, if it has the same ones in the same unit.
    takes(group) {
      const next = contentOf(group), names = ({title, curves}) => [title, ...curves.map((curve) => curve.label)].join();
      if (names(group) !== names(this.group) || next.shown.unit !== this.shown.unit || Boolean(next.inner) !== Boolean(this.inner)) return false;
      Object.assign(this, next);
      this.stale = this.graph !== null;
      if (this.near) this.freshen();
      return true;
    }

    freshen() {
      if (!this.stale) return;
      this.stale = false;
      zooming = true;
      this.graph.updateOptions({file: tableOf(this.order, this.shown.factor), dateWindow: range || whole, valueRange: this.valueRange()});
      zooming = false;
      this.placeCursor();
    }

    colours() {
      return palette.isDark() ? {gridLineColor: '#2d3742', axisLineColor: '#5a6775'} : {gridLineColor: '#e0e5eb', axisLineColor: '#9aa5b1'};
    }

    recolour() {
      [...this.legend.children].forEach((item, i) => item.style.setProperty('--colour', this.curves[i].colour()));
      if (this.graph) this.graph.updateOptions({colors: this.order.map((curve) => curve.colour()), ...this.colours()});
    }

    // Every plot shows the events: stops are solid and notes are dashed.
    paintEvents(ink, area, graph) {
      const {events} = data.runs[0];
      ink.save();
      ink.strokeStyle = palette.isDark() ? '#e0c040' : '#8a6d00';
      ink.lineWidth = 1;
      for (const event of events.slice(0, 300)) {
        const x = graph.toDomXCoord(event.t);
        if (x < area.x || x > area.x + area.w) continue;
        ink.setLineDash(event.action === 'stop' ? [] : [3, 3]);
        ink.stroke(new Path2D(`M${x} ${area.y}v${area.h}`));
      }
      ink.restore();
    }

    placeCursor(reading = true) {
      if (!this.graph) return;
      const t = hover === null ? clock.now : hover;
      const x = this.graph.toDomXCoord(clock.now), area = this.graph.getArea();
      this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
      this.cursor.style.height = `${area.h}px`;
      this.cursor.hidden = !(x >= area.x - 1 && x <= area.x + area.w + 1);
      if (reading) this.read(t);
    }

    read(t) {
      const size = this.size * this.shown.factor;
      this.curves.forEach((curve, i) => {
        const value = valueOf(curve, t), out = this.readings[i];
        // Writing the same text again would trigger a layout of the page.
        const words = Number.isNaN(value) ? '–' : text.steady(value * this.shown.factor, size);
        if (out.textContent === words) return;
        out.textContent = words;
        out.title = Number.isNaN(value) ? '' : `${value} ${curve.unit === '1' ? '' : curve.unit}`;
      });
    }
  }

  // All plots show the same range of time.
  function setRange(next, from = null) {
    range = next;
    zooming = true;
    for (const plot of plots) {
      if (plot.graph && (plot.graph !== from || range === null)) plot.graph.updateOptions({dateWindow: range || whole});
    }
    zooming = false;
    if (bbsim.addressLater) bbsim.addressLater();
  }
  function share(graph) {
    const [low, high] = graph.xAxisRange(), slack = 1e-5 * (whole[1] - whole[0]);
    const all = !graph.isZoomed('x') || (low <= whole[0] + slack && high >= whole[1] - slack);
    const now = all ? null : [low, high];
    if (String(now) !== String(range)) setRange(now, graph);
    else if (all && (low > whole[0] + slack || high < whole[1] - slack)) setRange(null);
  }
  // The zoomed range follows the time: when the time leaves it, the range moves on.
  function follow(t) {
    if (range === null || hover !== null || (t >= range[0] && t <= range[1])) return;
    const long = range[1] - range[0], from = Math.min(Math.max(t - 0.05 * long, whole[0]), whole[1] - long);
    if (from !== range[0]) setRange([from, from + long]);
  }

  const readAt = element('p', {class: 'read-at', role: 'status'});
  function point(t) {
    hover = t;
    const steps = bbsim.transport.timeText;
    readAt.textContent = t === null ? '' : `at ${steps(t)} s`;
    if (pointed) pointed(t);
    for (const plot of plots) {
      plot.placeCursor();
      if (!plot.graph) continue;
      const row = t === null ? null : plot.graph.getRowForX(t);
      if (row !== null) plot.graph.setSelection(row);
      else if (plot.graph.getSelection() >= 0) plot.graph.clearSelection();
    }
  }

  container.append(element('div', {class: 'plots-head'}, element('h2', {}, 'Over time'), readAt,
                           element('button', {class: 'link', id: 'unzoom', onclick: () => {
                             for (const plot of plots) if (plot.graph && plot.graph.isZoomed('y')) plot.graph.resetZoom();
                             setRange(null);
                           }}, 'all of it')));
  // Builds a plot when it comes near the window, because many runs have more plots than anyone
  // reads.
  const near = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      const plot = plots.find((one) => one.root === entry.target);
      plot.near = entry.isIntersecting;
      if (plot.near && plot.graph) plot.placeCursor();
      if (plot.near) plot.build();
      if (plot.near) plot.freshen();
    }
  }, {rootMargin: '300px'});

  function fill() {
    for (const group of bbsim.groups()) {
      const plot = new Plot(group);
      plots.push(plot);
      container.append(plot.root);
      near.observe(plot.root);
    }
  }
  function empty() {
    near.disconnect();
    for (const plot of plots.splice(0)) {
      if (plot.graph) plot.graph.destroy();
      plot.root.remove();
    }
  }
  fill();
  // Keeps the plots that show the same columns as before.
  const unsubscribe = data.onChange(() => {
    whole = wholeRange();
    const groups = bbsim.groups();
    if (groups.length === plots.length && groups.every((group, i) => plots[i].takes(group))) return;
    empty();
    fill();
  });

  // Cursors follow the time. While it runs, numbers change a few times a second, as fast as one can
  // read.
  let readAgain = 0;
  clock.onTimeRelaxed((t) => {
    follow(t);
    const now = performance.now(), reading = !clock.playing || now >= readAgain;
    if (reading) readAgain = now + 125;
    for (const plot of plots) if (plot.near) plot.placeCursor(reading);
  });
  palette.onChange(() => plots.forEach((plot) => plot.recolour()));
  return {
    plots, point,
    get range() { return range; },
    zoom: (to) => setRange(to),
    // What lies behind the curves has changed.
    repaint() {
      for (const plot of plots) {
        plot.stale = plot.graph !== null;
        if (plot.near) plot.freshen();
      }
    },
    // Removes all plots.
    end() {
      unsubscribe();
      empty();
      container.replaceChildren();
    },
    // Prints all plots whole at this size; null restores them.
    print(size) {
      printing = true;
      for (const plot of plots) {
        plot.build();
        plot.graph.updateOptions({pixelRatio: size ? 2 : undefined}, true);
        if (!size) plot.canvas.removeAttribute('style');  // which Dygraph has set for the printed size
        if (size) plot.graph.resize(size.width, size.height);
        else plot.graph.resize();
        plot.read(clock.now);
      }
      printing = false;
    },
  };
};
