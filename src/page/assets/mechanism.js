// The mechanism of a run: what its model draws, at any time between the first and the last.
const motion = data.motion;
const [first, last] = motion.span;
let now = first;

// ---- modes and events, under the curves of plots over time -------------------------------------
const tint = (mode, alpha) => `hsla(${(mode * 137.5 + 205) % 360}, 55%, 55%, ${alpha})`;
for (const [i, name] of Object.entries(motion.modes)) {
  const swatch = element("span", { className: "swatch" });
  swatch.style.background = tint(i, 0.45);
  byId("modes").append(swatch, name);
}
plots.under = (u, plot) => {
  if (!plot.spec.time) return;
  const { left, top, width, height } = u.bbox;
  const x = (t) => u.valToPos(inUnit(t, "s"), "x", true);
  u.ctx.save();
  u.ctx.beginPath();
  u.ctx.rect(left, top, width, height);
  u.ctx.clip();
  for (const [from, to, mode] of motion.visits) {
    const [a, b] = [x(from), x(to)];
    if (b < left || a > left + width) continue;
    u.ctx.fillStyle = tint(mode, 0.13);
    u.ctx.fillRect(a, top, Math.max(b - a, 1), height);
  }
  u.ctx.fillStyle = style("--faint");
  for (const [t] of motion.events) u.ctx.fillRect(x(t), top, 1, 5 * devicePixelRatio);
  u.ctx.restore();
};
// The names of transitions under the cursor, or within so many pixels of it, beside it.
const NEAR = 4;
plots.named = (plot, left, top) => {
  const tag = plot.tag ??= plot.u.over.appendChild(element("div", { className: "tag", hidden: true }));
  const x = (t) => plot.u.valToPos(inUnit(t, "s"), "x");
  const near = left < 0 || top < 0 ? [] : motion.events.filter(([t]) => Math.abs(x(t) - left) <= NEAR);
  tag.hidden = !near.length;
  if (tag.hidden) return;
  const [t, name] = near.reduce((best, event) => Math.abs(x(event[0]) - left) < Math.abs(x(best[0]) - left) ? event : best);
  tag.textContent = `${name}, t = ${digits(inUnit(t, "s"), 8)} ${printedUnit("s")}` + (near.length > 1 ? `, one of ${near.length}` : "");
  const onRight = x(t) < plot.u.over.clientWidth / 2;
  Object.assign(tag.style, { left: onRight ? `${x(t) + 6}px` : "", right: onRight ? "" : `${plot.u.over.clientWidth - x(t) + 6}px` });
};

// ---- drawing -------------------------------------------------------------------------------
const picture = byId("picture");
const frames = motion.frames;
const drawing = frames && frames.t.length ? motion.drawing : null;
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
  if (!(name in frames.columns)) return motion.parameters[name];
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
// ---- forces and contacts -------------------------------------------------------------------
const modeAt = (t) => motion.visits.findLast(([from]) => from <= t)?.[2] ?? motion.visits[0][2];
// Columns that are forces: all reactions, and what pushes at declared contacts.
const pushing = new Set(motion.drawing?.shapes.flatMap(({ pushes }) => pushes ?? []));
const forces = {};
for (const { spec, curves } of plots) for (const curve of curves)
  if (spec.time && (curve.name.startsWith("reaction.") || pushing.has(curve.name)))
    forces[curve.name] = { unit: spec.y.unit, at: (t) => valueAt(curve, t) ?? curve.y[curve.y.length - 1] };
for (const [name, [value, unit]] of Object.entries(motion.held))
  if (name.startsWith("reaction.") || pushing.has(name)) forces[name] = { unit, at: () => value };
