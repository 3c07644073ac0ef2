// A bevel pair in space, with what presses on the pinion's flank, and a slider over its positions.

import { element } from "./dom.js";
import { short } from "./drawing.js";
import { Scene3d, endOfScale, showScale, unpacked } from "./scene3d.js";

export class BevelSpace {
  #scene = null;
  #shape = "";
  #gears = [];
  #at = 0;

  /** `moved(place)` hears of the position. */
  constructor(moved) {
    this.moved = moved;
    const button = (text, look) => element("button", { type: "button", onclick: () => this.#scene?.look(look) }, text);
    this.through = element("input", { type: "checkbox", checked: true, onchange: () => this.#scene?.seeThrough(this.through.checked) });
    this.canvas = element("canvas", { tabIndex: 0, role: "img", ariaLabel: "Both gears in three dimensions; arrow keys turn the view, plus and minus zoom" });
    this.scale = element("div", { className: "scale" });
    this.slider = element("input", { type: "range", min: 0, ariaLabel: "pinion angle", oninput: () => this.at(Number(this.slider.value)) });
    this.angle = element("output");
    this.torque = element("select", { ariaLabel: "torque", onchange: () => this.#draw() });
    const over = element("div", { className: "over" }, button("Pair", "pair"), button("Mesh", "mesh"), element("label", {}, this.through, " gear see-through"));
    this.box = element("div", {}, element("figure", { className: "scene" }, this.canvas, over, this.scale),
      element("div", { className: "position" }, element("span", {}, "pinion angle"), this.slider, this.angle, this.torque));
  }

  /** What a pair comes to, of so many positions; null where it has no load. */
  show(packed, positions) {
    this.box.hidden = !packed;
    if (!packed) return;
    this.answer = unpacked(packed);
    const shape = JSON.stringify(packed.gears);
    if (shape !== this.#shape) this.#gears = this.answer.gears;
    try {
      this.#scene ??= new Scene3d(this.canvas, this.#gears);
    } catch (problem) {
      // Without WebGL everything else works.
      this.canvas.replaceWith(element("p", { className: "help" }, `The gears are not drawn: ${problem.message}`));
    }
    this.#shape = shape;
    this.slider.max = Math.min(positions, this.answer.angle_deg.length) - 1;
    const chosen = this.torque.options.length === packed.torques_Nm.length ? this.torque.selectedIndex : packed.torques_Nm.length - 1;
    this.torque.replaceChildren(...packed.torques_Nm.map((load, k) => new Option(`${short(load)} N·m`, k, false, k === chosen)));
    this.#draw();
  }

  #draw() {
    const most = endOfScale(this.answer);
    showScale(this.scale, most);
    this.#mark(this.#at);
    this.#scene?.follow(this.answer, Number(this.torque.value), most, this.#at, this.#gears);
  }

  /** Turns the gears to a position. */
  at(place) {
    if (!this.answer) return;
    this.#mark(place);
    this.#scene?.at(this.#at);
  }

  #mark(place) {
    this.#at = Math.min(place, Number(this.slider.max));
    this.slider.value = this.#at;
    const angle = this.answer.angle_deg[this.#at];
    this.angle.textContent = `${short(angle)}°`;
    this.moved(angle);
  }
}
