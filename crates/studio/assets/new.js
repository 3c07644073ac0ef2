// Something new: its files as fields and as text, both ways, looked at while one types.

import { ask } from "./server.js";
import { Form } from "./form.js";
import { Job } from "./job.js";
import { element } from "./dom.js";
import { byId, fail, say } from "./said.js";
import { Bevel, showColumnsTable, showImport } from "./outcome.js";
import { Pins } from "./variants.js";

/** Milliseconds without a change after which files are looked at. */
const PAUSE = 60;

/** One text of a kind: what the form sets is set in it, what is typed in it is read by the form. */
class Texts {
  constructor(kind, changed) {
    this.kind = kind;
    this.changed = changed;
    this.files = new Map(kind.files.map((file) => [file.name, { ...file }]));
    this.name = kind.files[0].name;
    // What the form asks of a state.
    this.change = { settings: {}, removed: [] };
  }

  get file() {
    return this.files.get(this.name);
  }

  get body() {
    return { kind: this.kind.name, files: Object.fromEntries([...this.files].map(([name, { text }]) => [name, text])) };
  }

  set(settings) {
    this.#edit({ settings });
  }

  clear(keys) {
    this.#edit({ removed: keys });
  }

  keep() {}

  /** A text that was typed. */
  type(text) {
    this.file.text = text;
    this.#edit({});
  }

  async #edit(edit) {
    const { name, file } = this;
    if (file.fields === null) return this.changed(name);
    const own = (file.edit = (file.edit ?? 0) + 1);
    try {
      const { text, fields } = await ask("/api/new/edit", { kind: this.kind.name, name, text: file.text, ...edit });
      // What was typed since then is newer.
      if (file.edit === own) Object.assign(file, { text, fields });
    } catch (problem) {
      fail(problem);
    }
    this.changed(name);
  }
}

/** The files of an address that was shared; null where it has none of a kind that can be begun. */
function shared(kinds) {
  try {
    const { kind, files } = JSON.parse(decodeURIComponent(location.hash.slice(1)));
    const isText = (file) => typeof files[file.name] === "string";
    return kinds.find(({ name }) => name === kind)?.files.every(isText) ? { kind, files } : null;
  } catch {
    return null;
  }
}