const valueOfForce = (name, t) => forces[name]?.at(t) ?? 0;
// The force at a contact on the body, to the right and upwards: of a declared one the sum along its directions, which
// stand behind the point.
const forceOf = (shape, t) => {
  if (!shape.pushes) return (shape.force ?? []).map((name) => valueOfForce(name, t));
  const out = points(t), along = (k, axis) => out[shape.start + 2 + 2 * k + axis];
  return [0, 1].map((axis) => shape.pushes.reduce((sum, name, k) => sum + valueOfForce(name, t) * along(k, axis), 0));
};
// The state of a contact in a mode; null where it has none to tell. Modes of declared contacts are named by all their states.
const stateOf = (shape, mode) => {
  if (shape.states) return shape.states[mode] ?? "open";
  return mode.split(", ").find((part) => part.startsWith(`${shape.of} `))?.slice(shape.of.length + 1) ?? null;
};
let largest = 0;
const measureForces = () => {
  for (const { curves, spec } of plots) for (const { name, y } of curves)
    if (spec.time && drawing.shapes.some(({ force, pushes }) => force?.includes(name) || pushes?.includes(name)))
      largest = Math.max(largest, ...extent(y).map(Math.abs).filter(Number.isFinite));
  for (const shape of drawing.shapes) largest = Math.max(largest, ...forceOf(shape, first).map(Math.abs));
};
// What is told of the contacts now: their names, states and forces.
const contacts = () => drawing.shapes.filter(({ kind }) => kind === "contact").map((shape) => ({
  name: shape.name, state: stateOf(shape, motion.modes[modeAt(now)]), force: forceOf(shape, now),
}));
const LINE = 15; // height of a line of words, px
// A contact: a ring where it is open, a disc where it is closed, with its state in words and the force on the body, whose
// arrow ends at the contact.
const contact = (c, shape, [x, y], room, labels) => {
  const state = stateOf(shape, motion.modes[modeAt(now)]);
  const colour = style(state === "slides" ? "--s1" : "--s0");
  c.beginPath();
  c.arc(x, y, 5, 0, 2 * Math.PI);
  c.lineWidth = 2;
  c.strokeStyle = c.fillStyle = state === "open" ? style("--faint") : colour;
  if (state === "open" || state === null) c.stroke(); else c.fill();
  const words = [shape.name, state].filter(Boolean).join(": ");
  c.font = "12px system-ui, sans-serif";
  const length_of_words = c.measureText(words).width;
  const left = clamp(x - length_of_words / 2, 4, picture.clientWidth - length_of_words - 4);
  // Words of contacts beside each other stand below each other.
  let bottom = y + 22;
  const covered = () => labels.some((label) => Math.abs(label.bottom - bottom) < LINE && label.left < left + length_of_words + 6
    && left < label.left + label.width + 6);
  while (covered()) bottom += LINE;
  labels.push({ left, bottom, width: length_of_words });
  c.fillStyle = style("--ink");
  c.fillText(words, left, bottom);
  const [fx, fy] = forceOf(shape, now);
  if (state === "open" || !(Math.hypot(fx, fy) > 0) || !(largest > 0)) return;
  const scale = room / largest, [dx, dy] = [fx * scale, -fy * scale], length = Math.hypot(dx, dy);
  const [ux, uy] = [dx / length, dy / length], head = Math.min(9, length);
  c.strokeStyle = c.fillStyle = style("--alarm");
  c.beginPath();
  c.moveTo(x - dx, y - dy);
  c.lineTo(x - ux * head, y - uy * head);
  c.stroke();
  c.beginPath();
  c.moveTo(x, y);
  c.lineTo(x - ux * head - uy * head / 2.5, y - uy * head + ux * head / 2.5);
  c.lineTo(x - ux * head + uy * head / 2.5, y - uy * head - ux * head / 2.5);
  c.fill();
};
const paint = () => {
  const ratio = devicePixelRatio || 1, [width, height] = [picture.clientWidth, picture.clientHeight];
  if (picture.width !== Math.round(width * ratio)) picture.width = Math.round(width * ratio);
  if (picture.height !== Math.round(height * ratio)) picture.height = Math.round(height * ratio);
  const c = picture.getContext("2d");
  c.setTransform(ratio, 0, 0, ratio, 0, 0);
  c.clearRect(0, 0, width, height);
  // Room for forces from below, and for words.
  const below = byId("with-forces").checked && drawing.shapes.some(({ kind }) => kind === "contact") ? 0.28 * height : 0;
  const scale = Math.min(width / (box[2] - box[0]), (height - below) / (box[3] - box[1]));
  const [mx, my] = [(box[0] + box[2]) / 2, (box[1] + box[3]) / 2];
  const px = (x) => width / 2 + (x - mx) * scale, py = (y) => (height - below) / 2 - (y - my) * scale;
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
      if (shape.kind === "point") c.fill();
      else if (!byId("with-forces").checked) c.stroke();
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
  const labels = [];
  if (byId("with-forces").checked) for (const shape of drawing.shapes) if (shape.kind === "contact")
    contact(c, shape, [px(out[shape.start]), py(out[shape.start + 1])], Math.min(width, height) / 4, labels);
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
const read = () => {
  const places = clamp(4 - Math.floor(Math.log10(Math.max(inUnit(last - first, "s"), 1e-12))), 0, 12);
  byId("readout").textContent = `t = ${inUnit(now, "s").toFixed(places)} ${printedUnit("s")}\n${motion.modes[modeAt(now)]}`;
  const list = byId("forces");
  list.textContent = "";
  if (!byId("with-forces").checked) return;
  for (const [name, { unit, at }] of Object.entries(forces))
    list.append(`${name} = ${digits(inUnit(at(now), unit), 5)} ${printedUnit(unit)}\n`);
};
const show = (t) => {
  now = clamp(t, first, last);
  byId("time").value = String(last > first ? (now - first) / (last - first) : 0);
  if (drawing) paint();
  read();
  for (const plot of plots) if (plot.spec.time) {
    plot.read(now);
    const x = plot.u.valToPos(inUnit(now, "s"), "x");
    plot.line.hidden = !(x >= 0 && x <= plot.u.over.clientWidth);
    plot.line.style.left = `${x}px`;
  }
};
for (const plot of plots) if (plot.spec.time) plot.u.over.append(plot.line = element("div", { className: "now" }));
plots.now = () => now;
plots.go = (t) => show(t);
