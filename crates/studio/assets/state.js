// What has been changed, and what it was before: undo, redo, and the part of the address behind #.

/** A change: `settings` by key, and keys that are taken away. */
export const none = () => ({ settings: {}, removed: [] });

const copy = (change) => JSON.parse(JSON.stringify(change));
const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

function read(hash) {
  try {
    const found = JSON.parse(decodeURIComponent(hash.slice(1)));
    const isTable = found !== null && typeof found.settings === "object" && Array.isArray(found.removed);
    return isTable ? { settings: { ...found.settings }, removed: found.removed.map(String) } : none();
  } catch {
    return none();
  }
}

export class State {
  #past = [];
  #future = [];
  #kept;

  /** `changed(change, event)` hears of every change. */
  constructor(changed) {
    this.changed = changed;
    this.change = read(location.hash);
    this.#kept = copy(this.change);
    // Another address of the same page: one that was shared.
    addEventListener("hashchange", () => {
      const found = read(location.hash);
      if (!same(found, this.change)) this.go(found);
    });
  }

  get isChanged() {
    return Object.keys(this.change.settings).length + this.change.removed.length > 0;
  }

  get canUndo() {
    return this.#past.length > 0;
  }

  get canRedo() {
    return this.#future.length > 0;
  }

  /** Sets keys while a slider moves; `keep` once it is let go. */
  set(settings, event) {
    for (const [key, value] of Object.entries(settings)) {
      this.change.settings[key] = value;
      this.change.removed = this.change.removed.filter((one) => one !== key);
    }
    this.#tell(event);
  }

  /** Takes keys back to what the file states, or away where `away` holds. */
  clear(keys, away, event) {
    for (const key of keys) {
      delete this.change.settings[key];
      this.change.removed = this.change.removed.filter((one) => one !== key);
      if (away(key)) this.change.removed.push(key);
    }
    this.#tell(event);
    this.keep();
  }

  /** A step that undo goes back to. */
  keep() {
    if (same(this.#kept, this.change)) return;
    this.#past.push(this.#kept);
    this.#future = [];
    this.#kept = copy(this.change);
    this.#write();
    this.changed(this.change);
  }

  /** Another state as a step. */
  go(change, event) {
    this.change = copy(change);
    this.#tell(event);
    this.keep();
  }

  undo() {
    this.#step(this.#past, this.#future);
  }

  redo() {
    this.#step(this.#future, this.#past);
  }

  #step(from, to) {
    if (from.length === 0) return;
    to.push(this.#kept);
    this.#kept = from.pop();
    this.change = copy(this.#kept);
    this.#write();
    this.#tell();
  }

  #write() {
    const text = this.isChanged ? `#${encodeURIComponent(JSON.stringify(this.change))}` : "";
    history.replaceState(null, "", location.pathname + location.search + text);
  }

  #tell(event) {
    this.changed(this.change, event ?? performance.now());
  }
}
