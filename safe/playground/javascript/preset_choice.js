// The choice of weights to start from, with an explanation.

import { make, makeSelect } from "./dom.js";
import { PRESETS } from "./presets.js";
import { WEIGHTS } from "./robot.js";
import { WorkerClient } from "./worker_client.js";

const RANDOM = "random";

export class PresetChoice {
  constructor(store, problem, makeWorker) {
    this.store = store;
    this.problem = problem;
    this.makeWorker = makeWorker;
    this.client = null; // evolves weights
    const presets = PRESETS.map(({ title }, i) => [i, title]);
    this.element = makeSelect([["", "choose…"], ...presets, [RANDOM, "random weights"]], (choice) => {
      if (choice === RANDOM) store.set({ controller: randomController() });
      else if (choice !== "") this.#take(PRESETS[choice]);
      this.element.value = "";
    });
    this.explanation = make("p", { class: "note", role: "status" });
  }

  /** The weights or the maze have changed: explain nothing, and stop what is being evolved. */
  forget() {
    this.client?.close();
    this.client = null;
    this.explanation.textContent = "";
  }

  async #take({ explanation, controller, run }) {
    try {
      this.store.set({ controller: controller ?? await this.#evolve(run) });
      this.explanation.textContent = explanation;
    } catch (error) {
      this.forget();
      this.problem.report(error);
    }
  }

  /** The best controller of a run in the maze of the state. */
  async #evolve(run) {
    const { maze } = this.store.state;
    this.forget();
    this.explanation.textContent = "Evolving …";
    this.client = new WorkerClient(this.makeWorker);
    const result = await this.client.ask("evolve", { maze, parameters: {}, ...run(maze) });
    return result.controller;
  }
}

/** Weights drawn uniformly, to two decimals. */
function randomController() {
  return Array.from({ length: WEIGHTS }, () => Math.round(200 * Math.random() - 100) / 100);
}
