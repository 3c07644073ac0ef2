// What all drawings share, those of reports and those of the studio: packed numbers, colours, numbers, axes, legends. A module for the
// studio; a report has it in one scope with its own script.

export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
export const curveColour = (k) => colour(`--c${k % 8}`);

/** Numbers of a kind of array from base64. */
export function unpack(text, Kind) {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return new Kind(bytes.buffer); // little-endian, as all browsers' machines are
}

const FAMILY = "system-ui, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
export const font = (size, weight = "") => `${weight} ${size}px ${FAMILY}`.trim();

/** Solid, dashed, dotted and more. */
export const DASHES = [[], [8, 4], [2, 3], [8, 3, 2, 3], [4, 4], [1, 3]];

/** Five digits, for fields and tables. */
export const short = (value) => (value === null || value === undefined || !Number.isFinite(value) ? "" : String(Number(value.toPrecision(5))));

/** Four significant digits, a real minus sign; a power of ten only where zeros would hide the number. */
export function number(v, digits = 4) {
  if (v == null || Number.isNaN(v)) return "–";
  if (v === 0) return "0";
  const size = Math.abs(v), sign = v < 0 ? "−" : "";
  if (size < 1e6 && size >= 1e-3) return sign + String(Number(size.toPrecision(digits)));
  const [m, n] = Number(size.toPrecision(digits)).toExponential().split("e");
  return sign + (m === "1" ? "" : `${m}·`) + `10${raised(Number(n))}`;
}

const raised = (n) => String(n).replace(/-/g, "⁻").replace(/\d/g, (digit) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[digit]);

/** A number of a logarithmic axis: 0.001 to 1000 in full, others as m × 10ⁿ. */
export function power(v) {
  const n = Math.floor(Math.log10(v) + 1e-9), m = Number((v / 10 ** n).toPrecision(3));
  if (n >= -3 && n <= 3) return number(v);
  return (m === 1 ? "" : `${m}·`) + `10${raised(n)}`;
}

export const withUnit = (label, unit) => (unit ? `${label} [${unit}]` : label);

/** Anchors of viridis (Smith and van der Walt, matplotlib, CC0): lightness alone rises, so that it is read without colour, too. */
const VIRIDIS = [[68, 1, 84], [72, 40, 120], [62, 74, 137], [49, 104, 142], [38, 130, 142], [31, 158, 137], [53, 183, 121], [109, 205, 89], [180, 222, 44], [253, 231, 37]];

/** Red, green, blue from 0 to 255 at a share of a map, linear between its anchors. */
export function mixed(map, share) {
  const t = Math.min(Math.max(share, 0), 1) * (map.length - 1), i = Math.min(Math.floor(t), map.length - 2), f = t - i;
  return map[i].map((c, k) => Math.round(c + f * (map[i + 1][k] - c)));
}
export const mapColour = (share) => mixed(VIRIDIS, share);
export const mapCss = (share) => `rgb(${mapColour(share).join(" ")})`;

/** Round steps between the ends of an axis, about so many. */
export function ticks(min, max, count = 6) {
  if (!(max > min)) return [min];
  const aim = (max - min) / count, power10 = 10 ** Math.floor(Math.log10(aim)), step = [1, 2, 5, 10].find((m) => m * power10 >= aim * 0.999) * power10;
  const all = [];
  for (let k = Math.ceil(min / step - 1e-9); k * step <= max + 1e-9 * step; k++) all.push(Number((k * step).toPrecision(12)));
  return all;
}

/** Powers of ten, of many every second or third; where the axis spans less than two, also 2 and 5 times them. */
export function logSplits(u, axisIndex, min, max) {
  const steps = max / min > 100 ? [1] : [1, 2, 5], splits = [];
  const room = Math.max(2, Math.floor(u.bbox.height / devicePixelRatio / 28)), every = Math.ceil(Math.log10(max / min) / room);
  for (let p = Math.floor(Math.log10(min)); p <= Math.ceil(Math.log10(max)); p++) if (p % every === 0) for (const m of steps) splits.push(m * 10 ** p);
  return splits.filter((v) => v >= min * 0.999 && v <= max * 1.001);
}
export const logAxis = { size: (...of) => wideAs(64)(...of), splits: logSplits, filter: (u, splits) => splits, values: (u, splits) => splits.map(power) };

