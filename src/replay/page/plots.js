'use strict';
// Plots over time beside the picture, with one cursor in all of them: the clock's time, or where a pointer is.
bbsim.makePlots = (container) => {
  const {clock, palette, text, data} = bbsim;
  const {element} = text;
  const plots = [];
  let hover = null, zooming = false, range = null;

  // Canvases of this size are painted faster where they are than on the way to a graphics card and back.
  Dygraph.getContext = (canvas) => canvas.getContext('2d', {willReadFrequently: true});

  function swatch(curve) {
    const line = text.svg('svg', {viewBox: '0 0 26 10', class: 'swatch', 'aria-hidden': 'true'});
    if (curve.dots) {
      for (const x of [4, 13, 22]) line.append(text.svg('circle', {cx: x, cy: 5, r: 2}));
    } else {
      line.append(text.svg('path', {d: 'M1 5H25', 'stroke-dasharray': curve.pattern ? curve.pattern.join(' ') : 'none'}));
    }
    return line;
  }

  // Rows of all curves of a plot on one grid of times; where they come from runs with other times, gaps.
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

  function valueOf(curve, t) {
    const {run} = curve;
    const slack = 1e-9 * Math.max(1, Math.abs(t));
    if (t < run.start - slack || t > run.last + slack) return NaN;
    return curve.values[run.nearest(t)];
  }

  class Plot {
    constructor({title, unit, curves}) {
      // What is drawn first is covered by what comes later: points, then commands, then the motion itself.
      const layer = (curve) => (curve.dots ? 0 : curve.pattern && curve.pattern[0] === 2 ? 1 : curve.pattern ? 3 : 2);
      this.order = [...curves].sort((a, b) => layer(a) - layer(b));
      this.curves = curves;
      this.size = Math.max(...curves.map((curve) => data.extent(curve.values).size));
      this.shown = text.shownIn(unit, this.size);
      this.readings = curves.map(() => element('output', {}));
      const legend = element('ul', {class: 'legend'}, ...curves.map((curve, i) => {
        const item = element('li', {title: text.visible(curve.meaning || '')}, swatch(curve),
                             element('span', {class: 'label'}, curve.label), this.readings[i]);
        item.style.setProperty('--colour', curve.colour());
        return item;
      }));
      this.legend = legend;
      this.canvas = element('div', {class: 'canvas'});
      this.cursor = element('div', {class: 'cursor', 'aria-hidden': 'true'});
      this.root = element('section', {class: 'plot', role: 'group', 'aria-label': text.visible(`${title} over time, in ${this.shown.unit || 'numbers'}`)},
                          element('header', {}, element('h3', {}, title, this.shown.unit ? element('small', {}, ` ${this.shown.unit}`) : null), legend),
                          element('div', {class: 'frame'}, this.canvas, this.cursor));
      this.graph = null;
    }

    build() {
      if (this.graph) return;
      const labels = ['t', ...this.order.map((_, i) => `c${i}`)];
      const series = {};
      this.order.forEach((curve, i) => {
        series[`c${i}`] = curve.dots ? {strokeWidth: 0, drawPoints: true, pointSize: 1.3, highlightCircleSize: 3}
                                     : {strokePattern: curve.pattern, strokeWidth: curve.pattern ? 1.5 : 1.8};
      });
      const mixed = new Set(this.curves.map((curve) => curve.run)).size > 1;
      this.graph = new Dygraph(this.canvas, tableOf(this.order, this.shown.factor), {
        labels, series, colors: this.order.map((curve) => curve.colour()), legend: 'never', connectSeparatedPoints: mixed,
        highlightCircleSize: 3.5, axisLabelFontSize: 11, drawGrid: true, animatedZooms: false, xRangePad: 2, yRangePad: 6,
        gridLineWidth: 0.6, axisLineWidth: 0.8, rightGap: 8,
        axes: {
          x: {axisLabelFormatter: (t) => text.number(t, 6), valueFormatter: (t) => text.number(t, 6), axisLabelWidth: 44, pixelsPerLabel: 70},
          y: {axisLabelFormatter: (value) => text.number(value, 5), axisLabelWidth: 46, pixelsPerLabel: 26},
        },
        ...this.colours(),
        dateWindow: range,
        highlightCallback: (event, t) => point(t),
        unhighlightCallback: () => point(null),
        clickCallback: (event, t) => {
          clock.pause();
          clock.seek(t);
        },
        drawCallback: (graph, initial) => {
          if (!initial) this.placeCursor();
          if (!initial && !zooming) share(graph);
        },
        underlayCallback: (ink, area, graph) => this.paintEvents(ink, area, graph),
      });
      this.placeCursor();
    }

    colours() {
      const colours = palette.isDark() ? {gridLineColor: '#2d3742', axisLineColor: '#5a6775'}
                                       : {gridLineColor: '#e0e5eb', axisLineColor: '#9aa5b1'};
      return colours;
    }

    recolour() {
      [...this.legend.children].forEach((item, i) => item.style.setProperty('--colour', this.curves[i].colour()));
      if (this.graph) this.graph.updateOptions({colors: this.order.map((curve) => curve.colour()), ...this.colours()});
    }

    // Events stand in every plot, stops solid and notes dashed.
    paintEvents(ink, area, graph) {
      const {events} = data.runs[0];
      ink.save();
      ink.strokeStyle = palette.isDark() ? '#e0c040' : '#8a6d00';
      ink.lineWidth = 1;
      for (const event of events.slice(0, 300)) {
        const x = graph.toDomXCoord(event.t);
        if (x < area.x || x > area.x + area.w) continue;
        ink.setLineDash(event.action === 'stop' ? [] : [3, 3]);
        ink.beginPath();
        ink.moveTo(x, area.y);
        ink.lineTo(x, area.y + area.h);
        ink.stroke();
      }
      ink.restore();
    }

    placeCursor() {
      if (!this.graph) return;
      const t = hover === null ? clock.now : hover;
      const x = this.graph.toDomXCoord(clock.now), area = this.graph.getArea();
      this.cursor.style.transform = `translateX(${x.toFixed(1)}px)`;
      this.cursor.style.height = `${area.h}px`;
      this.cursor.hidden = !(x >= area.x - 1 && x <= area.x + area.w + 1);
      this.read(t);
    }

    read(t) {
      const size = this.size * this.shown.factor;
      this.curves.forEach((curve, i) => {
        const value = valueOf(curve, t);
        this.readings[i].textContent = Number.isFinite(value) ? text.steady(value * this.shown.factor, size) : '–';
        this.readings[i].title = Number.isFinite(value) ? `${value} ${curve.unit === '1' ? '' : curve.unit}` : '';
      });
    }
  }

  // All plots show the same stretch of time.
  function share(graph) {
    const now = graph.isZoomed('x') ? graph.xAxisRange() : null;
    if (String(now) === String(range)) return;
    range = now;
    zooming = true;
    for (const plot of plots) {
      if (plot.graph && plot.graph !== graph) plot.graph.updateOptions({dateWindow: range});
    }
    zooming = false;
  }

  const readAt = element('p', {class: 'read-at', role: 'status'});
  function point(t) {
    hover = t;
    const steps = bbsim.transport.timeText;
    readAt.textContent = t === null ? '' : `at ${steps(t)} s`;
    for (const plot of plots) {
      plot.placeCursor();
      if (!plot.graph) continue;
      if (t === null) {
        if (plot.graph.getSelection() >= 0) plot.graph.clearSelection();
      } else if (plot.graph.getSelection() < 0 || plot.graph.lastx_ !== t) {
        const {rows} = plot;
        const row = plot.graph.getRowForX(t);
        if (row !== null) plot.graph.setSelection(row);
      }
    }
  }

  container.append(element('div', {class: 'plots-head'}, element('h2', {}, 'Over time'), readAt,
                           element('button', {type: 'button', class: 'link', id: 'unzoom', onclick: () => {
                             range = null;
                             for (const plot of plots) if (plot.graph) plot.graph.resetZoom();
                           }}, 'all of it')));
  for (const group of bbsim.groups()) {
    const plot = new Plot(group);
    plots.push(plot);
    container.append(plot.root);
  }
  // A plot is drawn when it comes near the window: many runs have more plots than anybody looks at.
  const near = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      near.unobserve(entry.target);
      plots.find((plot) => plot.root === entry.target).build();
    }
  }, {rootMargin: '300px'});
  for (const plot of plots) near.observe(plot.root);

  clock.onTime(() => { for (const plot of plots) plot.placeCursor(); });
  palette.onChange(() => plots.forEach((plot) => plot.recolour()));
  return {plots, point, get range() { return range; }};
};
