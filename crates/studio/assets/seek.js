// An optimisation: which keys are varied, what is to be small, the front that is found, a click takes a point over.

import { number, short, ticks } from "./drawing.js";
import { element } from "./dom.js";
import { Job } from "./job.js";
import { byId, fail, say } from "./said.js";

const SVG = "http://www.w3.org/2000/svg";
/** Size of the picture of the front [px of the picture]. */
const [WIDE, HIGH, LEFT, BELOW] = [520, 300, 70, 46];

function drawn(tag, attributes, text = "") {
  const made = document.createElementNS(SVG, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  made.textContent = text;
  return made;
}

export class Seeker {
  #variables = [];

  /** `state`: the changes of the pair. */
  constructor(fields, columns, state) {
    this.state = state;
    this.columns = columns;
    this.job = new Job((words) => {
      say(`optimising: ${words}`);
      byId("stop").hidden = false;
    });
    const suited = fields.filter(({ key, kind, reach }) => key.includes(".microgeometry.") && kind === "number" && reach && key.endsWith("_um"));
    const rows = suited.map((field) => this.#variable(field));
    this.objectives = [this.#objective("te_peak_to_peak_um", false), this.#objective("pressure_largest_MPa", true)];
    this.trials = element("input", { type: "number", min: 20, max: 5000, step: 10, value: 60 });
    this.button = element("button", { type: "button", id: "seek-start" }, "Start");
    this.button.addEventListener("click", () => this.#start());
    const legend = (text) => element("p", { className: "legend" }, text);
    byId("seek-form").append(
      legend("Vary"), ...rows,
      legend("Make small"), ...this.objectives.map(({ row }) => row),
      element("label", { className: "row" }, "trials of each search ", this.trials), this.button);
  }

  #variable(field) {
    const chosen = element("input", { type: "checkbox", checked: /^gear_[12]\.microgeometry\.tip_relief_um$/.test(field.key) });
    const gear = field.key[5];
    const name = `${field.label}, gear ${gear}`;
    const [from, to] = field.reach.map((value, k) => element("input", { type: "number", step: "any", value, ariaLabel: `${name}, ${k === 0 ? "from" : "to"}` }));
    this.#variables.push({ key: field.key, chosen, from, to });
    return element("div", { className: "row" }, element("label", {}, chosen, ` ${name} `, element("span", { className: "unit" }, field.unit)), from, "to", to);
  }

  #objective(chosen, isOptional) {
    const none = isOptional ? [new Option("nothing more", "")] : [];
    const options = this.columns.map(({ name, label, unit }) => new Option(unit ? `${label} ${unit}` : label, name, false, name === chosen));
    const column = element("select", { ariaLabel: "Objective" });
    column.append(...none, ...options);
    column.value = chosen;
    const torque = element("select", { ariaLabel: "At torque" });
    return { column, torque, row: element("div", { className: "row" }, column, "at", torque) };
  }

  /** The torques of the last answer. */
  show({ torques_Nm }) {
    const list = String(torques_Nm);
    if (this.list === list) return;
    this.list = list;
    for (const { torque } of this.objectives) {
      torque.replaceChildren(new Option("all, mean", ""), ...torques_Nm.map((load) => new Option(`${short(load)} N·m`, load)));
      torque.value = String(torques_Nm.at(-1));
    }
  }

  async #start() {
    const variables = this.#variables.filter(({ chosen }) => chosen.checked).map(({ key, from, to }) => ({ key, from: from.valueAsNumber, to: to.valueAsNumber }));
    const objectives = this.objectives.filter(({ column }) => column.value).map(({ column, torque }) => ({ column: column.value, torque_Nm: torque.value === "" ? null : Number(torque.value) }));
    const change = JSON.parse(JSON.stringify(this.state.change));
    this.button.disabled = true;
    try {
      const ended = await this.job.run("/api/pair/optimise", { change, variables, objectives, trials: this.trials.valueAsNumber });
      fail(null);
      if (ended) this.#front(ended.result, change);
    } catch (problem) {
      fail(problem);
    }
    say("");
    byId("stop").hidden = true;
    this.button.disabled = false;
  }

  /** The points that nothing beats in all objectives; of one objective the best. */
  #front({ figures, settings }, change) {
    const names = figures.objectives;
    const label = (name) => this.columns.reduce((text, column) => (text.startsWith(`${column.name} `) ? `${column.label} ${column.unit}${text.slice(column.name.length)}` : text), name);
    const take = ({ variables }) => this.state.go({ settings: { ...settings, ...variables }, removed: change.removed.filter((key) => !(key in settings)) }, performance.now());
    const heading = (name) => label(name).replace(/^gear_(.)\.microgeometry\.(.*)_um$/, (_, gear, key) => `${key.replaceAll("_", " ")} ${gear} µm`);
    const entries = ({ objectives, variables }) => [...Object.entries(objectives), ...Object.entries(variables)].map(([name, value]) => [heading(name), short(value)]);
    const words = (point) => entries(point).map((pair) => pair.join(": ")).join(", ");
    const rows = figures.front.map((point) => {
      const button = element("button", { type: "button", ariaLabel: `take over ${words(point)}` }, "take over");
      button.addEventListener("click", () => take(point));
      return element("tr", {}, ...entries(point).map(([, value]) => element("td", {}, value)), element("td", {}, button));
    });
    const titles = figures.front.slice(0, 1).flatMap(entries).map(([title]) => element("th", { scope: "col" }, title));
    const table = element("table", {}, element("thead", {}, element("tr", {}, ...titles, element("th"))), element("tbody", {}, ...rows));
    const picture = names.length > 1 ? [this.#picture(figures, names, take, words, label)] : [];
    const before = names.map((name, k) => `${label(name)} ${short(figures.as_it_is[k])}`).join(", ");
    byId("seek-front").replaceChildren(element("p", { className: "help" }, `${figures.tried} choices were tried. As it was: ${before}. A click takes a point over.`), ...picture, element("div", { className: "rows", tabIndex: 0 }, table));
  }

  #picture({ front, as_it_is }, names, take, words, label) {
    const svg = drawn("svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, role: "group", "aria-label": `Pareto front of ${names.join(" and ")}` });
    const all = [...front.map(({ objectives }) => names.map((name) => objectives[name])), as_it_is];
    const ends = [0, 1].map((k) => [Math.min(...all.map((one) => one[k])), Math.max(...all.map((one) => one[k]))]);
    const place = (values) => values.slice(0, 2).map((value, k) => {
      const share = (value - ends[k][0]) / (ends[k][1] - ends[k][0] || 1);
      return k === 0 ? LEFT + 14 + share * (WIDE - LEFT - 34) : HIGH - BELOW - 12 - share * (HIGH - BELOW - 30);
    });
    svg.append(drawn("path", { d: `M${LEFT} 10V${HIGH - BELOW}H${WIDE - 8}`, class: "axis" }));
    for (const [k, [low, high]] of ends.entries()) {
      for (const value of ticks(low, high, 4)) {
        const [x, y] = place(k === 0 ? [value, ends[1][0]] : [ends[0][0], value]);
        svg.append(k === 0 ? drawn("text", { x, y: HIGH - BELOW + 16, "text-anchor": "middle" }, number(value, 6)) : drawn("text", { x: LEFT - 6, y: y + 4, "text-anchor": "end" }, number(value, 6)));
      }
    }
    svg.append(drawn("text", { x: 0.5 * (LEFT + WIDE), y: HIGH - 6, "text-anchor": "middle" }, label(names[0])));
    svg.append(drawn("text", { x: 14, y: 0.5 * (HIGH - BELOW), "text-anchor": "middle", transform: `rotate(-90 14 ${0.5 * (HIGH - BELOW)})` }, label(names[1])));
    const [bx, by] = place(as_it_is);
    svg.append(drawn("rect", { x: bx - 5, y: by - 5, width: 10, height: 10, class: "before" }));
    for (const point of front) {
      const [cx, cy] = place(names.map((name) => point.objectives[name]));
      const dot = drawn("circle", { cx, cy, r: 5, class: "point", tabindex: 0, role: "button", "aria-label": words(point) });
      dot.append(drawn("title", {}, words(point)));
      dot.addEventListener("click", () => take(point));
      dot.addEventListener("keydown", (event) => event.key === "Enter" && take(point));
      svg.append(dot);
    }
    return svg;
  }
}
