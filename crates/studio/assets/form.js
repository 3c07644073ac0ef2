// The keys of the scene as fields and sliders. Everything about a key comes from the server.

import { element } from "./dom.js";

/** Groups in this order, the first ones open. */
const ORDER = ["run", "pair", "gear_1.microgeometry", "gear_2.microgeometry", "gear_1_body.tooth", "gear_1_body.blank", "gear_2_body.tooth", "gear_2_body.blank", "mesh.teeth.friction", "mesh.model", "mesh.teeth"];
const OPEN = 3;
/** Width of a window in which all are closed [px]. */
const NARROW = 760;

const words = (path) => path.split(".").map((part) => part.replaceAll("_", " ")).join(", ");
const kindOf = (field) => (typeof field.kind === "string" ? field.kind : Object.keys(field.kind)[0]);
const parts = (text) => text.split(/[\s,;]+/).filter((part) => part !== "").map(Number);

/** Step of a slider: a thousandth of its way, as a round number. */
function step([low, high]) {
  const exact = (high - low) / 600;
  return 10 ** Math.round(Math.log10(exact));
}

export class Form {
  #fields = new Map();
  #rows = new Map();
  #groups = new Map();

  /** `opened`: groups that were opened or closed in the forms before this one, which stay so. */
  constructor(place, fields, state, opened = new Map()) {
    this.place = place;
    this.state = state;
    place.addEventListener("submit", (event) => event.preventDefault());
    for (const field of fields) this.#fields.set(field.key, field);
    const groups = Map.groupBy(fields, (field) => field.group);
    const rank = (group) => (ORDER.indexOf(group) + 1 || ORDER.length + 1);
    const names = [...groups.keys()].sort((a, b) => rank(a) - rank(b) || a.localeCompare(b));
    names.forEach((name, number) => {
      const count = element("span", { className: "count" });
      const title = element("summary", {}, words(name), " ", count);
      const group = element("details", { open: opened.get(name) ?? (number < OPEN && innerWidth > NARROW) }, title);
      title.addEventListener("click", () => opened.set(name, !group.open));
      for (const field of groups.get(name)) group.append(this.#row(field));
      this.#groups.set(name, count);
      place.append(group);
    });
    this.show();
  }

  /** The value that holds now: changed, stated, or none. */
  value(key) {
    const { settings, removed } = this.state.change;
    if (key in settings) return settings[key];
    return removed.includes(key) ? null : (this.#fields.get(key).stated ?? null);
  }

  /** Other gears suit other values: what is set with a key, and where its slider goes. */
  update(fields) {
    for (const { key, with: others, reach } of fields) {
      const field = this.#fields.get(key);
      const { slider } = this.#rows.get(key) ?? {};
      if (!field) continue;
      Object.assign(field, { with: others, reach });
      if (slider && reach) Object.assign(slider, { min: reach[0], max: reach[1] });
    }
    this.show();
  }

  /** What the file states now. */
  restate(fields) {
    for (const { key, stated } of fields ?? []) {
      const field = this.#fields.get(key);
      if (field) field.stated = stated;
    }
    this.show();
  }

  /** Brings all fields to the state. */
  show() {
    const { settings, removed } = this.state.change;
    const counts = new Map();
    for (const [key, row] of this.#rows) {
      const isChanged = key in settings || removed.includes(key);
      const field = this.#fields.get(key);
      row.place.classList.toggle("changed", isChanged);
      row.place.classList.toggle("given", isChanged || (this.value(key) !== null && !field.needed && !field.reduces));
      row.clear.title = key in settings ? "Back to the file" : "Take it away";
      row.show(this.value(key));
      if (isChanged) counts.set(field.group, (counts.get(field.group) ?? 0) + 1);
    }
    for (const [group, count] of this.#groups) {
      count.textContent = counts.has(group) ? `${counts.get(group)} changed` : "";
    }
  }

  #set(field, value, isKept) {
    const settings = { [field.key]: value };
    // What the key needs beside it, where nothing states it.
    for (const [key, suited] of Object.entries(field.with)) {
      if (this.#fields.has(key) && this.value(key) === null) settings[key] = suited;
    }
    this.state.set(settings, performance.now());
    if (isKept) this.state.keep();
  }

  #clear(field) {
    // Keys that mean nothing without this one: its shape, its start.
    const stem = field.key.replace(/_(um|mm)$/, "");
    const others = [...this.#fields.keys()].filter((key) => key in field.with || (field.key.endsWith("_um") && key.startsWith(`${stem}_`)));
    const isSet = field.reduces || field.key in this.state.change.settings;
    const tables = field.group.endsWith("friction") ? [...this.#fields.keys()].filter((key) => key.startsWith(`${field.group}.`)) : [];
    const keys = [...new Set([field.key, ...others, ...tables])];
    this.state.clear(keys, (key) => !isSet && (this.#fields.get(key).stated ?? null) !== null, performance.now());
  }

  #row(field) {
    const id = `field-${field.key.replaceAll(".", "-")}`;
    const label = element("label", { htmlFor: id }, field.label, " ", element("span", { className: "unit" }, field.unit));
    const clear = element("button", { type: "button", className: "clear", ariaLabel: `Clear ${field.label}` }, "×");
    const place = element("div", { className: "field", title: field.key }, element("div", { className: "head" }, label, clear));
    place.dataset.key = field.key;
    const make = { number: this.#number, whole: this.#number, word: this.#word, numbers: this.#numbers, counts: this.#numbers, names: this.#names, pitch_errors: this.#pitch };
    const show = make[kindOf(field)].call(this, field, id, place);
    const slider = kindOf(field) === "numbers" ? null : place.querySelector("input[type=range]");
    if (field.help) place.append(element("p", { className: "help" }, field.help));
    clear.addEventListener("click", () => this.#clear(field));
    this.#rows.set(field.key, { place, clear, show, slider });
    return place;
  }

  /** A number and its slider. `read` and `write` where it is one of several. */
  #pairOfInputs(field, id, name, write) {
    const [least, largest] = field.allowed;
    const number = element("input", { type: "number", id, step: "any", min: least ?? "", max: largest ?? "", ariaLabel: name });
    const row = element("div", { className: "row" }, number);
    let slider = null;
    if (field.reach) {
      const by = ["whole", "counts"].includes(kindOf(field)) ? 1 : step(field.reach);
      slider = element("input", { type: "range", min: field.reach[0], max: field.reach[1], step: by, ariaLabel: `${name}, slider` });
      if (field.reduces) {
        // A gear is reduced for one value, not for all on the way to it.
        slider.addEventListener("input", () => (number.value = slider.value));
        slider.addEventListener("change", () => write(slider.valueAsNumber, true));
      } else {
        slider.addEventListener("input", () => write(slider.valueAsNumber, false));
        slider.addEventListener("change", () => this.state.keep());
      }
      row.append(slider);
    }
    number.addEventListener("change", () => {
      if (!Number.isNaN(number.valueAsNumber)) write(number.valueAsNumber, true);
      else if (!field.needed) this.#clear(field);
      else this.show();
    });
    const show = (value) => {
      if (document.activeElement !== number || number.valueAsNumber !== value) number.value = value ?? "";
      if (slider && document.activeElement !== slider) slider.value = value ?? Math.max(0, field.reach[0]);
    };
    return { row, show };
  }

  #number(field, id, place) {
    const { row, show } = this.#pairOfInputs(field, id, field.label, (value, isKept) => this.#set(field, value, isKept));
    place.append(row);
    return show;
  }

  #numbers(field, id, place) {
    const text = element("input", { type: "text", id, inputMode: "decimal", spellcheck: false });
    const sliders = element("div");
    place.append(element("div", { className: "row" }, text), sliders);
    text.addEventListener("change", () => {
      const list = parts(text.value);
      if (list.length > 0 && list.every(Number.isFinite)) this.#set(field, list, true);
      else this.show();
    });
    let shown = [];
    return (value) => {
      const list = value ?? [];
      if (document.activeElement !== text) text.value = list.join(", ");
      if (shown.length !== list.length) {
        shown = list.map((_, place) => {
          const write = (one, isKept) => this.#set(field, this.value(field.key).map((old, k) => (k === place ? one : old)), isKept);
          return this.#pairOfInputs(field, `${id}-${place}`, `${field.label} ${place + 1}`, write);
        });
        sliders.replaceChildren(...shown.map((one) => one.row));
      }
      shown.forEach((one, place) => one.show(list[place]));
    };
  }

  #word(field, id, place) {
    const options = field.kind.word.map(({ word, help }) => element("option", { value: word, title: help }, word));
    const blank = field.needed ? [] : [element("option", { value: "" }, "not stated")];
    const select = element("select", { id }, ...blank, ...options);
    select.addEventListener("change", () => (select.value ? this.#set(field, select.value, true) : this.#clear(field)));
    place.append(element("div", { className: "row" }, select));
    return (value) => (select.value = value ?? "");
  }

  #names(field, id, place) {
    const boxes = field.kind.names.map((name) => {
      const box = element("input", { type: "checkbox", value: name });
      box.addEventListener("change", () => this.#set(field, boxes.filter((one) => one.checked).map((one) => one.value), true));
      place.append(element("label", { className: "row" }, box, name));
      return box;
    });
    place.querySelector("label").htmlFor = "";
    if (boxes.length === 0) place.append(element("p", { className: "help" }, "The model has none."));
    return (value) => boxes.forEach((box) => (box.checked = (value ?? []).includes(box.value)));
  }

  /** One number a tooth; with fewer the rest are zero. */
  #pitch(field, id, place) {
    const teeth = field.kind.pitch_errors;
    const text = element("input", { type: "text", id, spellcheck: false, placeholder: `up to ${teeth} numbers` });
    place.append(element("div", { className: "row" }, text));
    text.addEventListener("change", () => {
      const list = parts(text.value);
      if (list.length === 0) this.#clear(field);
      else if (list.every(Number.isFinite)) this.#set(field, list.concat(Array(Math.max(0, teeth - list.length)).fill(0)), true);
      else this.show();
    });
    return (value) => {
      if (document.activeElement !== text) text.value = (value ?? []).join(", ").replace(/(, 0)+$/, "");
    };
  }
}
