// Pressure over the flank of gear 1, and the colours of pressure.

import { colour, short } from "./curves.js";

/** Colours that rise in lightness alone and are told apart with every kind of colour blindness (cividis: Nunez, Anderton, Renslow, PLoS ONE 13 (2018) e0199239). */
const CIVIDIS = ["#00224e", "#123570", "#3b496c", "#575d6d", "#707173", "#8a8678", "#a59c74", "#c3b369", "#e1cc55", "#fee838"];
const RGB = CIVIDIS.map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));

/** Red, green, blue from 0 to 255 at a share. */
export function pressureColour(share) {
  const place = Math.min(Math.max(share, 0), 1) * (RGB.length - 1);
  const first = Math.min(Math.floor(place), RGB.length - 2);
  return RGB[first].map((low, k) => low + (place - first) * (RGB[first + 1][k] - low));
}

const css = (share) => `rgb(${pressureColour(share).map(Math.round).join(" ")})`;

/** The pressure at the end of the scale: nineteen twentieths of the loaded places are below. Tip edges press far more than the flank and would leave it one colour. */
export function endOfScale(answer) {
  const loaded = answer.pressure_MPa.filter((value) => value > 0).sort((a, b) => a - b);
  return loaded.length > 0 ? loaded[Math.floor(0.95 * (loaded.length - 1))] : 1;
}

/** The bar beside the gears. */
export function showScale(place, most) {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [160, 10];
  const context = canvas.getContext("2d");
  for (let x = 0; x < 160; x++) {
    context.fillStyle = css(x / 159);
    context.fillRect(x, 0, 1, 10);
  }
  const ends = document.createElement("div");
  ends.className = "ends";
  for (const text of ["0", `${short(Math.round(most))} MPa and more`]) {
    const end = document.createElement("span");
    end.textContent = text;
    ends.append(end);
  }
  place.replaceChildren(canvas, ends);
}

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
    const box = { left: 48, top: 6, right: width - 8, bottom: height - 32 };
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
    context.fillStyle = colour("--faint");
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    for (const z of [-half, 0, half]) context.fillText(short(z), Math.min(Math.max(x(z), box.left + 10), box.right - 12), box.bottom + 13);
    context.fillText("z mm, from mid-face", 0.5 * (box.left + box.right), box.bottom + 27);
    context.textAlign = "right";
    for (const diameter of [low, 0.5 * (low + high), high]) context.fillText(short(Number(diameter.toFixed(1))), box.left - 5, y(diameter) + 4);
    context.save();
    context.translate(9, 0.5 * (box.top + box.bottom));
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("diameter mm", 0, 0);
    context.restore();
  }
}
