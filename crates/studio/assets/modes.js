// Natural modes: a table of frequencies, and the machine as the chosen mode moves it.

import { ask } from "./server.js";
import { short } from "./drawing.js";
import { element } from "./dom.js";
import { Mechanism } from "./mechanism.js";
import { byId, fail } from "./said.js";

/** Milliseconds from one picture to the next. */
const PACE = 45;

export async function showModes() {
  const machine = await ask("/api/modes");
  byId("title").textContent = machine.title;
  byId("file").textContent = "natural modes";
  document.title = `${machine.title}, gearmesh studio`;
  byId("modes").hidden = false;
  byId("tools").hidden = true;
  const mechanism = new Mechanism(byId("vibrating"));
  let [point, chosen, frames, now, timer] = [0, null, [], 0, null];

  const step = (number) => {
    if (frames.length === 0) return;
    now = number % frames.length;
    mechanism.at(now);
  };
  const play = (on) => {
    clearInterval(timer);
    timer = on ? setInterval(() => step(now + 1), PACE) : null;
    byId("vibrate").textContent = on ? "Pause" : "Play";
    byId("vibrate").ariaPressed = String(on);
  };
  byId("vibrate").addEventListener("click", () => play(timer === null));

  async function choose(mode) {
    chosen = mode;
    for (const row of byId("mode-rows").children) row.ariaSelected = String(Number(row.dataset.mode) === mode);
    try {
      const found = await ask("/api/modes", { point, mode });
      if (chosen !== mode) return;
      const isFirst = frames.length === 0;
      frames = found.frames;
      mechanism.moved(machine, frames, isFirst);
      const own = machine.points[point].modes[mode];
      byId("mode-told").textContent = `mode ${mode + 1}, ${own.frequency_Hz === null ? "dies out without vibrating" : `${short(own.frequency_Hz)} Hz`}: ${own.moves}`;
      fail(null);
      step(0);
    } catch (problem) {
      fail(problem);
    }
  }

  function list() {
    const row = (mode, number) => {
      const frequency = mode.frequency_Hz === null ? "-" : mode.frequency_Hz.toFixed(2);
      const damping = mode.damping_ratio === null ? `${short(1e3 * mode.decay_s)} ms to 1/e` : (100 * mode.damping_ratio).toFixed(3).replace(/^-(0\.0+)$/, "$1");
      const button = element("button", { type: "button", textContent: String(number + 1), title: "Show how it moves" });
      const cells = [element("td", {}, button), ...[frequency, damping, mode.moves].map((textContent) => element("td", { textContent }))];
      const made = element("tr", {}, ...cells);
      made.dataset.mode = number;
      made.addEventListener("click", () => choose(number));
      return made;
    };
    byId("mode-rows").replaceChildren(...machine.points[point].modes.map(row));
  }

  const named = ({ load_factor, speed_rpm }) => `load factor ${short(load_factor)}${speed_rpm === null ? "" : `, ${short(speed_rpm)} 1/min`}`;
  byId("mode-point").replaceChildren(...machine.points.map((one, value) => element("option", { value, textContent: named(one) })));
  byId("mode-point").addEventListener("change", () => {
    point = Number(byId("mode-point").value);
    list();
    choose(Math.min(chosen, machine.points[point].modes.length - 1));
  });
  list();
  const first = machine.points[0].modes.findIndex((mode) => mode.frequency_Hz > 1e-3);
  await choose(Math.max(first, 0));
  play(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  return () => mechanism.restyle();
}
