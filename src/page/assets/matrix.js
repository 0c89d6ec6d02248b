// ---- the runs of a study: points in plots of its columns against each other -----------------------
const { columns: plotted, failed, told, commands } = data.matrix;
const count = told.length;
let cells = [], chosenColumns = data.matrix.shown.map((i) => plotted[i]);
let marked = null; // runs inside the frame that was drawn
let picked = null; // the run whose command is shown
const matrix = byId("matrix");
for (const column of plotted) {
  const box = element("input", { type: "checkbox", checked: chosenColumns.includes(column) });
  box.addEventListener("change", () => {
    const wanted = new Set(chosenColumns);
    if (box.checked) wanted.add(column); else wanted.delete(column);
    chosenColumns = plotted.filter((other) => wanted.has(other));
    build();
  });
  byId("columns").append(element("label", {}, box, " ", column.name));
}

const build = () => {
  matrix.replaceChildren();
  cells = [];
  const xs = chosenColumns.length > 1 ? chosenColumns.slice(0, -1) : chosenColumns, ys = chosenColumns.slice(-xs.length);
  matrix.style.gridTemplateColumns = `repeat(${xs.length}, minmax(14em, 1fr))`;
  ys.forEach((y, row) => xs.forEach((x, place) => {
    if (place > row) { matrix.append(element("span")); return; }
    const canvas = element("canvas", { ariaLabel: `${y.name} over ${x.name}` });
    canvas.setAttribute("role", "img");
    matrix.append(canvas);
    const range = (column) => widened(extent(column.values), false, 0.05);
    const cell = { canvas, x, y, rx: range(x), ry: range(y), frame: null };
    listen(cell);
    cells.push(cell);
  }));
  drawCells();
};

const left = 58, below = 34, edge = 8;
const pointOf = ({ canvas, x, y, rx, ry }, i) => {
  const [u, v] = [x.values[i], y.values[i]];
  if (u == null || v == null) return null;
  const width = canvas.clientWidth - left - edge, height = canvas.clientHeight - below - edge;
  return [left + width * (u - rx[0]) / (rx[1] - rx[0]), edge + height * (1 - (v - ry[0]) / (ry[1] - ry[0]))];
};
// The end of a long path tells it from others.
const short = (name) => name.length > 24 ? "…" + name.slice(-23) : name;
const titled = ({ name, unit }) => printedUnit(unit) ? `${short(name)} (${printedUnit(unit)})` : short(name);
const colourOf = (i) => style(!failed.length || failed[i] === false ? "--s0" : failed[i] ? "--alarm" : "--s7");
const drawCell = (cell) => {
  const { canvas, x, y, rx, ry } = cell, ratio = devicePixelRatio;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const c = canvas.getContext("2d"), [right, bottom] = [canvas.clientWidth, canvas.clientHeight];
  c.scale(ratio, ratio);
  c.font = "11px system-ui, sans-serif";
  c.strokeStyle = style("--rule");
  c.strokeRect(left, edge, right - left - edge, bottom - below - edge);
  c.fillStyle = style("--ink");
  c.textAlign = "center";
  c.fillText(titled(x), (left + right) / 2, bottom - 5);
  c.save();
  c.translate(11, bottom / 2);
  c.rotate(-Math.PI / 2);
  c.fillText(titled(y), 0, 0);
  c.restore();
  // Least and largest values, at their places.
  const shown = (value, { unit }) => digits(inUnit(value, unit), 3);
  const along = (value, [low, high], from, to) => from + (to - from) * (value - low) / (high - low);
  for (const value of extent(x.values)) c.fillText(shown(value, x), along(value, rx, left, right - edge), bottom - 19);
  c.textAlign = "right";
  for (const value of extent(y.values)) c.fillText(shown(value, y), left - 4, along(value, ry, bottom - below, edge) + 4);
  for (const front of [false, true]) for (let i = 0; i < count; i++) {
    if ((marked !== null && marked.has(i)) !== front) continue;
    const at = pointOf(cell, i);
    if (!at) continue;
    c.globalAlpha = marked === null || front ? 0.75 : 0.12;
    c.fillStyle = colourOf(i);
    c.beginPath();
    c.arc(at[0], at[1], i === picked ? 6 : 2.6, 0, 2 * Math.PI);
    c.fill();
  }
  c.globalAlpha = 1;
  if (!cell.frame) return;
  const [[ax, ay], [bx, by]] = cell.frame;
  c.strokeStyle = style("--ink");
  c.strokeRect(Math.min(ax, bx), Math.min(ay, by), Math.abs(ax - bx), Math.abs(ay - by));
};
const drawCells = () => cells.forEach(drawCell);

const pick = (i) => {
  picked = i;
  byId("command").hidden = false;
  byId("command").textContent = commands[i];
  byId("told").textContent = told[i];
  drawCells();
};
const listen = (cell) => {
  const { canvas } = cell;
  let from = null;
  const at = (event) => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
  canvas.addEventListener("pointerdown", (event) => {
    from = at(event);
    cells.forEach((other) => { other.frame = null; });
    if (event.isTrusted) canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const to = at(event);
    if (!from || Math.hypot(to[0] - from[0], to[1] - from[1]) < 4) return;
    cell.frame = [from, to];
    marked = new Set();
    const inside = (p, k) => p[k] >= Math.min(from[k], to[k]) && p[k] <= Math.max(from[k], to[k]);
    for (let i = 0; i < count; i++) {
      const p = pointOf(cell, i);
      if (p && inside(p, 0) && inside(p, 1)) marked.add(i);
    }
    byId("told").textContent = `${marked.size} of ${count} runs are marked`;
    drawCells();
  });
  canvas.addEventListener("pointerup", (event) => {
    const to = at(event);
    if (from && !cell.frame) {
      marked = null;
      let best = null, distance = 12;
      for (let i = 0; i < count; i++) {
        const p = pointOf(cell, i), d = p ? Math.hypot(p[0] - to[0], p[1] - to[1]) : Infinity;
        if (d < distance) { best = i; distance = d; }
      }
      if (best !== null) pick(best); else drawCells();
    }
    from = null;
  });
};
listeners.theme.push(drawCells);
listeners.units.push(drawCells);
new ResizeObserver(drawCells).observe(matrix);
build();
Object.assign(window.dalembert, { matrix: { cells: () => cells, pointOf, marked: () => marked } });
