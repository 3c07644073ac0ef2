// Columns of a system's result: as many charts as units, cut to what the screen shows by the server.

import { ask } from "./server.js";
import { Chart, short } from "./curves.js";
import { Orbit } from "./orbit.js";
import { Waterfall } from "./waterfall.js";
import { Motion } from "./motion.js";
import { byId, fail } from "./said.js";

const MOST = 16;

export async function showColumns() {
  const description = await ask("/api/columns");
  byId("title").textContent = description.title;
  byId("file").textContent = `${description.kind} result, ${description.rows} rows`;
  document.title = `${description.title}, gearmesh studio`;
  byId("columns").hidden = false;
  byId("tools").hidden = true;
  const chosen = new Set(description.columns.slice(0, 1).map((column) => column.name));
  const charts = new Map();
  let range = null;
  let number = 0;

  const zoomed = (found) => {
    range = byId("shown").value === "spectrum" ? range : found;
    draw();
  };

  let [orbit, waterfall] = [null, null];
  const dropped = (one) => {
    one?.figure.remove();
    return null;
  };

  /** Two columns against each other, row by row. */
  async function drawOrbit(pair, own) {
    try {
      const answer = await ask("/api/columns", { columns: pair.map((column) => column.name), together: true, from: range?.[0] ?? null, to: range?.[1] ?? null });
      if (own !== number) return;
      orbit ??= new Orbit(byId("plots"));
      orbit.show(answer.curves, pair);
      byId("rows").textContent = answer.every > 1 ? `${answer.rows} rows, one of ${answer.every} drawn` : `${answer.rows} rows`;
      fail(null);
    } catch (problem) {
      if (problem.kind !== "overtaken") fail(problem);
    }
  }

  async function draw() {
    const own = ++number;
    const isSpectrum = byId("shown").value === "spectrum";
    const columns = description.columns.filter((column) => chosen.has(column.name));
    const how = byId("shown").value;
    if (how !== "orbit") orbit = dropped(orbit);
    if (how !== "waterfall") waterfall = dropped(waterfall);
    if (how === "orbit" || how === "waterfall") {
      for (const chart of charts.values()) chart.figure.remove();
      charts.clear();
      if (how === "orbit" && columns.length >= 2) return drawOrbit(columns.slice(0, 2), own);
      if (how === "waterfall" && columns.length > 0) {
        waterfall ??= new Waterfall(byId("plots"), description.columns);
        return waterfall.show(columns[0], range);
      }
      orbit = dropped(orbit);
      byId("rows").textContent = "choose a column, for an orbit two";
      return;
    }
    const units = Map.groupBy(columns, (column) => column.unit);
    for (const [unit, chart] of charts) {
      if (!units.has(unit)) {
        chart.figure.remove();
        charts.delete(unit);
      }
    }
    try {
      const names = columns.map((column) => column.name);
      const answer = await ask("/api/columns", { columns: names, spectrum: isSpectrum, from: range?.[0] ?? null, to: range?.[1] ?? null });
      if (own !== number) return;
      for (const [unit, group] of units) {
        if (!charts.has(unit)) charts.set(unit, new Chart(byId("plots"), { title: "", x: "", y: unit, height: 300, zoomed }));
        const chart = charts.get(unit);
        chart.x = isSpectrum ? "frequency Hz" : `${description.axis.label} ${description.axis.unit}`;
        const series = group.map((column) => ({ label: column.label, values: answer.curves[names.indexOf(column.name)] }));
        chart.show(answer.x, series, `${unit}${isSpectrum ? ", amplitude over frequency in Hz" : ` over ${chart.x}`}`);
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
  const motion = new Motion(() => range, (at) => [...charts.values()].forEach((chart) => byId("shown").value === "spectrum" || chart.markAt(at)));
  byId("whole").addEventListener("click", () => {
    range = null;
    draw();
  });
  await draw();
  return () => {
    motion.restyle();
    draw();
  };
}