export async function showNew() {
  const { kinds, folder, begun } = await ask("/api/new");
  byId("begin").hidden = false;
  byId("tools").hidden = true;
  byId("file").textContent = "Something new";
  byId("where").textContent = `Files are written into a new folder in ${folder}.`;
  let [texts, form, shown, looking, bevel, found] = [null, null, null, null, null, null];
  const take = ({ kind, files }) => {
    const own = kinds.find(({ name }) => name === kind);
    if (texts?.kind !== own) begin(own, false);
    const { name } = texts;
    // Fields as the texts have them.
    for (const file of texts.files.values()) {
      texts.name = file.name;
      texts.type(files[file.name] ?? file.text);
    }
    texts.name = name;
  };
  const pins = new Pins({ go: take, changed: () => found && bevel?.show(found, pins) });
  const looks = [];
  const opened = new Map();
  globalThis.gearmeshLooks = looks;
  const job = new Job((words) => {
    say(words);
    byId("stop").hidden = false;
  });

  function draw() {
    const { file } = texts;
    if (shown !== texts.name) {
      byId("begin-form").replaceChildren();
      form = file.fields?.length ? new Form(byId("begin-form"), file.fields, texts, opened) : null;
      if (!form) byId("begin-form").append(element("p", { className: "help" }, "This file is changed as text."));
      shown = texts.name;
    } else form?.restate(file.fields);
    if (byId("text").value !== file.text) byId("text").value = file.text;
    for (const tab of byId("tabs").children) tab.ariaSelected = String(tab.textContent === texts.name);
  }

  async function look() {
    try {
      const begun = performance.now();
      const body = texts.body;
      found = await ask("/api/new", body);
      found.body = body;
      const { warnings, columns } = found;
      fail(null);
      byId("run").disabled = false;
      say(warnings.length > 0 ? warnings.join("  ") : "Nothing is wrong with these files.");
      if (texts.kind.name === "bevel-pair") (bevel ??= new Bevel(byId("outcome"))).show(found, pins);
      else if (columns) showColumnsTable(byId("outcome"), columns);
      // For the bench: until the browser has painted it.
      requestAnimationFrame(() => setTimeout(() => looks.push(performance.now() - begun)));
    } catch (problem) {
      if (problem.kind === "overtaken") return;
      byId("run").disabled = true;
      say("");
      fail(problem);
    }
  }

  function changed() {
    draw();
    history.replaceState(null, "", `${location.pathname}${location.search}#${encodeURIComponent(JSON.stringify(texts.body))}`);
    clearTimeout(looking);
    looking = setTimeout(look, PAUSE);
  }

  /** `look`: at the files as they are; without, something is changed in them next. */
  function begin(kind, look = true) {
    texts = new Texts(kind, changed);
    [shown, bevel, found] = [null, null, null];
    byId("pin-new").hidden = kind.name !== "bevel-pair";
    byId("outcome").replaceChildren();
    byId("begun").hidden = false;
    byId("run").hidden = kind.name === "bearing";
    byId("where").hidden = kind.name === "bearing";
    for (const card of byId("kinds").children) card.classList.toggle("chosen", card.dataset.kind === kind.name);
    byId("tabs").replaceChildren(...kind.files.map(({ name }) => {
      const tab = element("button", { type: "button", role: "tab" }, name);
      tab.addEventListener("click", () => {
        texts.name = name;
        draw();
      });
      return tab;
    }));
    if (look) changed();
    else draw();
  }

  async function work(path, body, show) {
    byId("run").disabled = true;
    try {
      const ended = await job.run(path, body);
      if (ended) show(ended.result);
      fail(null);
    } catch (problem) {
      fail(problem);
    }
    byId("stop").hidden = true;
    byId("run").disabled = false;
  }

  const cards = kinds.map((kind) => {
    const card = element("button", { type: "button" }, element("strong", {}, kind.title), element("span", {}, kind.about));
    card.dataset.kind = kind.name;
    card.addEventListener("click", () => begin(kind));
    return card;
  });
  const picked = element("input", { type: "file", accept: ".rexs,.rexsj,.rexsz", ariaLabel: "REXS file" });
  const drop = element("label", { className: "drop" }, element("strong", {}, "Gearbox"), element("span", {}, "Drop a REXS file here, or choose one: its scenes are checked and run at rest."), picked);
  drop.dataset.kind = "gearbox";
  const importFile = (file) => {
    if (!file) return;
    byId("begun").hidden = true;
    const show = (result) => {
      byId("begun").hidden = false;
      byId("begun").classList.add("alone");
      say(`The files of the gearbox are in ${result.folder}.`);
      showImport(byId("outcome"), result);
    };
    work(`/api/new/import/${encodeURIComponent(file.name)}`, file, show);
  };
  picked.addEventListener("change", () => importFile(picked.files[0]));
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("drop", (event) => {
    event.preventDefault();
    importFile(event.dataTransfer.files[0]);
  });
  byId("kinds").append(...cards, drop);
  byId("text").addEventListener("input", () => texts.type(byId("text").value));
  byId("stop").addEventListener("click", () => job.stop().catch(fail));
  byId("run").addEventListener("click", () =>
    work("/api/new/begin", texts.body, (result) => {
      // The pair is opened by the server; the page is that of the pair then.
      if (result.opens) {
        history.replaceState(null, "", location.pathname + location.search);
        location.reload();
      } else {
        say(`The files are in ${result.folder}.`);
        found = { ...result, body: texts.body };
        (bevel ??= new Bevel(byId("outcome"))).show(found, pins);
      }
    }));
  byId("pin-new").addEventListener("click", () => found && pins.pin(found.body, found));
  byId("share-new").addEventListener("click", async () => {
    await navigator.clipboard.writeText(location.href).catch(() => prompt("The address", location.href));
    say("The address of these files is copied. It works as long as this server runs; the part behind # works with any other one.");
  });
  addEventListener("hashchange", () => location.reload());
  for (const kind of kinds.filter(({ name }) => name === begun?.kind)) for (const file of kind.files) file.text = begun.files[file.name] ?? file.text;
  const first = shared(kinds) ?? begun;
  if (first) {
    take(first);
  } else say("Choose what to begin. Every field has a value that runs at once; the text beside the fields is the file itself.");
  return () => found && bevel?.show(found, pins);
}
