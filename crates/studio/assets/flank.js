// Pressure over the flank of gear 1.

import { colour, frame, mapCss as css } from "./drawing.js";

export class FlankMap {
  constructor(canvas, gear) {
    Object.assign(this, { canvas, gear });
    new ResizeObserver(() => this.#draw()).observe(canvas);
  }

  show(answer, torque, angle, most) {
    Object.assign(this, { answer, torque, angle, most });
    this.#draw();
  }

  #draw() {
    const { canvas, answer, gear } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight];
    if (!answer || width === 0) return;
    const scale = devicePixelRatio;
    [canvas.width, canvas.height] = [width * scale, height * scale];
    const context = canvas.getContext("2d");
    context.scale(scale, scale);
    const box = { left: 56, top: 6, right: width - 8, bottom: height - 32 };
    const [low, high] = [gear.form_diameter_mm, gear.tip_diameter_mm];
    const half = 0.5 * gear.face_width_mm;
    const x = (z) => box.left + ((z + half) / (2 * half)) * (box.right - box.left);
    const y = (diameter) => box.bottom - ((diameter - low) / (high - low)) * (box.bottom - box.top);
    context.fillStyle = colour("--panel");
    context.fillRect(box.left, box.top, box.right - box.left, box.bottom - box.top);
    const { slots, slices } = answer;
    const positions = answer.angle_deg.length;
    const block = slots * slices;
    // Each place in the colour of its largest pressure: the highest are drawn last.
    const patches = [];
    for (let at = 0; at < positions * block; at++) {
      const pressure = answer.pressure_MPa[this.torque * positions * block + at];
      if (pressure > 0) patches.push([pressure, at]);
    }
    patches.sort((a, b) => a[0] - b[0]);
    const tall = Math.max(2, (2.2 * (box.bottom - box.top)) / (positions / Math.max(1, Math.round((answer.angle_deg.at(-1) - answer.angle_deg[0]) / answer.pitch_deg)) * Math.max(1, answer.contact_ratio)));
    const rectangle = (at) => {
      const [left, right] = [x(answer.z_mm[at] - 0.5 * answer.width_mm[at]), x(answer.z_mm[at] + 0.5 * answer.width_mm[at])];
      return [left, y(answer.diameter_mm[at]) - 0.5 * tall, right - left, tall];
    };
    for (const [pressure, at] of patches) {
      context.fillStyle = css(pressure / this.most);
      context.fillRect(...rectangle(at));
    }
    context.strokeStyle = colour("--ink");
    context.lineWidth = 1.2;
    for (let at = this.angle * block; at < (this.angle + 1) * block; at++) {
      if (answer.pressure_MPa[this.torque * positions * block + at] > 0) context.strokeRect(...rectangle(at));
    }
    frame(context, box, { low: -half, high: half, name: "z mm, from mid-face" }, { low, high, name: "diameter mm" });
  }
}
