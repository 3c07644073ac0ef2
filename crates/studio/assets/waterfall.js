// Waterfall of a column: amplitudes over frequency and time in colour, with the orders of a shaft drawn.

import { ask } from "./server.js";
import { font, frame, mapCss, short } from "./drawing.js";
import { element } from "./dom.js";
import { fail } from "./said.js";

/** Height of the picture [px], and what lies below the largest amplitude in it [decades]. */
const [HIGH, DECADES] = [420, 4];

export class Waterfall {
  #number = 0;

  constructor(place, columns) {
    this.caption = element("figcaption");
    this.canvas = element("canvas", { role: "img", ariaLabel: "Amplitudes over frequency and time" });
    this.canvas.style.cssText = `width: 100%; height: ${HIGH}px; display: block`;
    const shafts = columns.filter(({ unit }) => unit === "rad/s");
    this.shaft = element("select", {}, new Option("no shaft", ""), ...shafts.map(({ name, label }) => new Option(label, name)));
    this.orders = element("input", { type: "text", size: 12, placeholder: "1, 23, 46" });
    const row = element("div", { className: "position" }, element("label", {}, "orders of ", this.shaft), element("label", {}, "orders ", this.orders));
    this.figure = element("figure", {}, this.caption, row, this.canvas);
    for (const one of [this.shaft, this.orders]) one.addEventListener("change", () => this.show(...this.last));
    place.append(this.figure);
  }

  /** The newest that is asked for is drawn; where there is none the picture is emptied. */
  async show(column, range) {
    this.last = [column, range];
    const own = ++this.#number;
    const isWanted = () => own === this.#number && this.figure.isConnected;
    try {
      const answer = await ask("/api/columns/waterfall", { column: column.name, speed: this.shaft.value || null, from: range?.[0] ?? null, to: range?.[1] ?? null });
      if (!isWanted()) return;
      this.#draw(answer, column);
      fail(null);
    } catch (problem) {
      if (!isWanted()) return;
      // Another figure, or another page of the same server, has asked since: once more.
      if (problem.kind === "overtaken") return this.show(column, range);
      this.caption.textContent = `${column.label}: no waterfall`;
      this.canvas.width = 0;
      fail(problem);
    }
  }

  #draw({ time_s, speed_Hz, lines, line_Hz, amplitudes }, column) {
    const most = amplitudes.reduce((a, b) => Math.max(a, b), 0);
    this.caption.textContent = `${column.label}, amplitude; largest ${short(most)} ${column.unit}, colours over ${DECADES} decades below`;
    const [width, scale] = [this.canvas.clientWidth, devicePixelRatio];
    [this.canvas.width, this.canvas.height] = [width * scale, HIGH * scale];
    const context = this.canvas.getContext("2d");
    context.scale(scale, scale);
    const box = { left: 62, right: width - 12, top: 8, bottom: HIGH - 36 };
    const wide = (box.right - box.left) / lines;
    const tall = (box.bottom - box.top) / time_s.length;
    const y = (row) => box.bottom - (row + 1) * tall;
    amplitudes.forEach((amplitude, at) => {
      const share = amplitude > 0 ? 1 + Math.log10(amplitude / most) / DECADES : 0;
      context.fillStyle = mapCss(share);
      context.fillRect(box.left + (at % lines) * wide, y(Math.floor(at / lines)), wide + 0.6, tall + 0.6);
    });
    const wanted = this.shaft.value ? this.orders.value.split(/[\s,;]+/).map(Number).filter((order) => order > 0) : [];
    context.font = font(11);
    context.lineWidth = 1.2;
    for (const order of wanted) {
      context.strokeStyle = context.fillStyle = "#ffffff";
      context.setLineDash([5, 4]);
      context.beginPath();
      speed_Hz.forEach((speed, row) => context[row === 0 ? "moveTo" : "lineTo"](Math.min(box.left + ((order * speed) / line_Hz) * wide, box.right), y(row) + 0.5 * tall));
      context.stroke();
      const top = box.left + ((order * speed_Hz.at(-1)) / line_Hz) * wide;
      if (top < box.right - 20) context.fillText(short(order), top + 4, box.top + 12);
    }
    context.setLineDash([]);
    frame(context, box, { low: 0, high: lines * line_Hz, name: "frequency Hz" }, { low: time_s[0], high: time_s.at(-1), name: "time s" });
  }
}
