// Two columns against each other, as an orbit: one scale for both where they have one unit.

import { colour, frame } from "./drawing.js";
import { element } from "./dom.js";

/** Height of the picture [px]. */
const HIGH = 420;

export class Orbit {
  constructor(place) {
    this.caption = element("figcaption");
    this.canvas = element("canvas", { role: "img", ariaLabel: "Two columns against each other" });
    this.canvas.style.cssText = `width: 100%; height: ${HIGH}px; display: block`;
    this.figure = element("figure", {}, this.caption, this.canvas);
    place.append(this.figure);
  }

  show([xs, ys], [across, up]) {
    this.caption.textContent = `${up.label} ${up.unit} over ${across.label} ${across.unit}`;
    const [width, scale] = [this.canvas.clientWidth, devicePixelRatio];
    [this.canvas.width, this.canvas.height] = [width * scale, HIGH * scale];
    const context = this.canvas.getContext("2d");
    context.scale(scale, scale);
    const box = { left: 70, right: width - 12, top: 10, bottom: HIGH - 36 };
    const ends = [xs, ys].map((values) => values.reduce(([low, high], value) => [Math.min(low, value), Math.max(high, value)], [Infinity, -Infinity]));
    const spans = ends.map(([low, high]) => high - low || 1);
    const per = [(box.right - box.left) / spans[0], (box.bottom - box.top) / spans[1]];
    if (across.unit === up.unit) per.fill(Math.min(...per));
    const middle = ends.map(([low, high]) => 0.5 * (low + high));
    const at = (x, y) => [0.5 * (box.left + box.right) + (x - middle[0]) * per[0], 0.5 * (box.top + box.bottom) - (y - middle[1]) * per[1]];
    const end = (k, pixels) => middle[k] + pixels / per[k];
    const [halfWide, halfHigh] = [0.5 * (box.right - box.left), 0.5 * (box.bottom - box.top)];
    const side = (k, half, { label, unit }) => ({ low: end(k, -half), high: end(k, half), name: `${label} ${unit}` });
    frame(context, box, side(0, halfWide, across), side(1, halfHigh, up));
    context.strokeStyle = colour("--c0");
    context.beginPath();
    xs.forEach((x, k) => context[k === 0 ? "moveTo" : "lineTo"](...at(x, ys[k])));
    context.stroke();
  }
}
