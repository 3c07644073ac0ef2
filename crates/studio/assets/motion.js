// The gears, shafts and bearings of a multibody result in three dimensions, moment by moment, with the forces on the
// teeth as arrows.

import { short } from "./drawing.js";
import { Job } from "./job.js";
import { Mechanism } from "./mechanism.js";
import { byId, fail, say } from "./said.js";

/** Milliseconds from one moment to the next. */
const PACE = 60;

export class Motion {
  #mechanism = null;
  #playing = null;
  #frames = [];

  /** `stretch()`: the stretch that the curves show; `moved(at)` hears of the moment. */
  constructor(stretch, moved) {
    this.stretch = stretch;
    this.moved = moved;
    this.job = new Job((words) => say(`the gears are read: ${words}`));
    byId("motion").addEventListener("toggle", () => byId("motion").open && this.#frames.length === 0 && this.#read());
    byId("stretch").addEventListener("click", () => this.#read());
    byId("moment").addEventListener("input", () => this.#at(Number(byId("moment").value)));
    byId("moving-play").addEventListener("click", () => this.#play());
  }

  restyle() {
    this.#mechanism?.restyle();
  }

  async #read() {
    const [from, to] = this.stretch() ?? [null, null];
    try {
      const ended = await this.job.run("/api/columns/moments", { from, to });
      say("");
      fail(null);
      if (!ended) return;
      this.#mechanism ??= new Mechanism(byId("moving"));
      this.#frames = ended.result.frames;
      this.unit = ended.result.unit;
      this.#mechanism.show(ended.result);
      byId("moment").max = this.#frames.length - 1;
      byId("moment").parentElement.hidden = this.#frames.length === 1;
      const { most, mostLoaded } = this.#mechanism;
      const told = [most > 0 ? `longest arrow ${short(most)} N` : "no forces on teeth", mostLoaded > 0 ? `full colour of a ball or roller ${short(mostLoaded)} N` : ""];
      byId("force-scale").textContent = told.filter(Boolean).join("; ");
      this.#at(0);
    } catch (problem) {
      fail(problem);
    }
  }

  #at(number) {
    if (!this.#frames[number]) return;
    byId("moment").value = number;
    const { at } = this.#frames[number];
    byId("moment-at").textContent = this.unit === "s" ? `${short(at)} s` : `equilibrium ${short(at)}`;
    this.#mechanism.at(number);
    this.moved(at);
  }

  #play() {
    clearInterval(this.#playing);
    const next = () => this.#at((Number(byId("moment").value) + 1) % this.#frames.length);
    this.#playing = this.#playing === null && this.#frames.length > 1 ? setInterval(next, PACE) : null;
    byId("moving-play").textContent = this.#playing === null ? "Play" : "Pause";
    byId("moving-play").ariaPressed = String(this.#playing !== null);
  }
}
