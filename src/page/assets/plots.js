// Plots: curves over a pair of axes. uPlot draws the axes and selects what to zoom to; curves are drawn here, of each
// column of pixels the first, last, lowest and highest point, so that no extreme is lost however many points there are.
const plots = [];
const BENT = 64; // places at which a bend between points is looked at in a window
const APART = 12; // distance from which on points of a curve have dots of their own, px
const SMOOTH = 2; // distance of what is drawn of a bend between two points, px
const PIECE = 12; // length of the pieces of one colour where curves lie on each other, px
const isSorted = (x) => x.every((v, i) => i === 0 || !(v < x[i - 1]));
const lastAtMost = (x, value) => {
  let low = 0, high = x.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (x[middle] <= value) low = middle; else high = middle - 1;
  }
  return low;
};
// Whether a curve bends between two neighbours: of a coordinate the rate is known, of a rate what it is the rate of.
const bends = ({ rate, of }) => Boolean(rate || of);
// A curve between its points i and i + 1, at the part s of the way: a coordinate on the cubic through values and rates, a rate
// on its derivative, where that tells more than the rounding of the values, all else on the straight line.
const onPiece = ({ x, y, rate, of }, i, s) => {
  const h = x[i + 1] - x[i], r = 1 - s, line = y[i] + (y[i + 1] - y[i]) * s;
  if (rate) {
    const cubic = (1 + 2 * s) * r * r * y[i] + s * r * r * h * rate[i] + s * s * (3 - 2 * s) * y[i + 1] - s * s * r * h * rate[i + 1];
    return Number.isFinite(cubic) ? cubic : line;
  }
  if (!of) return line;
  const bend = 3 * ((of[i + 1] - of[i]) / h - (y[i] + y[i + 1]) / 2);
  const rounding = 3 * Number.EPSILON * (Math.abs(of[i]) + Math.abs(of[i + 1])) / h;
  return Math.abs(bend) > rounding && Number.isFinite(bend) ? line + 2 * s * r * bend : line;
};
// A curve at an abscissa; null where it is not.
const valueAt = (curve, at) => {
  const { x, y } = curve;
  if (!x.length || at < x[0] || at > x[x.length - 1]) return null;
  const i = lastAtMost(x, at), j = Math.min(i + 1, x.length - 1);
  if (y[i] == null || y[j] == null || x[j] <= x[i]) return y[i];
  return onPiece(curve, i, (at - x[i]) / (x[j] - x[i]));
};
// The values of a column of the run, where all of them are here and there are as many as of another.
const wholeColumns = new Map(data.plots.filter((spec) => spec.whole).flatMap((spec) => spec.curves.map((curve) => [curve.name, curve.y])));
const beside = (name, y) => wholeColumns.get(name)?.length === y.length ? wholeColumns.get(name) : null;
const VARIES = 1e-12; // what varies by less than this part of its size varies by rounding alone, as in src/record/plot/overview.rs
const widened = ([low, high], log, margin) => {
  if (!(low <= high)) return log ? [1, 10] : [0, 1];
  if (log) {
    const factor = high > low ? (high / low) ** margin : 3;
    return [low / factor, high * factor];
  }
  const varies = high - low > VARIES * Math.max(Math.abs(low), Math.abs(high));
  const room = varies ? (high - low) * margin : Math.abs(low) / 2 || 1;
  return [low - room, high + room];
};
const extent = (values) => values.reduce(([low, high], v) => v == null ? [low, high] : [Math.min(low, v), Math.max(high, v)],
  [Infinity, -Infinity]);

