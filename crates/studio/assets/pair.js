// The page of a pair: what belongs together hears of each other here.

import { Calculator, ask, askText } from "./server.js";
import { State, none } from "./state.js";
import { Form } from "./form.js";
import { PairCurves } from "./curves.js";
import { short } from "./drawing.js";
import { FlankMap } from "./flank.js";
import { Scene3d, endOfScale, showScale } from "./scene3d.js";
import { Variants } from "./variants.js";
import { Job } from "./job.js";
import { Seeker } from "./seek.js";
import { byId, fail, say } from "./said.js";

/** Milliseconds after which the progress of a calculation is shown. */
const SLOW = 600;

// For the tests and the bench: the last answer, and when what happened.
const seen = (globalThis.gearmeshStudio = { answer: null, times: [] });

export async function showPair() {
  const description = await ask("/api/pair");
  byId("title").textContent = description.title;
  byId("file").textContent = description.file;
  byId("file").title = description.file;
  document.title = `${description.title}, gearmesh studio`;
  byId("pair").hidden = byId("intro").hidden = false;

  let [answer, torque, angle, playing, most] = [null, null, 0, null, 1];
  let [scene, models] = [null, null];
  try {
    scene = new Scene3d(byId("scene"), description.gears);
  } catch (error) {
    // Without WebGL everything else works.
    byId("scene").replaceWith(Object.assign(document.createElement("p"), { className: "help", textContent: `The gears are not drawn: ${error.message}` }));
  }
  const flank = new FlankMap(byId("flank"), description.gears[0]);
  const curves = new PairCurves(byId("curves"), (place) => toPosition(place));
  const variants = new Variants(byId("figures"), { go: (change) => state.go(change), changed: () => answer && draw() });

  function mark(place) {
    angle = Math.min(place, answer.angle_deg.length - 1);
    byId("position").value = angle;
    byId("angle").textContent = `${short(answer.angle_deg[angle])}°`;
    flank.show(answer, torque, angle, most);
    curves.at(answer, torque, angle);
  }

  function toPosition(place) {
    if (!answer) return;
    mark(place);
    scene?.at(angle);
  }

  function draw() {
    torque = Math.min(torque ?? answer.torques_Nm.length - 1, answer.torques_Nm.length - 1);
    most = endOfScale(answer);
    const options = answer.torques_Nm.map((load, k) => new Option(`${short(load)} N·m`, k, false, k === torque));
    byId("torque").replaceChildren(...options);
    byId("position").max = answer.angle_deg.length - 1;
    curves.show(answer, torque, variants.pinned);
    variants.show(answer, torque);
    seeker.show(answer);
    showScale(byId("scale"), most);
    mark(angle);
    scene?.follow(answer, torque, most, angle);
    const notes = [...answer.figures.warnings, ...answer.figures.ratings.map((rated) => rated.problem).filter(Boolean)];
    byId("notes").replaceChildren(...notes.map((text) => Object.assign(document.createElement("p"), { textContent: text })));
  }

  /** Other gears than those that are drawn: their shapes, and the ranges of their keys. */
  async function showGears(change) {
    const { fields, gears } = await ask("/api/pair/gears", change);
    form.update(fields);
    scene?.replace(gears);
    flank.gear = gears[0];
    draw();
  }

  const job = new Job((words) => {
    say(`the changed gear is reduced: ${words}`);
    byId("stop").hidden = false;
  });

  /** Bodies have changed: the old curves stay, greyed, until the gears are reduced. */
  async function reduce(change) {
    byId("pair").classList.add("stale");
    try {
      if (await job.run("/api/pair/reduce", change)) calculator.want(state.change);
    } catch (problem) {
      ended();
      say("");
      fail(problem);
    }
  }

  let watching = null;
  const ended = () => {
    clearInterval(watching);
    byId("stop").hidden = true;
  };
  const calculator = new Calculator("/api/pair", {
    begun: () => {
      clearInterval(watching);
      const start = performance.now();
      watching = setInterval(async () => {
        if (!calculator.isBusy) return clearInterval(watching);
        if (performance.now() - start < SLOW) return;
        byId("pair").classList.add("stale");
        const { solved } = await ask("/api/progress").catch(() => ({ solved: 0 }));
        if (!calculator.isBusy) return;
        say(`${solved} positions solved`);
        byId("stop").hidden = false;
      }, 200);
    },
    answered: (found, change, times) => {
      ended();
      job.leave().catch(fail);
      byId("pair").classList.remove("stale");
      answer = found;
      fail(null);
      draw();
      if (models !== null && models !== String(answer.models)) showGears(change).catch(fail);
      models = String(answer.models);
      const drawn = performance.now();
      seen.answer = answer;
      // The next picture of the screen has it.
      requestAnimationFrame(() => {
        setTimeout(() => {
          const painted = performance.now();
          seen.times.push({ ...times, drawn, painted, server: answer.seconds[0] + answer.seconds[1] });
          if (seen.times.length > 1000) seen.times.shift();
          say(`${answer.angle_deg.length * answer.torques_Nm.length} positions in ${(1e3 * (answer.seconds[0] + answer.seconds[1])).toFixed(0)} ms; ${answer.figures.means}`);
        });
      });
    },
    failed: (problem, change) => {
      if (problem.kind === "unreduced") {
        fail(null);
        reduce(change);
        return;
      }
      ended();
      job.leave().catch(fail);
      byId("pair").classList.add("stale");
      say("");
      fail(problem);
    },
  });

  const buttons = () => {
    byId("undo").disabled = !state.canUndo;
    byId("redo").disabled = !state.canRedo;
    byId("reset").disabled = !state.isChanged;
  };
  let form = null;
  const state = new State((change, event) => {
    form?.show();
    buttons();
    if (event !== undefined) calculator.want(change, event);
  });
  form = new Form(byId("form"), description.fields, state);
  const seeker = new Seeker(description.fields, description.columns, state);

  byId("undo").addEventListener("click", () => state.undo());
  byId("redo").addEventListener("click", () => state.redo());
  byId("reset").addEventListener("click", () => state.go(none()));
  byId("pin").addEventListener("click", () => answer && variants.pin(state.change, answer));
  byId("share").addEventListener("click", async () => {
    await navigator.clipboard.writeText(location.href).catch(() => prompt("The address", location.href));
    say("The address of this state is copied. It works as long as this server runs; the part behind # works with any other one of this pair.");
  });
  byId("save").addEventListener("click", async () => {
    try {
      const text = await askText("/api/pair/toml", state.change);
      const link = document.createElement("a");
      link.href = URL.createObjectURL(new Blob([text], { type: "application/toml" }));
      link.download = `${description.file.split(/[\\/]/).pop().replace(/\.(toml|h5)$/, "")}_changed.toml`;
      link.click();
      URL.revokeObjectURL(link.href);
    } catch (problem) {
      fail(problem);
    }
  });
  byId("torque").addEventListener("change", () => {
    torque = Number(byId("torque").value);
    draw();
  });
  byId("position").addEventListener("input", () => toPosition(Number(byId("position").value)));
  byId("view-pair").addEventListener("click", () => scene?.look("pair"));
  byId("view-mesh").addEventListener("click", () => scene?.look("mesh"));
  byId("see-through").addEventListener("change", () => scene?.seeThrough(byId("see-through").checked));
  byId("play").addEventListener("click", () => {
    clearInterval(playing);
    playing = playing === null ? setInterval(() => answer && toPosition((angle + 1) % answer.angle_deg.length), 90) : null;
    byId("play").textContent = playing === null ? "Play" : "Pause";
    byId("play").ariaPressed = String(playing !== null);
  });
  addEventListener("keydown", (event) => {
    const isText = event.target.matches?.("input[type=text], input[type=number], input[type=search]");
    if ((event.ctrlKey || event.metaKey) && !isText && "zy".includes(event.key.toLowerCase())) {
      event.preventDefault();
      if (event.key.toLowerCase() === "y" || event.shiftKey) state.redo();
      else state.undo();
    } else if (event.key === "Escape" && (calculator.isBusy || job.isRunning || seeker.job.isRunning)) byId("stop").click();
    else if (event.key.toLowerCase() === "p" && !isText && !event.ctrlKey && !event.metaKey) byId("pin").click();
  });
  byId("stop").addEventListener("click", () => (job.isRunning || seeker.job.isRunning ? job.stop() : ask("/api/stop", {})).catch(fail));
  calculator.want(state.change);
  buttons();
  return () => {
    scene?.restyle();
    if (answer) draw();
  };
}
