"use strict";
// Every run of a study as a point in plots of its columns against each other.
const data = JSON.parse(document.getElementById("data").textContent);
const columns = new Map(data.columns.map((column) => [column.name, column]));
const count = data.columns.length ? data.columns[0].values.length : 0;
const isNumber = (column) => column.values.some((x) => typeof x === "number") && column.values.every((x) => x === null || typeof x === "number");
const varies = (column) => new Set(column.values).size > 1;
const solver = new Set(["case", "run", "t", "events", "uncertain", "steps", "rejected", "residual_evaluations", "jacobian_evaluations", "factorizations"]);
const numeric = data.columns.filter((column) => isNumber(column) && varies(column));
const most = 4;
let shown = numeric.filter((column) => !solver.has(column.name)).slice(0, most);
if (shown.length < 2) shown = numeric.slice(0, most);
const failed = columns.get("failed");
let marked = null; // rows inside the brush
let picked = null; // the row whose command is shown

const matrix = document.getElementById("matrix");
const choices = document.getElementById("columns");
for (const column of numeric) {
  const label = document.createElement("label");
  const box = document.createElement("input");
  box.type = "checkbox";
  box.checked = shown.includes(column);
  box.addEventListener("change", () => {
    shown = box.checked ? [...shown, column] : shown.filter((other) => other !== column);
    build();
  });
  label.append(box, " ", column.name);
  choices.append(label);
}

function range(values) {
  let low = Infinity, high = -Infinity;
  for (const x of values) if (x !== null) { low = Math.min(low, x); high = Math.max(high, x); }
  const margin = 0.05 * (high - low || Math.abs(high) || 1);
  return [low - margin, high + margin];
}

const cells = [];
function build() {
  cells.length = 0;
  matrix.replaceChildren();
  const ys = shown.length > 1 ? shown.slice(1) : shown;
  const xs = shown.length > 1 ? shown.slice(0, -1) : shown;
  matrix.style.gridTemplateColumns = `repeat(${xs.length}, minmax(14em, 1fr))`;
  ys.forEach((y, row) => xs.forEach((x, place) => {
    if (place > row) { matrix.append(document.createElement("span")); return; }
    const canvas = document.createElement("canvas");
    canvas.setAttribute("aria-label", `${y.name} over ${x.name}`);
    matrix.append(canvas);
    const cell = { canvas, x, y, rx: range(x.values), ry: range(y.values), brush: null };
    listen(cell);
    cells.push(cell);
  }));
  draw();
}

const left = 58, below = 34, edge = 8;
function place(cell, i) {
  const { canvas, x, y, rx, ry } = cell;
  const [u, v] = [x.values[i], y.values[i]];
  if (u === null || v === null) return null;
  const width = canvas.clientWidth - left - edge, height = canvas.clientHeight - below - edge;
  return [left + width * (u - rx[0]) / (rx[1] - rx[0]), edge + height * (1 - (v - ry[0]) / (ry[1] - ry[0]))];
}

function draw() {
  const style = getComputedStyle(document.body);
  for (const cell of cells) {
    const { canvas } = cell, ratio = window.devicePixelRatio || 1;
    canvas.style.height = "15em";
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    const g = canvas.getContext("2d");
    g.scale(ratio, ratio);
    g.font = "11px sans-serif";
    g.fillStyle = style.color;
    // The end of a long path tells it from others.
    const short = (name) => name.length > 24 ? "…" + name.slice(-23) : name;
    const unit = (column) => column.unit === "1" ? short(column.name) : `${short(column.name)} (${column.unit})`;
    g.textAlign = "center";
    g.fillText(unit(cell.x), (left + canvas.clientWidth) / 2, canvas.clientHeight - 5);
    g.save();
    g.translate(11, canvas.clientHeight / 2);
    g.rotate(-Math.PI / 2);
    g.fillText(unit(cell.y), 0, 0);
    g.restore();
    const digits = (x) => String(Number(x.toPrecision(3)));
    g.textAlign = "left";
    g.fillText(digits(cell.rx[0]), left, canvas.clientHeight - 19);
    g.textAlign = "right";
    g.fillText(digits(cell.rx[1]), canvas.clientWidth - edge, canvas.clientHeight - 19);
    g.fillText(digits(cell.ry[0]), left - 4, canvas.clientHeight - below);
    g.fillText(digits(cell.ry[1]), left - 4, edge + 9);
    for (const front of [false, true]) for (let i = 0; i < count; i++) {
      if ((marked !== null && marked.has(i)) !== front) continue;
      const at = place(cell, i);
      if (!at) continue;
      g.globalAlpha = marked === null || front ? 0.75 : 0.12;
      g.fillStyle = failed && failed.values[i] ? "#c0392b" : "#2471a3";
      g.beginPath();
      g.arc(at[0], at[1], i === picked ? 6 : 2.6, 0, 2 * Math.PI);
      g.fill();
    }
    g.globalAlpha = 1;
    if (cell.brush) {
      const [a, b] = cell.brush;
      g.strokeStyle = style.color;
      g.strokeRect(Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.abs(a[0] - b[0]), Math.abs(a[1] - b[1]));
    }
  }
}

const quoted = (text) => /^[\w./=+,:@%-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
function command(i) {
  const set = data.factors.map((path) => {
    const value = columns.get(path).values[i];
    return ` --set ${quoted(`${path}=${value}`)}`;
  });
  return `dalembert run ${quoted(data.scene)}${set.join("")}`;
}

function pick(i) {
  picked = i;
  const line = document.getElementById("command");
  line.hidden = false;
  line.textContent = command(i);
  const of = (name) => columns.has(name) ? columns.get(name).values[i] : null;
  const reason = of("reason");
  document.getElementById("told").textContent = `case ${of("case")}: ${of("status")}${reason ? ", " + reason : ""}`;
  draw();
}

function listen(cell) {
  const { canvas } = cell;
  let from = null;
  const at = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  canvas.addEventListener("pointerdown", (event) => {
    from = at(event);
    canvas.setPointerCapture(event.pointerId);
    cells.forEach((other) => { other.brush = null; });
  });
  canvas.addEventListener("pointermove", (event) => {
    if (!from) return;
    const to = at(event);
    if (Math.hypot(to[0] - from[0], to[1] - from[1]) < 4) return;
    cell.brush = [from, to];
    marked = new Set();
    for (let i = 0; i < count; i++) {
      const p = place(cell, i);
      const inside = (k) => p[k] >= Math.min(from[k], to[k]) && p[k] <= Math.max(from[k], to[k]);
      if (p && inside(0) && inside(1)) marked.add(i);
    }
    draw();
  });
  canvas.addEventListener("pointerup", (event) => {
    const to = at(event);
    if (from && !cell.brush) {
      marked = null;
      let best = null, distance = 12;
      for (let i = 0; i < count; i++) {
        const p = place(cell, i);
        const d = p ? Math.hypot(p[0] - to[0], p[1] - to[1]) : Infinity;
        if (d < distance) { best = i; distance = d; }
      }
      if (best !== null) pick(best); else draw();
    }
    from = null;
  });
}

window.addEventListener("resize", draw);
build();
