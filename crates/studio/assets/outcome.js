// What bearings, bevel pairs and gearboxes come to: tables and curves of their figures.

import { BevelSpace } from "./bevel_space.js";
import { Chart } from "./curves.js";
import { DASHES, colour, short } from "./drawing.js";
import { element } from "./dom.js";
import { comparedCell } from "./variants.js";

const cell = (tag, text) => element(tag, {}, text);

function table(heads, rows) {
  const head = element("tr", {}, ...heads.map((text) => element("th", { scope: "col" }, text)));
  const body = rows.map(([first, ...others]) => element("tr", {}, element("th", { scope: "row" }, first), ...others.map((text) => cell("td", text))));
  return element("div", { className: "table", tabIndex: 0 }, element("table", {}, element("thead", {}, head), element("tbody", {}, ...body)));
}

/** Columns at rest: a number each, or one for each torque; beside them those of kept states at the last torque. */
export function showColumnsTable(place, { torques_Nm, columns }, pins = null) {
  const pinned = pins?.pinned ?? [];
  const heads = ["figure", "unit", ...(torques_Nm.length > 0 ? torques_Nm.map((load) => `${short(load)} N·m`) : [""])];
  const kept = pinned.map((pin) => new Map(pin.answer.columns.columns.map((column) => [column.name, column.values.at(-1)])));
  const rows = columns.map(({ name, label, unit, values }) => {
    const figures = values.map((value) => element("data", { value: String(value) }, short(value)));
    figures.forEach((one) => (one.dataset.column = name));
    return [label, unit, ...figures];
  });
  const made = table(heads, rows);
  made.querySelector("thead tr").append(...pinned.map((pin) => pins.head(pin)));
  made.querySelectorAll("tbody tr").forEach((row, k) => row.append(...kept.map((own) => comparedCell(columns[k].values.at(-1), own.get(columns[k].name)))));
  place.replaceChildren(made);
}

/** A bevel pair: the gears in space, its transmission error and pressure under each torque, its columns; once it was run, also what `gearmesh tca` finds. */
export class Bevel {
  constructor(place) {
    [this.place, this.curves, this.figures] = [place, element("div"), element("div")];
    // Gears and curves under load stand at one position.
    this.space = new BevelSpace((angle) => this.loaded.forEach((one) => one.markAt(angle)));
    const moved = (position) => this.space.at(position);
    const chart = (title, y, more) => new Chart(this.curves, { title, x: "pinion angle °", y, ...more });
    this.error = chart("Transmission error", "µm, under torques on the gear", { moved });
    this.pressure = chart("Largest pressure", "MPa", { moved });
    this.loaded = [this.error, this.pressure];
    this.free = chart("Transmission error without load", "µrad of the gear");
  }

  /** `pins`: states whose curves under the last torque stay, dashed. */
  show({ tca, columns, load, lines }, pins) {
    if (this.curves.parentElement !== this.place) this.place.replaceChildren(this.space.box, this.curves, this.figures);
    const path = tca?.path ?? [];
    this.free.show(path.map((one) => one.pinion_deg), path.length > 0 ? [{ label: "this pair of teeth", values: path.map((one) => one.error_urad), dash: [] }] : []);
    const angles = load?.angle_deg ?? [];
    const curve = (values, k) => values.slice(k * angles.length, (k + 1) * angles.length);
    // Only where it goes through as many positions of a pitch.
    const alike = pins.pinned.filter(({ answer }) => answer.load?.angle_deg.length === angles.length);
    const series = (key) => [
      ...(load?.torques_Nm ?? []).map((torque, k) => ({ label: `${short(torque)} N·m`, values: curve(load[key], k), dash: DASHES[k % DASHES.length] })),
      ...alike.map(({ name, answer }) => ({ label: name, values: answer.load[key].slice(-angles.length), colour: colour("--pinned"), dash: [3, 4], width: 2 })),
    ];
    this.error.show(angles, load ? [...series("te_um"), { label: "no load", values: load.unloaded_um, dash: [1, 3] }] : []);
    this.pressure.show(angles, load ? series("pressure_largest_MPa") : []);
    this.space.show(load?.in_space, angles.length);
    showColumnsTable(this.figures, columns, pins);
    if (lines) this.figures.append(element("details", {}, element("summary", {}, "As gearmesh tca prints it"), element("pre", {}, lines.join("\n"))));
  }
}

/** A gearbox: what its shafts, bearings and meshes carry at rest, and what became of the file. */
export function showImport(place, { import: found, refused, folder }) {
  const parts = [];
  if (refused) parts.push(element("p", { className: "note" }, refused));
  for (const warning of found.warnings) parts.push(element("p", { className: "note" }, warning));
  for (const scene of found.at_rest.scenes) {
    parts.push(element("h2", {}, scene.scene));
    parts.push(table(["shaft", "1/min", "N·m"], scene.shafts.map((one) => [one.name, short(one.speed_rpm), short(one.torque_Nm)])));
    parts.push(table(["bearing", "radial N", "axial N"], scene.bearings.map((one) => [one.name, short(one.force_radial_N), short(one.force_axial_N)])));
    parts.push(table(["mesh", "normal force N", "K_Hβ"], scene.meshes.map((one) => [one.name, short(one.normal_force_N), one.k_h_beta === null ? "" : short(one.k_h_beta)])));
  }
  for (const [title, key] of [["Taken", "taken"], ["Assumed", "assumed"], ["Not represented", "not_represented"]]) {
    const lines = found[key].map(({ subject, text, weight }) => element("li", {}, `${subject}: ${text} (${weight})`));
    parts.push(element("details", {}, element("summary", {}, `${title}: ${lines.length}`), element("ul", {}, ...lines)));
  }
  const scenes = found.scenes.map((name) => `gearmesh run ${folder}/${name} -o result.h5`);
  parts.push(element("pre", {}, [...scenes, "gearmesh studio result.h5"].join("\n")));
  place.replaceChildren(...parts);
}
