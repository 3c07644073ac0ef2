// Work that takes longer than a slider's move: how far it is, and what it came to.

import { Problem, ask } from "./server.js";

/** Milliseconds between two looks. */
const LOOK = 250;

/** How far work is, in words. */
export function words({ title, stage, done, seconds }) {
  const share = done && done[1] > 0 ? `${Math.round((100 * done[0]) / done[1])} %` : "";
  const parts = [title, stage, share].filter(Boolean);
  return `${parts.length > 0 ? parts.join(", ") : "begins"} (${(seconds ?? 0).toFixed(0)} s)`;
}

/** Follows the work of the server. `told(words)` hears how far it is. */
export class Job {
  #number = null;

  constructor(told) {
    this.told = told;
  }

  get isRunning() {
    return this.#number !== null;
  }

  /** Begins work; what it came to, or null where other work, or leave(), has taken its place. */
  async run(path, body) {
    let progress = await ask(path, body);
    const own = (this.#number = progress.number);
    while (progress.running && this.#number === own) {
      this.told(words(progress));
      await new Promise((later) => setTimeout(later, LOOK));
      progress = await ask("/api/job");
    }
    if (this.#number !== own || progress.number !== own) return null;
    this.#number = null;
    if (progress.problem) throw new Problem(progress.problem.kind, progress.problem.error);
    return progress;
  }

  /** Tells the work to stop; run() hears of it. */
  stop() {
    return ask("/api/job/stop", {});
  }

  /** Nobody waits for it any more. */
  async leave() {
    if (!this.isRunning) return;
    this.#number = null;
    await this.stop();
  }
}