/** An axis of uPlot; without a label only its numbers. */
export function axis(label, unit, more = {}) {
  const small = font(label ? 12 : 11);
  const named = label ? { label: withUnit(label, unit), labelFont: font(12, "600"), labelSize: 24, labelGap: 2 } : {};
  return {
    ...named, font: small, stroke: colour("--faint"), grid: { stroke: colour("--grid"), width: 1 }, ticks: { stroke: colour("--line"), width: 1, size: 6 },
    // A number for every line of the grid that has room.
    values: (u, splits) => splits.map((v) => (v == null ? "" : number(v, 6))), ...more,
  };
}

/** Width of an ordinate of uPlot: that of its longest number, with `least` at least. */
export const wideAs = (least) => (u, values, index, cycle) => {
  const own = u.axes[index];
  if (cycle > 1) return own._size;
  u.ctx.font = own.font[0];
  const longest = Math.max(0, ...(values ?? []).map((text) => u.ctx.measureText(text).width));
  return Math.max(least, Math.ceil(longest / devicePixelRatio + own.ticks.size + own.gap + 4));
};

/** A dashed line across a chart of uPlot. */
export function lineAt(plot, x) {
  const at = plot.valToPos(x, "x", true), { left, top, width, height } = plot.bbox, { ctx } = plot;
  if (!(at >= left && at <= left + width)) return;
  ctx.save();
  ctx.strokeStyle = colour("--faint");
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([3 * devicePixelRatio, 3 * devicePixelRatio]);
  ctx.beginPath(); ctx.moveTo(at, top); ctx.lineTo(at, top + height); ctx.stroke();
  ctx.restore();
}

/** Names in the legend of uPlot switch their curves with the keyboard, too. */
export function legendForKeyboard(plot) {
  plot.root.querySelectorAll(".u-legend .u-series").forEach((row, i) => {
    if (i === 0) return;
    const head = row.querySelector("th");
    head.tabIndex = 0;
    head.setAttribute("role", "switch");
    const state = () => head.setAttribute("aria-checked", String(plot.series[i].show));
    state();
    head.addEventListener("click", () => setTimeout(state));
    head.addEventListener("keydown", (e) => {
      if (e.key === "Enter" || e.key === " ") { e.preventDefault(); plot.setSeries(i, { show: !plot.series[i].show }); state(); }
    });
  });
}

/** The axes of a picture on a canvas: numbers at round steps, as many as have room, and names. `x`, `y`: {low, high, name}; y rises from low to high, where it may fall. */
export function frame(context, box, x, y) {
  const [wide, high] = [box.right - box.left, box.bottom - box.top];
  context.save();
  context.font = font(11);
  context.fillStyle = colour("--faint");
  context.strokeStyle = colour("--line");
  context.strokeRect(box.left, box.top, wide, high);
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  let free = 0;
  for (const value of ticks(x.low, x.high, Math.max(2, wide / 75))) {
    const at = box.left + ((value - x.low) / (x.high - x.low || 1)) * wide, text = number(value, 6), half = 0.5 * context.measureText(text).width;
    const middle = Math.min(Math.max(at, half), box.right + (box.margin ?? 10) - half);
    context.fillRect(at - 0.5, box.bottom, 1, 4);
    if (middle - half < free) continue;
    context.fillText(text, middle, box.bottom + 15);
    free = middle + half + 8;
  }
  context.fillText(x.name, box.left + 0.5 * wide, box.bottom + 29);
  context.textAlign = "right";
  context.textBaseline = "middle";
  for (const value of ticks(Math.min(y.low, y.high), Math.max(y.low, y.high), Math.max(2, high / 30))) {
    const at = box.bottom - ((value - y.low) / (y.high - y.low || 1)) * high;
    context.fillRect(box.left - 4, at - 0.5, 4, 1);
    context.fillText(number(value, 6), box.left - 7, at);
  }
  context.translate(9, box.top + 0.5 * high);
  context.rotate(-Math.PI / 2);
  context.textAlign = "center";
  context.fillText(y.name, 0, 0);
  context.restore();
}
