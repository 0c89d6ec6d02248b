// Numbers, units of the reader's choice, light and dark. Everything comes from the data beside the scripts.
const data = JSON.parse(document.getElementById("data").textContent);
const byId = (id) => document.getElementById(id);
const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
const element = (tag, attributes = {}, ...children) => {
  const made = Object.assign(document.createElement(tag), attributes);
  made.append(...children);
  return made;
};
const digits = (x, count = 6) => {
  if (x == null || !Number.isFinite(x)) return "–";
  const rounded = Number(x.toPrecision(count)), size = Math.abs(rounded);
  const text = size >= 1e6 || (size !== 0 && size < 1e-4) ? rounded.toExponential() : String(rounded);
  return text.replace(/-/g, "−").replace("e+", "e");
};

// ---- units: those of models, and what the reader has chosen for them ---------------------------
const known = new Map(data.units.known), chosen = new Map(data.units.chosen);
// The unit that is shown for one of a model, and how many of it are one of the model's.
const shownUnit = (unit) => {
  const factorOf = (of) => known.get(of).find(([name]) => name === chosen.get(of))[1];
  if (chosen.has(unit)) return { name: chosen.get(unit), factor: factorOf(unit) };
  let factor = 1;
  const parts = unit.split("/").map((part, place) => part.split(/[ *]/).map((token) => {
    const [name, power = "1"] = token.split("^");
    if (!chosen.has(name)) return token;
    factor *= factorOf(name) ** (place ? -power : power);
    return chosen.get(name) + token.slice(name.length);
  }).join(" "));
  return { name: parts.join("/"), factor };
};
const raised = (text) => text.replace(/\^(-?\d+)/g, (_, power) => [...power].map((c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]).join(""));
const printedUnit = (unit) => unit === "1" ? "" : raised(shownUnit(unit).name).replaceAll(" ", "·");
const inUnit = (x, unit) => x == null ? x : x * shownUnit(unit).factor;
const listeners = { units: [], theme: [] };
const showUnits = () => {
  for (const cell of all("[data-unit]")) {
    const { unit, value, label } = cell.dataset;
    const name = printedUnit(unit);
    if (value != null) cell.textContent = digits(inUnit(Number(value), unit), 7);
    else if (label != null) cell.textContent = name ? `${label} / ${name}` : label;
    else cell.textContent = cell.closest(".plot") ? name && `(${name})` : name || unit;
  }
  listeners.units.forEach((tell) => tell());
};
// Units that the page has numbers in, to be chosen.
const used = new Set(all("[data-unit]").flatMap((cell) => cell.dataset.unit.split(/[\/ *]/)).map((token) => token.split("^")[0]));
const tools = byId("tools");
for (const [of, choices] of known) {
  if (!used.has(of) && !all("[data-unit]").some((cell) => cell.dataset.unit === of)) continue;
  const select = element("select", { title: `shown for ${of}` });
  const names = choices.map(([name]) => name);
  if (!names.includes(of)) names.unshift("");
  for (const name of names) select.append(new Option(name || raised(of), name));
  select.value = chosen.get(of) ?? (names.includes(of) ? of : "");
  select.addEventListener("change", () => {
    if (select.value && select.value !== of) chosen.set(of, select.value); else chosen.delete(of);
    showUnits();
  });
  tools.append(select);
}
if (tools.childElementCount) tools.prepend("units");

// ---- light and dark: the system's choice, the reader's, and light on paper ----------------------
const root = document.documentElement, dark = matchMedia("(prefers-color-scheme: dark)");
const isDark = () => root.dataset.theme ? root.dataset.theme === "dark" : dark.matches;
const setTheme = (theme) => {
  if (theme) root.dataset.theme = theme; else delete root.dataset.theme;
  listeners.theme.forEach((tell) => tell());
};
const themeButton = element("button", { textContent: "◐", title: "light or dark" });
themeButton.addEventListener("click", () => setTheme(isDark() ? "light" : "dark"));
tools.append(themeButton);
dark.addEventListener("change", () => setTheme(root.dataset.theme));
let beforePrint = null;
addEventListener("beforeprint", () => { beforePrint = root.dataset.theme ?? ""; setTheme("light"); });
addEventListener("afterprint", () => setTheme(beforePrint));
