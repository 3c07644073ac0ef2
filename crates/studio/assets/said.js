// What the page says: how far it is, and what is wrong.

export const byId = (id) => document.getElementById(id);

export function say(text) {
  byId("status").textContent = text;
}

/** `null`: nothing is wrong any more. */
export function fail(problem) {
  byId("problem").hidden = problem === null;
  byId("problem").textContent = problem?.message ?? "";
}
