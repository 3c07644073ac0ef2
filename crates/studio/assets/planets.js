// How the planets of each set share the load, over the turn of the carrier: the sun meshes and the ring meshes.

import { ask } from "./server.js";
import { Chart } from "./curves.js";
import { DASHES, short } from "./drawing.js";
import { element } from "./dom.js";
import { fail } from "./said.js";

export class Planets {
  #number = 0;
  #charts = new Map();

  constructor(place) {
    this.figure = element("div");
    place.append(this.figure);
  }

  /** The newest that is asked for is drawn. */
  async show(range) {
    const own = ++this.#number;
    const isWanted = () => own === this.#number && this.figure.isConnected;
    try {
      const { sets } = await ask("/api/columns/planets", { from: range?.[0] ?? null, to: range?.[1] ?? null });
      if (!isWanted()) return;
      for (const set of sets) for (const [kind, told] of [["sun", "sun meshes"], ["ring", "ring meshes"]]) this.#draw(set, kind, told);
      fail(null);
    } catch (problem) {
      if (!isWanted()) return;
      if (problem.kind === "overtaken") return this.show(range);
      fail(problem);
    }
  }

  #draw({ name, planets, over, x, ...meshes }, kind, told) {
    const title = `${name}, ${told}`;
    if (!this.#charts.has(title)) this.#charts.set(title, new Chart(this.figure, { title, x: over, y: "", height: 260, linked: `planets of ${name}` }));
    const chart = this.#charts.get(title);
    const { curves, largest } = meshes[kind];
    chart.x = over;
    const series = (curves ?? []).map((values, k) => ({ label: planets[k], values, dash: DASHES[Math.floor(k / 8) % DASHES.length], spanGaps: true }));
    chart.show(x, series, `share of each planet over the ${over}; 1 where all carry the same, largest ${short(largest)}`);
  }
}
