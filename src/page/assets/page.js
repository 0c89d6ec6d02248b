"use strict";
// The page of a run: linked plots, and the mechanism drawn at the same time. Everything comes from the data beside it.
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const byId = (id) => document.getElementById(id);
  const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
  const digits = (x) => {
    if (x == null) return "–";
    const rounded = Number(x.toPrecision(6)), size = Math.abs(rounded);
    return size >= 1e5 || (size !== 0 && size < 1e-3) ? rounded.toExponential() : String(rounded);
  };
  const [first, last] = data.span;
  let now = first;

  // ---- modes and events ----------------------------------------------------------------------
  const tint = (mode, alpha) => `hsla(${(mode * 137.5 + 205) % 360}, 55%, 55%, ${alpha})`;
  const legend = byId("modes");
  data.modes.forEach((name, i) => {
    if (!data.visits.some(([, , mode]) => mode === i)) return;
    const swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = tint(i, 0.45);
    legend.append(swatch, name);
  });

  // ---- plots ---------------------------------------------------------------------------------
  const plots = [];
  let linking = false;
  const link = (from, key) => {
    if (key !== "x" || linking) return;
    linking = true;
    const { min, max } = from.scales.x;
    for (const plot of plots) if (plot !== from) plot.setScale("x", { min, max });
    linking = false;
  };
  const underlay = (u) => {
    const { left, top, width, height } = u.bbox;
    const x = (t) => u.valToPos(t, "x", true);
    u.ctx.save();
    u.ctx.beginPath();
    u.ctx.rect(left, top, width, height);
    u.ctx.clip();
    for (const [from, to, mode] of data.visits) {
      const [a, b] = [x(from), x(to)];
      if (b < left || a > left + width) continue;
      u.ctx.fillStyle = tint(mode, 0.13);
      u.ctx.fillRect(a, top, Math.max(b - a, 1), height);
    }
    u.ctx.fillStyle = style("--faint");
    for (const [t] of data.events) u.ctx.fillRect(x(t), top, 1, 5 * devicePixelRatio);
    u.ctx.restore();
  };
  const overlay = (u) => {
    const at = u.valToPos(now, "x", true);
    const { left, top, width, height } = u.bbox;
    if (at < left || at > left + width) return;
    u.ctx.fillStyle = style("--alarm");
    u.ctx.fillRect(at, top, Math.max(1, devicePixelRatio), height);
  };
  const axis = (label) => ({
    label, stroke: () => style("--ink"), grid: { stroke: () => style("--rule"), width: 1 },
    ticks: { stroke: () => style("--rule"), width: 1 }, size: label ? 74 : 34, labelSize: label ? 18 : 0,
    values: (_, splits) => splits.map((v) => v == null ? "" : digits(v)),
  });
  data.panels.forEach((panel) => {
    const place = document.createElement("div");
    place.className = "panel";
    byId("plots").append(place);
    const series = panel.names.map((name, i) => ({
      label: name, stroke: () => style(`--s${i % 6}`), width: 1.3, spanGaps: false, points: { show: false },
      value: (_, v) => digits(v),
    }));
    const plot = new uPlot({
      width: place.clientWidth, height: 168, padding: [8, 12, 0, 0],
      cursor: { sync: { key: "run" }, drag: { x: true, y: false } },
      scales: { x: { time: false, range: (u, low, high) => low === high ? [low - 1, high + 1] : [low, high] } },
      axes: [axis(""), axis(panel.unit)],
      series: [{ label: "t / s", value: (_, v) => digits(v) }, ...series],
      hooks: { setScale: [link], drawClear: [underlay], draw: [overlay] },
    }, [panel.t, ...panel.y], place);
    plot.over.addEventListener("click", () => {
      if (plot.cursor.left >= 0) show(plot.posToVal(plot.cursor.left, "x"));
    });
    plots.push(plot);
  });
  const redraw = () => plots.forEach((plot) => plot.redraw(false, false));
  new ResizeObserver(() => plots.forEach((plot) =>
    plot.setSize({ width: byId("plots").clientWidth, height: 168 }))).observe(byId("plots"));

  // ---- drawing -------------------------------------------------------------------------------
  const picture = byId("picture");
  const frames = data.frames;
  const drawing = frames && frames.t.length ? data.drawing : null;
  const magnified = {};
  const operations = {
    add: (a, b) => a + b, sub: (a, b) => a - b, mul: (a, b) => a * b, div: (a, b) => a / b, neg: (a) => -a,
    sq: (a) => a * a, twice: (a) => 2 * a, inv: (a) => 1 / a, sin: Math.sin, cos: Math.cos, tan: Math.tan,
    exp: Math.exp, log: Math.log, sqrt: Math.sqrt, atan2: Math.atan2, abs: Math.abs, sign: Math.sign,
    min: Math.min, max: Math.max, pow: Math.pow, atan: Math.atan, asin: Math.asin, acos: Math.acos,
  };
  const evaluate = (symbols) => {
    const w = new Float64Array(Math.max(drawing.registers, 1)), out = new Float64Array(drawing.outputs);
    for (const [op, to, a, b] of drawing.program) {
      if (op === "const") w[to] = a;
      else if (op === "in") w[to] = symbols[a];
      else if (op === "out") out[to] = w[a];
      else w[to] = operations[op](w[a], w[b]);
    }
    return out;
  };
  // The last frame that is not after a time.
  const frameAt = (t) => {
    let low = 0, high = frames.t.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (frames.t[middle] <= t) low = middle; else high = middle - 1;
    }
    return low;
  };
  // The motion between two frames, by the cubic of their positions and rates.
  const between = (name, i, t) => {
    const q = frames.columns[name], v = frames.columns[name + ".rate"];
    const h = i + 1 < frames.t.length ? frames.t[i + 1] - frames.t[i] : 0;
    if (!v || !(h > 0) || t <= frames.t[i]) return q[i];
    const s = clamp((t - frames.t[i]) / h, 0, 1), r = 1 - s;
    return (1 + 2 * s) * r * r * q[i] + s * r * r * h * v[i] + s * s * (3 - 2 * s) * q[i + 1] - s * s * r * h * v[i + 1];
  };
  const valueOf = (name, i, t) => {
    if (!(name in frames.columns)) return data.parameters[name];
    const value = between(name, i, t);
    return name in magnified ? magnified[name] * value : value;
  };
  const points = (t) => {
    const i = frameAt(t);
    return evaluate(drawing.symbols.map((name) => valueOf(name, i, t)));
  };
  let box = null;
  const measure = () => {
    box = [Infinity, Infinity, -Infinity, -Infinity];
    const widen = (out, only) => drawing.shapes.forEach((shape) => {
      if ((shape.kind === "fixed") !== only) return;
      for (let k = 0; k < shape.points; k++) {
        const [x, y] = [out[shape.start + 2 * k], out[shape.start + 2 * k + 1]];
        if (!Number.isFinite(x) || !Number.isFinite(y)) continue;
        box = [Math.min(box[0], x), Math.min(box[1], y), Math.max(box[2], x), Math.max(box[3], y)];
      }
    });
    const stride = Math.max(1, Math.floor(frames.t.length / 400));
    for (let i = 0; i < frames.t.length; i += stride) widen(points(frames.t[i]), false);
    if (!(box[2] - box[0] + box[3] - box[1] > 0)) widen(points(first), true);
    const size = Math.max(box[2] - box[0], box[3] - box[1]) || 1;
    box = [box[0] - 0.12 * size, box[1] - 0.12 * size, box[2] + 0.12 * size, box[3] + 0.12 * size];
  };
  const paint = () => {
    const ratio = devicePixelRatio || 1, [width, height] = [picture.clientWidth, picture.clientHeight];
    if (picture.width !== Math.round(width * ratio)) picture.width = Math.round(width * ratio);
    if (picture.height !== Math.round(height * ratio)) picture.height = Math.round(height * ratio);
    const c = picture.getContext("2d");
    c.setTransform(ratio, 0, 0, ratio, 0, 0);
    c.clearRect(0, 0, width, height);
    const scale = Math.min(width / (box[2] - box[0]), height / (box[3] - box[1]));
    const [mx, my] = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
    const px = (x) => width / 2 + (x - mx) * scale, py = (y) => height / 2 - (y - my) * scale;
    const out = points(now);
    const colours = { body: style("--body"), liquid: style("--liquid"), steel: style("--steel"), ink: style("--ink") };
    for (const shape of drawing.shapes) {
      const at = [];
      for (let k = 0; k < shape.points; k++) at.push([px(out[shape.start + 2 * k]), py(out[shape.start + 2 * k + 1])]);
      c.lineWidth = shape.kind === "line" ? 3 : 1.5;
      c.strokeStyle = colours.steel;
      c.fillStyle = colours[shape.kind] || colours.steel;
      c.beginPath();
      if (shape.kind === "point" || shape.kind === "contact") {
        const radius = shape.radius ? Math.max(1, out[shape.start + 2] * scale) : shape.kind === "point" ? 6 : 4;
        c.arc(at[0][0], at[0][1], radius, 0, 2 * Math.PI);
        if (shape.kind === "point") c.fill(); else c.stroke();
      } else if (shape.kind === "spring") {
        spring(c, at);
        c.stroke();
      } else {
        at.forEach(([x, y], k) => k ? c.lineTo(x, y) : c.moveTo(x, y));
        if (shape.kind === "body" || shape.kind === "liquid") { c.closePath(); c.fill(); }
        if (shape.kind !== "liquid") c.stroke();
        if (shape.kind === "fixed") hatch(c, at);
      }
    }
  };
  const spring = (c, [[x0, y0], [x1, y1]]) => {
    const [dx, dy] = [x1 - x0, y1 - y0], length = Math.hypot(dx, dy) || 1, [nx, ny] = [-dy / length * 6, dx / length * 6];
    c.moveTo(x0, y0);
    for (let k = 1; k < 16; k++) {
      const side = k < 2 || k > 14 ? 0 : k % 2 ? 1 : -1;
      c.lineTo(x0 + dx * k / 16 + side * nx, y0 + dy * k / 16 + side * ny);
    }
    c.lineTo(x1, y1);
  };
  const hatch = (c, at) => {
    c.lineWidth = 1;
    c.beginPath();
    for (let k = 1; k < at.length; k++) {
      const [[x0, y0], [x1, y1]] = [at[k - 1], at[k]], length = Math.hypot(x1 - x0, y1 - y0);
      const [ux, uy] = [(x1 - x0) / length, (y1 - y0) / length];
      for (let s = 4; s < Math.min(length, 4000); s += 10) {
        c.moveTo(x0 + ux * s, y0 + uy * s);
        c.lineTo(x0 + ux * (s - 7) - uy * 8, y0 + uy * (s - 7) + ux * 8);
      }
    }
    c.stroke();
  };
  const nearest = (panel, i) => {
    let low = 0, high = panel.t.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (panel.t[middle] <= now) low = middle; else high = middle - 1;
    }
    return panel.y[i][low];
  };
  const read = () => {
    const visit = data.visits.findLast(([from]) => from <= now) || data.visits[0];
    const lines = [`t = ${now.toFixed(Math.max(0, Math.min(9, 4 - Math.floor(Math.log10(Math.max(last - first, 1e-12))))))} s`];
    if (visit) lines.push(data.modes[visit[2]]);
    byId("readout").textContent = lines.join("\n");
    const forces = byId("forces");
    forces.textContent = "";
    if (!byId("with-forces").checked) return;
    data.panels.forEach((panel) => panel.names.forEach((name, i) => {
      if (panel.kind === "reaction") forces.append(`${name} = ${digits(nearest(panel, i))} ${panel.unit}\n`);
    }));
  };
  const show = (t) => {
    now = clamp(t, first, last);
    byId("time").value = String(last > first ? (now - first) / (last - first) : 0);
    if (drawing) paint();
    read();
    redraw();
  };

  // ---- playing -------------------------------------------------------------------------------
  const speeds = [1e-5, 1e-4, 1e-3, 0.01, 0.03, 0.1, 0.25, 0.5, 1, 2, 5, 10, 100, 1000];
  const speed = byId("speed");
  for (const s of speeds) speed.append(new Option(`${s} ×`, String(s)));
  const fitting = speeds.find((s) => (last - first) / s <= 12) ?? speeds[speeds.length - 1];
  speed.value = String(fitting);
  let playing = null;
  const play = (on) => {
    playing = on ? { from: performance.now(), at: now >= last ? first : now, speed: Number(speed.value) } : null;
    byId("play").textContent = on ? "pause" : "play";
    if (on) requestAnimationFrame(tick);
  };
  const tick = (moment) => {
    if (!playing) return;
    const t = playing.at + (moment - playing.from) / 1000 * playing.speed;
    show(t);
    if (t >= last) play(false); else requestAnimationFrame(tick);
  };
  const restart = () => { if (playing) play(true); };
  byId("play").addEventListener("click", () => play(!playing));
  byId("time").addEventListener("input", (e) => { play(false); show(first + Number(e.target.value) * (last - first)); });
  speed.addEventListener("change", restart);
  byId("with-forces").addEventListener("change", read);
  const step = (direction) => {
    play(false);
    if (!drawing) return show(now + direction * (last - first) / 100);
    const i = frameAt(now);
    show(frames.t[clamp(direction > 0 ? i + 1 : now > frames.t[i] ? i : i - 1, 0, frames.t.length - 1)]);
  };
  document.addEventListener("keydown", (e) => {
    if (e.target.matches("input[type=number], select, textarea") || e.ctrlKey || e.metaKey || e.altKey) return;
    const change = (by) => {
      speed.selectedIndex = clamp(speed.selectedIndex + by, 0, speeds.length - 1);
      restart();
    };
    const keys = {
      " ": () => play(!playing), ArrowRight: () => step(1), ArrowLeft: () => step(-1), Home: () => show(first),
      End: () => show(last), "+": () => change(1), "-": () => change(-1),
    };
    if (!(e.key in keys) || (e.key === " " && e.target.matches("button, summary"))) return;
    e.preventDefault();
    keys[e.key]();
  });
  const varies = (name) => frames.columns[name].some((x) => x !== frames.columns[name][0]);
  const moves = drawing ? drawing.symbols.filter((name) => data.coordinates.includes(name) && varies(name)) : [];
  const fields = {};
  for (const name of moves) {
    const label = document.createElement("label"), field = document.createElement("input");
    Object.assign(field, { type: "number", value: "1", step: "any", min: "0" });
    label.append(`${name} × `, field);
    field.addEventListener("input", () => {
      const factor = Number(field.value);
      if (factor === 1 || !Number.isFinite(factor)) delete magnified[name]; else magnified[name] = factor;
      measure();
      show(now);
    });
    fields[name] = field;
    byId("magnify").append(label);
  }
  // Powers of ten that make each motion take an eighth of the picture, where it takes less than a hundredth.
  const magnify = () => {
    for (const name of moves) delete magnified[name];
    measure();
    const size = Math.max(box[2] - box[0], box[3] - box[1]);
    for (const name of moves) {
      const column = frames.columns[name].filter(Number.isFinite);
      const peak = column.reduce((most, x) => Math.max(most, Math.abs(x)), 0);
      const at = (value) => evaluate(drawing.symbols.map((s) => s === name ? value : valueOf(s, 0, first)));
      const [rest, moved] = [at(0), at(peak)];
      const most = moved.reduce((m, x, k) => Math.max(m, Math.abs(x - rest[k])), 0);
      const factor = most > 0 && most < 0.01 * size ? 10 ** Math.floor(Math.log10(size / 8 / most)) : 1;
      fields[name].value = String(factor);
      if (factor !== 1) magnified[name] = factor;
    }
    measure();
    show(now);
  };
  if (drawing) {
    measure();
    byId("magnify-small").addEventListener("click", magnify);
    new ResizeObserver(() => paint()).observe(picture);
  } else {
    byId("stage").hidden = true;
    byId("magnify").hidden = true;
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => show(now));
  show(first);
  window.dalembert = { show, plots, data, picture };
})();
