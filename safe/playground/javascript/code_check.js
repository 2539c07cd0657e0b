// The box in which a teacher checks codes of challenges: their solutions are tried again.

import { nthSeed, readAddress } from "./address.js";
import { CHALLENGES, isSolved, readCode } from "./challenges.js";
import { labelled, make, makeBlock } from "./dom.js";
import { defaultState } from "./state.js";
import { listText } from "./text.js";
import { makeClients } from "./worker_client.js";

export class CodeCheck {
  constructor(makeWorker, problem) {
    this.makeWorker = makeWorker;
    this.problem = problem;
    this.session = 0;
    this.clients = [];
    const oninput = () => this.#check();
    this.area = make("textarea", { class: "lines", rows: 4, spellcheck: "false", oninput });
    this.found = make("ul", { class: "checks", role: "status" });
    this.element = makeBlock(labelled("Codes of challenges", this.area, { class: "field wide" }), this.found);
  }

  async #check() {
    const session = ++this.session;
    for (const client of this.clients) client.close();
    this.clients = [];
    this.found.replaceChildren();
    const codes = this.area.value.split(/(?=SAFE-challenges-)/).filter((text) => text.trim());
    for (const text of codes) {
      const item = make("li", {}, "is being checked …");
      this.found.append(item);
      const code = readCode(text);
      try {
        const wrong = code ? await this.#wrongOf(code, session) : null;
        if (session !== this.session) return;
        item.className = code && wrong.length === 0 ? "good" : "bad";
        item.textContent = code ? verdictOf(code, wrong) : "This code is damaged.";
      } catch (error) {
        if (session === this.session) this.problem.report(error);
      }
    }
  }

  /** The numbers of the challenges in a code that its addresses do not solve. */
  async #wrongOf({ solved }, session) {
    const wrong = [];
    for (const [number, address] of solved) {
      if (session !== this.session) break;
      const challenge = CHALLENGES[number - 1];
      if (!challenge || !await this.#isSolvedAgain(challenge, address)) wrong.push(number);
    }
    return wrong;
  }

  async #isSolvedAgain(challenge, address) {
    const state = { ...defaultState(), ...readAddress(address) };
    return isSolved(challenge, state, challenge.runs ? await this.#count(state, challenge.runs) : null);
  }

  /** Make all runs of a state; for each algorithm { algorithm, runs, successes }. */
  async #count({ maze, algorithms, seed, parameters }, runs) {
    const outcomes = algorithms.map((algorithm) => ({ algorithm, runs, successes: 0 }));
    const queue = outcomes.flatMap((outcome) => Array.from({ length: runs }, (_, i) => [outcome, nthSeed(seed, i)]));
    this.clients = makeClients(this.makeWorker, queue.length);
    await Promise.all(this.clients.map(async (client) => {
      while (queue.length > 0) {
        const [outcome, seedOfRun] = queue.shift();
        const settings = { maze, algorithm: outcome.algorithm, seed: seedOfRun, parameters };
        outcome.successes += (await client.ask("evolve", settings)).success;
      }
    }));
    for (const client of this.clients) client.close();
    return outcomes;
  }
}

function verdictOf({ name, solved }, wrong) {
  const right = solved.map(([number]) => number).filter((number) => !wrong.includes(number));
  const parts = [`${name || "Nobody"} has solved ${right.length} of ${CHALLENGES.length}`];
  if (right.length > 0) parts.push(`: ${listText(right.map(String))}`);
  if (wrong.length > 0) parts.push(`. Not solved, although the code says so: ${listText(wrong.map(String))}`);
  return `${parts.join("")}.`;
}
