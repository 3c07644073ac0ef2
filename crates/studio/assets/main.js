// The page: which part of it is shown, and what all parts share.

import { Problem, ask } from "./server.js";
import { showPair } from "./pair.js";
import { showColumns } from "./columns.js";
import { showModes } from "./modes.js";
import { showFolder, showScene } from "./choice.js";
import { showNew } from "./new.js";
import { byId, fail, say } from "./said.js";

function useTheme(restyle) {
  const root = document.documentElement;
  const dark = matchMedia("(prefers-color-scheme: dark)");
  root.dataset.theme = localStorage.getItem("theme") ?? (dark.matches ? "dark" : "light");
  byId("theme").addEventListener("click", () => {
    root.dataset.theme = root.dataset.theme === "dark" ? "light" : "dark";
    localStorage.setItem("theme", root.dataset.theme);
    restyle();
  });
}

let restyle = () => {};
useTheme(() => restyle());
byId("quit").addEventListener("click", async () => {
  await ask("/api/quit", {}).catch(() => {});
  say("The server has ended. This page shows what it showed, and computes nothing any more.");
});
byId("new").addEventListener("click", async () => {
  await ask("/api/new/start", {}).catch(fail);
  location.hash = "";
  location.reload();
});
try {
  const { kind } = await ask("/api/session");
  const show = { pair: showPair, columns: showColumns, modes: showModes, scene: showScene, folder: showFolder, new: showNew };
  byId("new").hidden = kind === "new";
  restyle = (await show[kind]()) ?? restyle;
} catch (problem) {
  if (!(problem instanceof Problem)) throw problem;
  fail(problem);
}
