// Curves over the driver angle and beside them, drawn by uPlot. All charts over the driver angle share one cursor.

import { DASHES, axis, colour, curveColour, legendForKeyboard, lineAt, short, wideAs } from "./drawing.js";

const KEY = "angle";

/** One chart; drawn anew only where its curves are others, else it gets new numbers. */
export class Chart {
  #plot = null;
  #shape = "";

  /** `moved(place)` hears of the cursor; `linked`: charts of one key share it. */
  constructor(place, { title, x, y, height = 190, moved = null, linked = moved && KEY, bars = false, zoomed = null }) {
    Object.assign(this, { title, x, y, height, moved, linked, bars, zoomed });
    this.figure = document.createElement("figure");
    const caption = document.createElement("figcaption");
    this.unit = document.createElement("span");
    this.unit.className = "unit";
    caption.append(title, " ", this.unit);
    this.box = document.createElement("div");
    this.box.role = "img";
    this.figure.append(caption, this.box);
    place.append(this.figure);
    new ResizeObserver(() => this.#fit()).observe(this.box);
    this.box.addEventListener("dblclick", () => this.zoomed?.(null));
  }

  #fit() {
    const width = this.box.clientWidth;
    if (this.#plot && width > 0 && Math.abs(this.#plot.width - width) > 1) this.#plot.setSize({ width, height: this.height });
  }

  /** `series`: {label, values, colour, dash, width}. */
  show(x, series, unit = this.y) {
    this.figure.hidden = series.length === 0;
    this.unit.textContent = unit;
    if (series.length === 0) return;
    this.first = x[1] - x[0];
    this.box.ariaLabel = `${this.title}: ${series.map((one) => one.label).join(", ")}`;
    const data = [x, ...series.map((one) => one.values)];
    const shape = JSON.stringify([series.map(({ label, colour, dash }) => [label, colour, dash]), unit, document.documentElement.dataset.theme]);
    if (this.#plot && shape === this.#shape) {
      this.#plot.setData(data);
      return;
    }
    this.#shape = shape;
    this.#plot?.destroy();
    this.#plot = new uPlot(this.#options(series), data, this.box);
    legendForKeyboard(this.#plot);
  }

  #options(series) {
    const drawn = series.map((one, k) => ({
      label: one.label,
      stroke: one.colour ?? curveColour(k),
      dash: one.dash ?? [],
      width: one.width ?? 1.6,
      points: { show: false },
      spanGaps: one.spanGaps ?? false,
      value: (_, value) => short(value),
      ...(this.bars ? { paths: uPlot.paths.bars({ size: [0.8 / series.length, 14] }), fill: one.colour ?? curveColour(k) } : {}),
    }));
    const cursor = { drag: { x: this.zoomed !== null, y: false, setScale: false }, points: { size: 7 } };
    if (this.linked) Object.assign(cursor, { y: false, sync: { key: this.linked, setSeries: false } });
    return {
      width: Math.max(this.box.clientWidth, 200),
      height: this.height,
      // Bars at both ends are whole.
      scales: { x: this.bars ? { time: false, range: (_, low, high) => [low - 0.5 * (this.first ?? 0), high + 0.5 * (this.first ?? 0)] } : { time: false } },
      axes: [axis("", "", { size: 32 }), axis("", "", { size: wideAs(50) })],
      series: [{ label: this.x, value: (_, value) => short(value) }, ...drawn],
      cursor,
      hooks: {
        // Only the chart under the pointer speaks; the others follow it.
        setCursor: [(plot) => this.moved && plot.cursor.event && plot.cursor.idx !== null && this.moved(plot.cursor.idx)],
        setSelect: [(plot) => this.zoomed && plot.select.width > 4 && this.zoomed([plot.posToVal(plot.select.left, "x"), plot.posToVal(plot.select.left + plot.select.width, "x")])],
        draw: [(plot) => this.#mark(plot)],
      },
    };
  }

  /** A line where the gears stand. */
  markAt(x) {
    this.mark = x;
    this.#plot?.redraw(false);
  }

  #mark(plot) {
    if (this.mark !== undefined && this.linked) lineAt(plot, this.mark);
  }
}

/** Share of each pair of teeth in the load of a torque, pair by pair: [{pair, values}]; null where it does not touch. */
export function loadShares(answer, torque) {
  const positions = answer.angle_deg.length;
  const { slots, slices } = answer;
  const shares = new Map();
  for (let angle = 0; angle < positions; angle++) {
    let all = 0;
    const own = new Map();
    for (let slot = 0; slot < answer.pair_count[angle]; slot++) {
      const from = ((torque * positions + angle) * slots + slot) * slices;
      let sum = 0;
      for (let slice = 0; slice < slices; slice++) sum += answer.force_N[from + slice];
      const pair = answer.pair[angle * slots + slot];
      own.set(pair, (own.get(pair) ?? 0) + sum);
      all += sum;
    }
    for (const [pair, sum] of own) {
      if (!shares.has(pair)) shares.set(pair, Array(positions).fill(null));
      shares.get(pair)[angle] = all > 0 ? sum / all : null;
    }
  }
  const carrying = [...shares].filter(([, values]) => values.some((share) => share > 0));
  return carrying.sort((a, b) => a[0] - b[0]).map(([pair, values]) => ({ pair, values }));
}

/** Line load over the face at a position: [{label, z, values}] line by line [N/mm]. */
export function lineLoads(answer, torque, angle) {
  const positions = answer.angle_deg.length;
  const { slots, slices } = answer;
  const lines = [];
  for (let slot = 0; slot < answer.pair_count[angle]; slot++) {
    const z = [];
    const values = [];
    for (let slice = 0; slice < slices; slice++) {
      const at = (angle * slots + slot) * slices + slice;
      const width = answer.width_mm[at];
      if (width <= 0) continue;
      z.push(answer.z_mm[at]);
      values.push(answer.force_N[torque * positions * slots * slices + at] / width);
    }
    if (values.some((value) => value > 0)) lines.push({ label: `pair ${answer.pair[angle * slots + slot]}`, z, values });
  }
  return lines;
}

/** Curves over one abscissa, with gaps where one has no value unless it spans them. Several values at one place stay. */
export function joined(lines) {
  // A place counts as often as the curve that has it most often.
  const counts = new Map();
  for (const { z } of lines) {
    const own = new Map();
    for (const place of z) own.set(place, (own.get(place) ?? 0) + 1);
    for (const [place, count] of own) counts.set(place, Math.max(counts.get(place) ?? 0, count));
  }
  const places = [...counts.keys()].sort((a, b) => a - b);
  const all = [];
  const at = new Map();
  for (const place of places) {
    at.set(place, all.length);
    for (let k = 0; k < counts.get(place); k++) all.push(place);
  }
  const series = lines.map(({ label, z, values, colour, dash, spanGaps }, k) => {
    const own = Array(all.length).fill(null);
    const used = new Map();
    z.forEach((place, j) => {
      const nth = used.get(place) ?? 0;
      used.set(place, nth + 1);
      own[at.get(place) + nth] = values[j];
    });
    return { label, values: own, colour, dash: dash ?? DASHES[k % DASHES.length], spanGaps };
  });
  return [all, series];
}

/** All curves of a pair. */
export class PairCurves {
  constructor(place, moved) {
    const over = (title, y) => new Chart(place, { title, x: "driver angle °", y, moved });
    this.te = over("Transmission error", "µm");
    this.stiffness = over("Mesh stiffness, tangent", "N/(mm·µm)");
    this.share = over("Load sharing", "share of each pair of teeth");
    this.load = new Chart(place, { title: "Line load over the face", x: "z mm", y: "N/mm at the position shown", height: 160 });
    this.strain = over("Root strain, method 2", "µε");
    this.spectrum = new Chart(place, { title: "Order spectrum of the transmission error", x: "order", y: "µm", bars: true, height: 170 });
  }

