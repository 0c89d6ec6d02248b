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
byId("with-forces").addEventListener("change", () => show(now));
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
  const zoomed = (factor) => {
    const plot = plots.find(({ spec }) => spec.time);
    if (!plot) return;
    const [from, to] = plot.view.x, at = now >= from && now <= to ? now : (from + to) / 2;
    const [low, high] = plot.all_x;
    zoomGroup(plot, [Math.max(low, at - (at - from) * factor), Math.min(high, at + (to - at) * factor)], null);
  };
  const keys = {
    i: () => zoomed(0.5), o: () => zoomed(2), 0: () => plots.forEach((plot) => plot.reset()),
    c: () => { byId("with-forces").checked = !byId("with-forces").checked; show(now); },
    " ": () => play(!playing), ArrowRight: () => step(1), ArrowLeft: () => step(-1), Home: () => show(first),
    End: () => show(last), "+": () => change(1), "-": () => change(-1),
  };
  if (!(e.key in keys) || (e.key === " " && e.target.matches("button, summary"))) return;
  e.preventDefault();
  keys[e.key]();
  plots.moved?.();
});
const varies = (name) => frames.columns[name].some((x) => x !== frames.columns[name][0]);
const moves = drawing ? drawing.symbols.filter((name) => motion.coordinates.includes(name) && varies(name)) : [];
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
  measureForces();
  byId("magnify-small").addEventListener("click", magnify);
  new ResizeObserver(() => paint()).observe(picture);
} else {
  byId("stage").hidden = true;
  byId("magnify").hidden = true;
}
if (!moves.length) byId("magnify").hidden = true;
plots.moved = () => show(now);
listeners.theme.push(() => show(now));
listeners.units.push(() => show(now));
redraw();
show(first);
Object.assign(window.dalembert, { show, picture, motion, contacts });
