// The table of figures, and states that are kept beside the present one.

import { short } from "./drawing.js";
import { element } from "./dom.js";

function difference(percent) {
  const amount = Math.abs(percent).toFixed(1);
  const sign = amount === "0.0" ? "±" : percent > 0 ? "+" : "−";
  return `${sign}${amount} %`;
}

/** A kept value in the unit that is shown, and how far the present one is from it. */
export function comparedCell(now, other, factor = 1) {
  const cell = element("td", {}, other === undefined ? "" : short(other * factor));
  if (other) cell.append(element("span", { className: "difference" }, difference((100 * (now - other)) / Math.abs(other))));
  return cell;
}

/** States that are kept to compare with. */
export class Pins {
  #pinned = [];
  #count = 0;

  /** `go(change)` brings a kept state back; `changed()` hears that others are kept. */
  constructor({ go, changed }) {
    Object.assign(this, { go, changed });
  }

  get pinned() {
    return this.#pinned;
  }

  pin(change, answer) {
    this.#count += 1;
    this.#pinned.push({ name: `pin ${this.#count}`, change: JSON.parse(JSON.stringify(change)), answer });
    if (this.#pinned.length > 4) this.#pinned.shift();
    this.changed();
  }

  head(pin) {
    const go = element("button", { type: "button", title: "Go back to this state" }, "go");
    const drop = element("button", { type: "button", ariaLabel: `Drop ${pin.name}` }, "×");
    go.addEventListener("click", () => this.go(pin.change));
    drop.addEventListener("click", () => {
      this.#pinned = this.#pinned.filter((one) => one !== pin);
      this.changed();
    });
    return element("th", { scope: "col" }, pin.name, element("span", { className: "actions" }, go, drop));
  }
}

/** Those of a pair, in the table of its figures. */
export class Variants extends Pins {
  constructor(place, heard) {
    super(heard);
    this.place = place;
  }

  /** One torque: the present state and those that are kept, with differences. */
  show(answer, torque) {
    const load = answer.torques_Nm[torque];
    const now = answer.figures.rows[torque];
    const head = element("tr", {}, element("th", { scope: "col" }, `At ${short(load)} N·m`), element("th", { scope: "col" }, "unit"), element("th", { scope: "col" }, "now"));
    head.append(...this.pinned.map((pin) => this.head(pin)));
    const body = element("tbody");
    for (const { words, unit, name: key, factor } of answer.figures.columns) {
      const data = element("data", { value: String(now[key]) }, short(now[key] * factor));
      data.dataset.figure = key;
      const row = element("tr", {}, element("th", { scope: "row" }, words.replace("K_Hbeta", "K_Hβ")), element("td", {}, unit), element("td", {}, data));
      row.append(...this.pinned.map((pin) => comparedCell(now[key], pin.answer.figures.rows[torque]?.[key], factor)));
      body.append(row);
    }
    this.place.replaceChildren(element("table", {}, element("thead", {}, head), body));
  }
}