  /** `pinned`: {name, answer} whose curves are drawn beside. */
  show(answer, torque, pinned) {
    const x = answer.angle_deg;
    const part = (values, k) => values.slice(k * x.length, (k + 1) * x.length);
    const of = (key) => {
      const series = answer.torques_Nm.map((load, k) => ({
        label: `${short(load)} N·m`,
        values: part(answer[key], k),
        dash: DASHES[k % DASHES.length],
        width: k === torque ? 2.6 : 1.3,
      }));
      for (const { name, answer: other } of pinned) {
        // Only where it goes through the same positions.
        if (other.angle_deg.length !== x.length || torque >= other.torques_Nm.length) continue;
        series.push({ label: name, values: part(other[key], torque), colour: colour("--pinned"), dash: [3, 4], width: 2 });
      }
      return series;
    };
    this.te.show(x, of("te_um"));
    this.stiffness.show(x, of("tangent_N_per_mm_um"));
    const shares = loadShares(answer, torque).slice(0, 6);
    this.share.show(x, shares.map(({ pair, values }, k) => ({ label: `pair ${pair}`, values, dash: DASHES[k % DASHES.length] })), `share of each pair of teeth at ${short(answer.torques_Nm[torque])} N·m`);
    const strain = answer.strain.map(({ gear, name, method_2_ustrain }, k) => ({ label: `gear ${gear} ${name}`, values: part(method_2_ustrain, torque), dash: DASHES[k % DASHES.length] }));
    this.strain.show(x, strain, `µε at ${short(answer.torques_Nm[torque])} N·m`);
    const lines = answer.orders.length;
    this.spectrum.show(answer.orders, [{ label: `${short(answer.torques_Nm[torque])} N·m`, values: answer.amplitudes_um.slice(torque * lines, (torque + 1) * lines) }]);
  }

  /** Follows the position. */
  at(answer, torque, angle) {
    for (const chart of [this.te, this.stiffness, this.share, this.strain]) chart.markAt(answer.angle_deg[angle]);
    const [z, series] = joined(lineLoads(answer, torque, angle));
    this.load.show(z, series);
  }
}
