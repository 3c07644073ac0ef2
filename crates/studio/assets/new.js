// Something new: its files as fields and as text, both ways, looked at while one types.

import { ask } from "./server.js";
import { Form } from "./form.js";
import { Job } from "./job.js";
import { element } from "./dom.js";
import { byId, fail, say } from "./said.js";
import { Bevel, showColumnsTable, showImport } from "./outcome.js";

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

export async function showNew() {
  const { kinds, folder, begun } = await ask("/api/new");
  byId("begin").hidden = false;
  byId("tools").hidden = true;
  byId("file").textContent = "Something new";
  byId("where").textContent = `Files are written into a new folder in ${folder}.`;
  let [texts, form, shown, looking, bevel] = [null, null, null, null, null];
  const looks = [];
  globalThis.gearmeshLooks = looks;
  const job = new Job((words) => {
    say(words);
    byId("stop").hidden = false;
  });

  function draw() {
    const { file } = texts;
    if (shown !== texts.name) {
      byId("begin-form").replaceChildren();
      form = file.fields?.length ? new Form(byId("begin-form"), file.fields, texts) : null;
      if (!form) byId("begin-form").append(element("p", { className: "help" }, "This file is changed as text."));
      shown = texts.name;
    } else form?.restate(file.fields);
    if (byId("text").value !== file.text) byId("text").value = file.text;
    for (const tab of byId("tabs").children) tab.ariaSelected = String(tab.textContent === texts.name);
  }

  async function look() {
    try {
      const begun = performance.now();
      const found = await ask("/api/new", texts.body);
      const { warnings, columns } = found;
      fail(null);
      byId("run").disabled = false;
      say(warnings.length > 0 ? warnings.join("  ") : "Nothing is wrong with these files.");
      if (texts.kind.name === "bevel-pair") (bevel ??= new Bevel(byId("outcome"))).show(found);
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
    clearTimeout(looking);
    looking = setTimeout(look, PAUSE);
  }

  /** `look`: at the files as they are; without, something is changed in them next. */
  function begin(kind, look = true) {
    texts = new Texts(kind, changed);
    [shown, bevel] = [null, null];
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
      if (result.opens) location.reload();
      else {
        say(`The files are in ${result.folder}.`);
        (bevel ??= new Bevel(byId("outcome"))).show(result);
      }
    }));
  if (begun) {
    const kind = kinds.find(({ name }) => name === begun.kind);
    for (const file of kind.files) file.text = begun.files[file.name] ?? file.text;
    begin(kind, false);
    // Fields as the text has them.
    texts.type(texts.file.text);
  } else say("Choose what to begin. Every field has a value that runs at once; the text beside the fields is the file itself.");
}
