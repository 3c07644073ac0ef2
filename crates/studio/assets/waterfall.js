// Waterfall of a column: amplitudes over frequency and time in colour, with the orders of a shaft drawn.

import { ask } from "./server.js";
import { colour, short } from "./curves.js";
import { element } from "./dom.js";
import { pressureColour } from "./flank.js";
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
      context.fillStyle = `rgb(${pressureColour(share).map(Math.round).join(" ")})`;
      context.fillRect(box.left + (at % lines) * wide, y(Math.floor(at / lines)), wide + 0.6, tall + 0.6);
    });
    const wanted = this.shaft.value ? this.orders.value.split(/[\s,;]+/).map(Number).filter((order) => order > 0) : [];
    context.font = "11px system-ui, sans-serif";
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
    context.fillStyle = colour("--faint");
    context.textAlign = "center";
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const x = box.left + share * (box.right - box.left);
      context.fillText(short(share * lines * line_Hz), Math.min(Math.max(x, box.left + 8), box.right - 16), box.bottom + 15);
    }
    context.fillText("frequency Hz", 0.5 * (box.left + box.right), box.bottom + 30);
    context.textAlign = "right";
    context.fillText(`${short(time_s[0])} s`, box.left - 5, box.bottom);
    context.fillText(`${short(time_s.at(-1))} s`, box.left - 5, box.top + 10);
  }
}
