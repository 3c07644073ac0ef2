// A folder whose scenes and results can be opened, and a multibody scene that is run here.

import { ask } from "./server.js";
import { Job } from "./job.js";
import { element } from "./dom.js";
import { byId, fail, say } from "./said.js";

function head(title, file) {
  byId("title").textContent = title;
  byId("file").textContent = file;
  document.title = `${title}, gearmesh studio`;
  byId("choice").hidden = false;
  byId("tools").hidden = true;
}

export async function showFolder() {
  const { folder, files } = await ask("/api/folder");
  head("gearmesh studio", folder);
  say("Choose what to open.");
  const card = ({ name, title, what }, number) => {
    const made = element("button", { type: "button" }, element("strong", {}, name), element("span", {}, title), element("span", {}, what));
    made.addEventListener("click", async () => {
      try {
        await ask("/api/folder", { number });
        location.reload();
      } catch (problem) {
        fail(problem);
      }
    });
    return made;
  };
  byId("choices").replaceChildren(...files.map(card));
}

export async function showScene() {
  const { title, file, run, result } = await ask("/api/scene");
  head(title, file);
  const job = new Job((words) => {
    say(words);
    byId("stop").hidden = false;
  });
  const button = element("button", { type: "button", id: "run-scene" }, element("strong", {}, "Run"), element("span", {}, `run.kind = "${run}"; the result is written to ${result}, then it opens here.`));
  button.addEventListener("click", async () => {
    button.disabled = true;
    try {
      if (await job.run("/api/scene", {})) location.reload();
      fail(null);
    } catch (problem) {
      fail(problem);
    }
    byId("stop").hidden = true;
    button.disabled = false;
  });
  byId("stop").addEventListener("click", () => job.stop().catch(fail));
  byId("choices").replaceChildren(button);
}