data.plots.forEach((spec, index) => {
  const place = byId(`plot-${index}`);
  if (!place || !spec.curves.length) return;
  const curves = spec.curves.map((curve, i) => ({
    ...curve, x: spec.xs[curve.x], colour: `--s${curve.style === "background" ? 7 : i % 8}`,
    rate: spec.whole ? beside(`${curve.name}.rate`, curve.y) : null,
    of: spec.whole && curve.name.endsWith(".rate") ? beside(curve.name.slice(0, -5), curve.y) : null,
  }));
  const sorted = curves.every((curve) => isSorted(curve.x));
  // Plots of one group zoom together, and are read at the same abscissa.
  const group = sorted && !spec.x.log ? `${spec.x.label} ${spec.x.unit}` : null;
  const all_x = extent(curves.flatMap((curve) => extent(curve.x)).filter(Number.isFinite));
  const outputs = curves.map((_, i) => place.querySelector(`[data-curve="${i}"] output`));
  const plot = { spec, place, curves, sorted, group, all_x, view: {} };
  // Points with notes are read one by one.
  const byPoint = !sorted || spec.marks || curves.some((curve) => curve.notes);
  place.classList.toggle("high", !spec.time && (byPoint || curves.some((curve) => curve.style === "points")));

  // What is shown, in units of the model.
  const fitted = (window) => {
    const y = curves.flatMap((curve) => {
      const { x, y } = curve;
      if (!sorted || !window) return extent(y);
      const inside = [valueAt(curve, window[0]), valueAt(curve, window[1])];
      for (let i = lastAtMost(x, window[0]); i < x.length && x[i] <= window[1]; i++) if (x[i] >= window[0]) inside.push(y[i]);
      // Where few points are in it, a bend between them counts.
      const count = bends(curve) && inside.length < BENT ? BENT : 0;
      for (let k = 1; k < count; k++) inside.push(valueAt(curve, window[0] + (window[1] - window[0]) * k / count));
      return extent(inside);
    });
    return widened(extent(y.filter((v) => v != null && Number.isFinite(v))), spec.y.log, 0.06);
  };
  const whole = () => ({
    x: widened(plot.all_x, spec.x.log, sorted && !spec.marks ? 0 : 0.06), y: fitted(null),
  });
  const shown = (axis) => plot.view[axis].map((v) => inUnit(v, spec[axis].unit));
  plot.apply = () => plot.u.batch(() => {
    for (const axis of ["x", "y"]) {
      const [min, max] = shown(axis);
      plot.u.setScale(axis, { min, max });
    }
  });
  plot.zoom = (x, y) => {
    plot.view = { x: x ?? plot.view.x, y: y ?? (x ? fitted(x) : plot.view.y) };
    plot.apply();
  };
  plot.reset = () => {
    plot.view = whole();
    plot.apply();
  };

  // From values to pixels of the canvas.
  const placed = (u, axis) => {
    const { left, top, width, height } = u.bbox, { min, max } = u.scales[axis];
    const { log, unit } = spec[axis], factor = shownUnit(unit).factor;
    const of = log ? (v) => Math.log10(v * factor) : (v) => v * factor;
    const [low, high] = log ? [Math.log10(min), Math.log10(max)] : [min, max];
    return axis === "x" ? (v) => left + (of(v) - low) / (high - low) * width
      : (v) => top + height - (of(v) - low) / (high - low) * height;
  };
  plot.pixel = (axis, v) => placed(plot.u, axis)(v);
  // From which point of a sorted curve to which: what is in the window and the next ones beside it.
  const inWindow = (x) => {
    let from = Math.max(0, lastAtMost(x, plot.view.x[0]) - 1);
    while (from > 0 && x[from] >= plot.view.x[0]) from--;
    return [from, Math.min(x.length - 1, lastAtMost(x, plot.view.x[1]) + 1)];
  };
  // The pieces of a curve in pixels.
  const pieces = (u, curve) => {
    const { x, y } = curve, px = placed(u, "x"), py = placed(u, "y"), out = [];
    const [from, to] = sorted ? inWindow(x) : [0, x.length - 1];
    let piece = null, column = null;
    const flush = () => {
      if (!column) return;
      const { first, low, high, last } = column;
      const seen = [first, ...[low, high].sort((a, b) => a[2] - b[2]), last];
      seen.forEach((p, k) => { if (k === 0 || p[2] !== seen[k - 1][2]) piece.push(p); });
      column = null;
    };
    for (let i = from; i <= to; i++) {
      if (y[i] == null || x[i] == null) { flush(); piece = null; continue; }
      if (!piece) out.push(piece = []);
      const p = [px(x[i]), py(y[i]), i];
      if (!sorted) { piece.push(p); continue; }
      const before = column?.last;
      if (before && bends(curve) && p[0] - before[0] > 2 * SMOOTH * devicePixelRatio) {
        flush();
        const h = x[i] - x[i - 1], part = (at) => clamp((at - x[i - 1]) / h, 0, 1);
        const [a, b] = [part(plot.view.x[0]), part(plot.view.x[1])];
        const count = Math.ceil((b - a) * (p[0] - before[0]) / (SMOOTH * devicePixelRatio));
        for (let k = 0; k <= count && count; k++) {
          const s = a + (b - a) * k / count;
          if (s > 0 && s < 1) piece.push([px(x[i - 1] + s * h), py(onPiece(curve, i - 1, s)), i - 1 + s]);
        }
      }
      if (!column || Math.floor(p[0]) !== column.at) {
        flush();
        column = { at: Math.floor(p[0]), first: p, low: p, high: p, last: p };
        continue;
      }
      column.last = p;
      if (p[1] < column.low[1]) column.low = p;
      if (p[1] > column.high[1]) column.high = p;
    }
    flush();
    return out;
  };
  // Where a curve shares its pixels with others, which pieces of it are drawn: colours alternate there.
  const drawnPieces = (lines, { left, width }, size) => {
    const count = Math.ceil(width / size);
    const heights = lines.map((line, i) => {
      const at = new Float64Array(Math.ceil(width) + 1).fill(NaN);
      if (curves[i].style === "points") return at;
      for (const piece of line) for (let k = 1; k < piece.length; k++) {
        const [a, b] = [piece[k - 1], piece[k]];
        const end = Math.min(at.length - 1, b[0] - left);
        for (let i = Math.max(0, Math.ceil(a[0] - left)); i <= end; i++)
          at[i] = b[0] > a[0] ? a[1] + (b[1] - a[1]) * (left + i - a[0]) / (b[0] - a[0]) : a[1];
      }
      return at;
    });
    const same = (a, b, piece) => {
      for (let i = Math.floor(piece * size); i < Math.min((piece + 1) * size, heights[a].length); i++)
        if (!(Math.abs(heights[a][i] - heights[b][i]) < devicePixelRatio)) return false;
      return true;
    };
    // Those that lie on a curve, on one of those, and so on.
    const connected = (of, piece) => {
      const group = new Set([of]);
      for (const a of group) for (let b = 0; b < lines.length; b++) if (!group.has(b) && same(a, b, piece)) group.add(b);
      return [...group].sort((a, b) => a - b);
    };
    return lines.map((_, a) => Array.from({ length: count }, (_, piece) => {
      const group = connected(a, piece);
      return group[piece % group.length] === a;
    }));
  };
  const draw = (u) => {
    const c = u.ctx, { left, top, width, height } = u.bbox, ratio = devicePixelRatio;
    const lines = curves.map((curve) => pieces(u, curve));
    const size = PIECE * ratio;
    const drawn = sorted && curves.length > 1 ? drawnPieces(lines, u.bbox, size) : null;
    c.save();
    c.beginPath();
    c.rect(left, top, width, height);
    c.clip();
    lines.forEach((line, i) => {
      c.save();
      if (drawn && drawn[i].includes(false)) {
        c.beginPath();
        drawn[i].forEach((is, k) => is && c.rect(left + k * size, top, size, height));
        c.clip();
      }
      c.strokeStyle = c.fillStyle = style(curves[i].colour);
      const isPoints = curves[i].style === "points", marked = spec.marks || isPoints;
      c.lineWidth = (curves[i].style === "background" ? 0.7 : 1.4) * ratio;
      c.lineJoin = "round";
      c.beginPath();
      if (!isPoints) for (const piece of line) piece.forEach(([x, y], k) => k ? c.lineTo(x, y) : c.moveTo(x, y));
      c.stroke();
      const alone = sorted ? line.filter((piece) => piece.length === 1) : [];
      for (const piece of marked ? line : alone) for (const [x, y] of piece) {
        c.beginPath();
        c.arc(x, y, (marked ? 3 : 2) * ratio, 0, 2 * Math.PI);
        c.fill();
      }
      if (spec.time) dots(u, c, curves[i], ratio);
      if (spec.path) way(c, line, ratio);
      c.restore();
    });
    c.restore();
  };
  // The points of a curve, where they lie apart.
  const dots = (u, c, { x, y }, ratio) => {
    const [from, to] = inWindow(x), px = placed(u, "x"), py = placed(u, "y");
    if (u.bbox.width < APART * ratio * (to - from)) return;
    for (let i = from; i <= to; i++) {
      if (y[i] == null) continue;
      c.beginPath();
      c.arc(px(x[i]), py(y[i]), 2 * ratio, 0, 2 * Math.PI);
      c.fill();
    }
  };
  // Direction of a path, and a ring where it starts.
  const way = (c, line, ratio) => {
    const steps = line.flatMap((piece) => piece.slice(1).map((b, k) => [piece[k], b]))
      .map(([a, b]) => [a, b, Math.hypot(b[0] - a[0], b[1] - a[1])]).filter(([, , length]) => length > 0);
    const total = steps.reduce((sum, [, , length]) => sum + length, 0);
    const count = clamp(Math.floor(total / (150 * ratio)), 2, 12);
    let [gone, next] = [0, total / count / 2];
    for (const [a, b, length] of steps) {
      gone += length;
      if (gone < next) continue;
      next += total / count;
      const [ux, uy] = [(b[0] - a[0]) / length, (b[1] - a[1]) / length], l = 9 * ratio, w = 3.6 * ratio;
      c.beginPath();
      c.moveTo(b[0], b[1]);
      c.lineTo(b[0] - ux * l - uy * w, b[1] - uy * l + ux * w);
      c.lineTo(b[0] - ux * l + uy * w, b[1] - uy * l - ux * w);
      c.fill();
    }
    const start = line[0]?.[0];
    if (!start) return;
    c.beginPath();
    c.arc(start[0], start[1], 4 * ratio, 0, 2 * Math.PI);
    c.fillStyle = style("--paper");
    c.fill();
    c.stroke();
  };

  // ---- reading out ------------------------------------------------------------------------
  plot.valueAt = (i, at) => valueAt(curves[i], at);
  plot.read = (at) => curves.forEach((curve, i) => {
    outputs[i].textContent = at == null || curve.style === "points" ? "" : digits(inUnit(valueAt(curve, at), spec.y.unit));
  });
  const note = place.querySelector(".note");
  const nearest = (left, top) => {
    const ratio = devicePixelRatio, [px, py] = [placed(plot.u, "x"), placed(plot.u, "y")];
    const [x, y] = [left * ratio + plot.u.bbox.left, top * ratio + plot.u.bbox.top];
    let best = null;
    curves.forEach((curve, i) => curve.x.forEach((at, k) => {
      if (curve.y[k] == null) return;
      const distance = Math.hypot(px(at) - x, py(curve.y[k]) - y);
      if (!best || distance < best.distance) best = { i, k, distance };
    }));
    return best && best.distance < 40 * ratio ? best : null;
  };
  const at = element("div", { className: "at", hidden: true });
  const readNearest = (found) => {
    outputs.forEach((output) => { output.textContent = ""; });
    at.hidden = !found;
    if (!found) return;
    const { x, y } = curves[found.i], [a, b] = [x[found.k], y[found.k]];
    outputs[found.i].textContent = `${digits(inUnit(b, spec.y.unit))} at ${digits(inUnit(a, spec.x.unit))}`;
    at.style.left = `${(plot.pixel("x", a) - plot.u.bbox.left) / devicePixelRatio}px`;
    at.style.top = `${(plot.pixel("y", b) - plot.u.bbox.top) / devicePixelRatio}px`;
  };
  const grouped = () => plots.filter((other) => other === plot || group && other.group === group);
  const hover = (u) => {
    const { left, top } = u.cursor;
    if (spec.time) plots.named?.(plot, left, top);
    if (left < 0 || top < 0) {
      if (byPoint) readNearest(null);
      if (group) grouped().forEach((other) => other.read(plots.now && other.spec.time ? plots.now() : null));
      return;
    }
    if (byPoint) return readNearest(nearest(left, top));
    const value = u.posToVal(left, "x") / shownUnit(spec.x.unit).factor;
    for (const other of grouped()) {
      other.read(value);
      if (other !== plot) other.u.setCursor({ left: other.u.valToPos(inUnit(value, spec.x.unit), "x"), top: -10 }, false);
    }
  };

  // ---- the plot -----------------------------------------------------------------------------
  const axes = place.querySelector(".axes");
  const size = () => ({ width: Math.max(axes.clientWidth, 120), height: axes.clientHeight });
  // Round values: the finest multiples of 1, 2 or 5 times a power of ten that leave enough space; uPlot's own end at 1e-16.
  const step = (min, max, dim, space) => {
    const least = (max - min) * space / dim, power = 10 ** Math.floor(Math.log10(least));
    return [1, 2, 5, 10].map((digit) => digit * power).find((found) => found >= least) ?? 10 * power;
  };
  const lineMultiples = (min, max, by) => {
    // Counted from the first: of a number beyond 2^53 the next whole one is the same.
    const from = Math.ceil(min / by), count = Math.floor(max / by) - from + 1;
    return Array.from({ length: clamp(count, 0, 1000) || 0 }, (_, i) => (from + i) * by);
  };
  const logMultiples = (min, max, count) => {
    const [low, high] = [Math.log10(min), Math.log10(max)], by = Math.max(1, Math.ceil((high - low) / count));
    const powers = lineMultiples(Math.floor(low), high, by), digits = high - low < 1 ? [1, 2, 3, 4, 5, 6, 7, 8, 9] : high - low < 2 ? [1, 2, 5] : [1];
    return powers.flatMap((e) => digits.map((d) => d * 10 ** e)).filter((v) => v >= min && v <= max);
  };
  const axis = (side) => ({
    incrs: () => [Number.MAX_VALUE], // what uPlot accepts whatever the range is; splits below are what is drawn
    splits: (u, _, min, max, found, space) => {
      const dim = (side ? u.bbox.height : u.bbox.width) / devicePixelRatio;
      return spec[side ? "y" : "x"].log ? logMultiples(min, max, dim / (side ? 26 : 60))
        : lineMultiples(min, max, step(min, max, dim, side ? 26 : 60));
    },
    filter: (_, splits) => splits,
    stroke: () => style("--ink"), grid: { stroke: () => style("--rule"), width: 1 }, font: "12px system-ui, sans-serif",
    ticks: { stroke: () => style("--rule"), width: 1, size: 4 }, size: side ? 62 : 26, gap: 4, space: side ? 26 : 60, 
    values: (_, splits) => splits.map((v) => v == null ? "" : digits(v)),
  });
  const scale = (name) => ({ time: false, distr: spec[name].log ? 3 : 1, range: () => shown(name) });
  const selected = (u) => {
    const { left, top, width, height } = u.select;
    u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
    if (width < 4 && height < 4) return;
    const value = (position, name) => u.posToVal(position, name) / shownUnit(spec[name].unit).factor;
    const x = width < 4 ? null : [value(left, "x"), value(left + width, "x")];
    const y = sorted && !spec.marks || height < 4 || height >= u.over.clientHeight ? null : [value(top + height, "y"), value(top, "y")];
    zoomGroup(plot, x, y);
  };
  plot.view = whole();
  plot.u = new uPlot({
    ...size(), padding: [8, 24, 0, 0], legend: { show: false },
    cursor: {
      points: { show: false }, y: byPoint, drag: { x: true, y: !sorted || spec.marks, setScale: false, uni: 30 },
      bind: { dblclick: () => () => { grouped().forEach((other) => other.reset()); plots.moved?.(); } },
    },
    scales: { x: scale("x"), y: scale("y") }, axes: [axis(0), axis(1)],
    series: [{}, { show: true, paths: () => null, points: { show: false } }],
    hooks: { setSelect: [selected], setCursor: [hover], drawClear: [(u) => plots.under?.(u, plot)], draw: [draw] },
  }, [shown("x"), shown("y")], axes);
  plot.u.over.append(at);
  let pressed = null;
  plot.u.over.addEventListener("mousedown", (e) => { pressed = [e.clientX, e.clientY]; });
  plot.u.over.addEventListener("click", (e) => {
    if (!pressed || Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) > 3) return;
    const { left, top } = plot.u.cursor;
    if (byPoint) {
      const found = nearest(left, top);
      note.textContent = found ? curves[found.i].notes?.[found.k] ?? "" : "";
    } else if (spec.time) plots.go?.(plot.u.posToVal(left, "x") / shownUnit(spec.x.unit).factor);
  });
  plot.fit = () => plot.u.setSize(size());
  new ResizeObserver(() => { plot.fit(); plots.moved?.(); }).observe(axes);
  plots.push(plot);
});
const zoomGroup = (plot, x, y) => {
  plot.zoom(x, y);
  if (x && plot.group) for (const other of plots) if (other !== plot && other.group === plot.group) other.zoom(x, null);
  plots.moved?.();
};
// The whole of a group is that of all its plots.
for (const group of new Set(plots.map((plot) => plot.group))) {
  const members = plots.filter((plot) => plot.group === group);
  if (group === null) continue;
  const whole = extent(members.flatMap((plot) => plot.all_x));
  for (const plot of members) plot.all_x = whole;
  members.forEach((plot) => plot.reset());
}
const redraw = () => plots.forEach((plot) => plot.u.redraw(false, true));
listeners.theme.push(redraw);
listeners.units.push(() => plots.forEach((plot) => plot.apply()));
showUnits();
// On paper a page is as wide as A4 less the margins of browsers; what is drawn on the screen's width would be cut there.
const PAPER = "700px";
for (const [event, width] of [["beforeprint", PAPER], ["afterprint", ""]]) addEventListener(event, () => {
  document.body.style.width = width;
  plots.forEach((plot) => plot.fit());
  plots.moved?.();
});
window.dalembert = { plots, data, zoomGroup, setTheme };
