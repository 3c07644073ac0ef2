// Columns of a system's result: as many charts as units, cut to what the screen shows by the server.

import { ask } from "./server.js";
import { Chart, joined } from "./curves.js";
import { curveColour, short } from "./drawing.js";
import { element } from "./dom.js";
import { Orbit } from "./orbit.js";
import { Planets } from "./planets.js";
import { Waterfall } from "./waterfall.js";
import { Motion } from "./motion.js";
import { byId, fail } from "./said.js";

const MOST = 16;

export async function showColumns() {
  const description = await ask("/api/columns");
  byId("title").textContent = description.title;
  const { beside } = description;
  const isSingle = description.rows === 1;
  byId("file").textContent = beside ? `${description.file}, ${description.rows} rows; dashed: ${beside.file}, ${beside.rows} rows` : `${description.kind} result, ${isSingle ? "one row" : `${description.rows} rows`}`;
  document.title = `${description.title}, gearmesh studio`;
  byId("columns").hidden = false;
  byId("tools").hidden = true;
  // A band in the middle of what the rows tell apart.
  const highest = description.highest_Hz ?? 0;
  byId("band-from").value = short(Number((0.25 * highest).toPrecision(2)));
  byId("band-to").value = short(Number((0.75 * highest).toPrecision(2)));
  byId("shown").parentElement.hidden = byId("whole").hidden = isSingle;
  if (description.sets.length === 0) byId("shown").querySelector("[value=planets]").remove();
  const chosen = new Set(description.columns.slice(0, isSingle ? MOST : 1).map((column) => column.name));
  const charts = new Map();
  let range = null;
  let number = 0;

  const isOverFrequency = () => byId("shown").value === "spectrum" || byId("shown").value === "envelope";
  const zoomed = (found) => {
    range = isOverFrequency() ? range : found;
    draw();
  };

  /** What of the stretch shown is asked for; `names` of the result beside where `other`. */
  const question = (names, shown, other) => ({
    columns: names,
    shown,
    from: range?.[0] ?? null,
    to: range?.[1] ?? null,
    beside: other,
    ...(shown === "envelope" ? { band_Hz: [Number(byId("band-from").value), Number(byId("band-to").value)] } : {}),
  });

  let [orbit, waterfall, planets] = [null, null, null];
  const dropped = (one) => {
    one?.figure.remove();
    return null;
  };

  /** Two columns against each other, row by row. */
  async function drawOrbit(pair, own) {
    try {
      const answer = await ask("/api/columns", question(pair.map((column) => column.name), "together", false));
      if (own !== number) return;
      orbit ??= new Orbit(byId("plots"));
      orbit.show(answer.curves, pair);
      byId("rows").textContent = answer.every > 1 ? `${answer.rows} rows, one of ${answer.every} drawn` : `${answer.rows} rows`;
      fail(null);
    } catch (problem) {
      if (problem.kind !== "overtaken") fail(problem);
    }
  }

  /** The values of a single row. */
  async function drawFigures(columns, own) {
    try {
      const answer = await ask("/api/columns", question(columns.map((column) => column.name), "together", false));
      if (own !== number) return;
      const row = ({ label, unit }, k) => {
        const value = answer.curves[k][0];
        const cells = unit === "m" ? [label, short(1e6 * value), "µm"] : [label, short(value), unit];
        return element("tr", {}, ...cells.map((textContent) => element("td", { textContent })));
      };
      byId("plots").replaceChildren(element("div", { className: "table" }, element("table", {}, element("tbody", {}, ...columns.map(row)))));
      byId("rows").textContent = "one equilibrium";
      fail(null);
    } catch (problem) {
      if (problem.kind !== "overtaken") fail(problem);
    }
  }

  async function draw() {
    const own = ++number;
    const isSpectrum = isOverFrequency();
    byId("band").hidden = byId("shown").value !== "envelope";
    const columns = description.columns.filter((column) => chosen.has(column.name));
    const how = byId("shown").value;
    if (how !== "orbit") orbit = dropped(orbit);
    if (how !== "waterfall") waterfall = dropped(waterfall);
    if (how !== "planets") planets = dropped(planets);
    if (how === "orbit" || how === "waterfall" || how === "planets") {
      for (const chart of charts.values()) chart.figure.remove();
      charts.clear();
      if (how === "planets") {
        planets ??= new Planets(byId("plots"));
        byId("rows").textContent = "";
        return planets.show(range);
      }
      if (how === "orbit" && columns.length >= 2) return drawOrbit(columns.slice(0, 2), own);
      if (how === "waterfall" && columns.length > 0) {
        waterfall ??= new Waterfall(byId("plots"), description.columns);
        return waterfall.show(columns[0], range);
      }
      orbit = dropped(orbit);
      byId("rows").textContent = "choose a column, for an orbit two";
      return;
    }
    if (description.rows === 1) return drawFigures(columns, own);
    const units = Map.groupBy(columns, (column) => column.unit);
    for (const [unit, chart] of charts) {
      if (!units.has(unit)) {
        chart.figure.remove();
        charts.delete(unit);
      }
    }
    try {
      const names = columns.map((column) => column.name);
      const answer = await ask("/api/columns", question(names, how, false));
      const common = beside ? names.filter((name) => beside.columns.includes(name)) : [];
      const other = common.length > 0 ? await ask("/api/columns", question(common, how, true)) : null;
      if (own !== number) return;
      for (const [unit, group] of units) {
        if (!charts.has(unit)) charts.set(unit, new Chart(byId("plots"), { title: "", x: "", y: unit, height: 300, linked: "columns", zoomed }));
        const chart = charts.get(unit);
        chart.x = isSpectrum ? "frequency Hz" : `${description.axis.label} ${description.axis.unit}`;
        const lines = group.map((column, k) => ({ label: column.label, z: answer.x, values: answer.curves[names.indexOf(column.name)], colour: curveColour(k), dash: [], spanGaps: true }));
        group.forEach((column, k) => {
          const at = common.indexOf(column.name);
          if (at >= 0) lines.push({ label: `${column.label}, ${beside.title}`, z: other.x, values: other.curves[at], colour: curveColour(k), dash: [6, 3], spanGaps: true });
        });
        const [x, series] = other ? joined(lines) : [answer.x, lines];
        chart.show(x, series, `${unit}${isSpectrum ? `, amplitude${how === "envelope" ? " of the envelope" : ""} over frequency in Hz` : ` over ${chart.x}`}`);
      }
      const drawn = !isSpectrum && answer.x.length < answer.rows ? `, drawn by ${answer.x.length} least and largest values` : "";
      byId("rows").textContent = range ? `${answer.rows} rows from ${short(range[0])} to ${short(range[1])}${drawn}` : `${answer.rows} rows${drawn}`;
      fail(null);
    } catch (problem) {
      if (problem.kind !== "overtaken") fail(problem);
    }
  }

  const labels = description.columns.map((column) => {
    const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: chosen.has(column.name) });
    box.addEventListener("change", () => {
      if (box.checked && chosen.size >= MOST) box.checked = false;
      if (box.checked) chosen.add(column.name);
      else chosen.delete(column.name);
      draw();
    });
    const label = Object.assign(document.createElement("label"), { title: `${column.name}: ${column.help}` });
    label.append(box, ` ${column.label} `, Object.assign(document.createElement("span"), { className: "unit", textContent: column.unit }));
    return { label, text: `${column.name} ${column.label}`.toLowerCase() };
  });
  byId("names").append(...labels.map((one) => one.label));
  byId("filter").addEventListener("input", () => {
    const wanted = byId("filter").value.toLowerCase();
    for (const { label, text } of labels) label.hidden = !text.includes(wanted);
  });
  byId("shown").addEventListener("change", draw);
  for (const end of ["band-from", "band-to"]) byId(end).addEventListener("change", draw);
  const motion = new Motion(() => range, (at) => [...charts.values()].forEach((chart) => isOverFrequency() || chart.markAt(at)));
  byId("whole").addEventListener("click", () => {
    range = null;
    draw();
  });
  await draw();
  byId("motion").open = isSingle;
  return () => {
    motion.restyle();
    draw();
  };
}
