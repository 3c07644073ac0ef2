// Questions to the server, with the token of the address.

const token = new URLSearchParams(location.search).get("token") ?? "";

/** What the server says where it does not answer: `kind` is "input", "work", "overtaken", "stopped", "forbidden" or "absent". */
export class Problem extends Error {
  constructor(kind, message) {
    super(message);
    this.kind = kind;
  }
}

async function send(path, body) {
  const headers = { "X-Gearmesh-Token": token };
  const options = body instanceof Blob ? { method: "POST", body, headers } : body === undefined ? { headers } : { method: "POST", body: JSON.stringify(body), headers: { ...headers, "Content-Type": "application/json" } };
  let reply;
  try {
    reply = await fetch(path, options);
  } catch {
    throw new Problem("gone", "The server has ended. Start gearmesh studio again, and open the address that it prints.");
  }
  if (reply.ok) return reply;
  const said = await reply.json().catch(() => ({ kind: "work", error: reply.statusText }));
  throw new Problem(said.kind, said.error);
}

/** An answer in JSON. Without a body it is a question, with one an order. */
export const ask = async (path, body) => (await send(path, body)).json();

/** An answer as text. */
export const askText = async (path, body) => (await send(path, body)).text();

/** How long a calculation may take before a newer one stops it [ms]: a shorter one is let through, so that curves move with the slider. */
const PATIENCE = 400;

/** Sends the newest of what is wanted, one at a time. */
export class Calculator {
  #wanted = null;
  #flying = null;
  #number = 0;

  constructor(path, { begun, answered, failed }) {
    Object.assign(this, { path, begun, answered, failed });
  }

  /** `event` is when the user asked for it. */
  want(body, event = performance.now()) {
    this.#wanted = { body, event };
    this.#pump();
  }

  get isBusy() {
    return this.#flying !== null;
  }

  async #pump() {
    if (!this.#wanted) return;
    if (this.#flying) {
      const waited = performance.now() - this.#flying.sent;
      if (waited < PATIENCE) {
        setTimeout(() => this.#pump(), PATIENCE - waited);
        return;
      }
    }
    const { body, event } = this.#wanted;
    const own = { number: ++this.#number, event, sent: performance.now() };
    this.#wanted = null;
    this.#flying = own;
    this.begun();
    try {
      const answer = await ask(this.path, body);
      if (this.#flying === own) this.answered(answer, body, { ...own, received: performance.now() });
    } catch (problem) {
      // Another page of the same server has asked since: once more.
      if (problem.kind === "overtaken" && this.#flying === own && !this.#wanted) this.#wanted = { body, event };
      else if (this.#flying === own && problem.kind !== "overtaken") this.failed(problem, body);
    } finally {
      if (this.#flying === own) this.#flying = null;
      if (!this.#flying && this.#wanted) this.#pump();
    }
  }
}
