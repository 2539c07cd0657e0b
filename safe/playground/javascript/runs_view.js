// Many runs: how often each algorithm succeeds, and how many runs it takes to be sure.

import { MOST_RUNS, nthSeed } from "./address.js";
import { LineChart } from "./chart.js";
import { checkedInteger } from "./checks.js";
import { labelled, make, makeAnnouncement, makeBlock, makeButton, makeControls } from "./dom.js";
import { makeAlgorithmChoice, makeParameterFields, makeSeedField, makeStateInput } from "./fields.js";
import { kindOf, titleOf } from "./labels.js";
import { OutcomeTable } from "./outcome_table.js";
import { SETTINGS } from "./store.js";
import { compareTallies, tally } from "./tally.js";
import { WorkerClient } from "./worker_client.js";

const MOST_WORKERS = 8;
const NOTE =
  "The first run has the seed above, the next one the seed after it, and so on. A run is counted once all before it " +
  "are over: failures take longest, and would otherwise be counted too late. Intervals are Wilson's. If you look " +
  "after every run and stop when they part, you will find differences that are not there: decide first how many runs " +
  "to make.";

export class RunsView {
  constructor({ store, problem, makeWorker }) {
    this.store = store;
    this.problem = problem;
    this.makeWorker = makeWorker;
    this.clients = []; // one for each worker, while they run
    this.settings = {}; // of the runs in the table
    this.outcomes = []; // for each algorithm { algorithm, results }; see tally.js
    this.session = 0; // of the workers; what an earlier one answers is dropped
    this.excursion = null; // { algorithms, seed, watchedSeed } while one of these runs is watched
    this.button = makeButton("Run", () => (this.isPlaying ? this.pause() : this.play()), { class: "primary" });
    this.chart = new LineChart("Success in %, with its 95 % interval", "runs");
    this.table = new OutcomeTable((algorithm, success) => this.#watch(algorithm, success));
    this.verdict = make("p", { class: "note verdict" });
    this.announcement = makeAnnouncement(); // the verdict, at the end
    const settings = [makeAlgorithmChoice(store), makeSeedField(store, problem), makeParameterFields(store, problem)];
    this.element = makeBlock(
      makeControls(this.button, labelled("runs of each algorithm", makeCountInput(store, problem))),
      makeControls(...settings),
      make("p", { class: "note" }, NOTE),
      this.verdict,
      this.announcement,
      make("div", { class: "charts single" }, this.chart.element),
      this.table.element,
    );
  }

  show() {
    const { state } = this.store;
    if (state.view !== "runs") return;
    const { excursion } = this;
    this.excursion = null;
    if (excursion?.watchedSeed === state.seed) {
      return this.store.set({ algorithms: excursion.algorithms, seed: excursion.seed });
    }
    if (SETTINGS.some((name) => state[name] !== this.settings[name])) {
      this.pause();
      this.settings = Object.fromEntries(SETTINGS.map((name) => [name, state[name]]));
      this.outcomes = [];
      this.table.begin([]);
    }
    this.#draw();
  }

  get isPlaying() {
    return this.clients.length > 0;
  }

  /** Stop. Runs that are over stay, and the next start goes on after them. */
  pause() {
    this.session++;
    for (const client of this.clients) client.close();
    this.clients = [];
    this.button.textContent = "Run";
  }

  destroy() {
    this.pause();
  }

  async play() {
    if (this.outcomes.length === 0) {
      const { algorithms } = this.settings;
      this.outcomes = algorithms.map((algorithm) => ({ algorithm, results: [] }));
      this.table.begin(algorithms);
    }
    this.announcement.textContent = "";
    const queue = this.#missingRuns();
    if (queue.length === 0) return;
    const { session } = this;
    const workers = Math.min(MOST_WORKERS, navigator.hardwareConcurrency || 2, queue.length);
    this.clients = Array.from({ length: workers }, () => new WorkerClient(this.makeWorker));
    this.button.textContent = "Stop";
    try {
      await Promise.all(this.clients.map((client) => this.#work(client, queue, session)));
    } catch (error) {
      if (session === this.session) this.problem.report(error);
    }
    if (session !== this.session) return;
    this.pause();
    this.announcement.textContent = this.verdict.textContent;
  }

  /** [outcome, number of the run] of each run that is still to be made. */
  #missingRuns() {
    const numbers = Array.from({ length: this.store.state.runs }, (_, number) => number);
    return numbers.flatMap((number) =>
      this.outcomes.filter(({ results }) => results[number] === undefined).map((outcome) => [outcome, number])
    );
  }

  /** Let a worker make one run after the other, until none is left. */
  async #work(client, queue, session) {
    const { maze, seed, parameters } = this.settings;
    while (queue.length > 0) {
      const [outcome, number] = queue.shift();
      const { algorithm } = outcome;
      const result = await client.ask("evolve", { maze, algorithm, seed: nthSeed(seed, number), parameters });
      if (session !== this.session) return;
      outcome.results[number] = result.success;
      this.#draw();
    }
  }

  #draw() {
    const tallies = this.outcomes.map((outcome) => ({ ...outcome, counts: tally(outcome.results) }));
    this.chart.show(tallies.map(seriesOfRates), 100, this.store.state.runs);
    this.table.show(tallies);
    this.verdict.textContent = compareTallies(tallies);
  }

  /** Watch the first run of an algorithm that succeeded, or failed. These runs stay until the reader comes back. */
  #watch(algorithm, success) {
    const { results } = this.outcomes.find((outcome) => outcome.algorithm === algorithm);
    const { algorithms, seed } = this.settings;
    const watchedSeed = nthSeed(seed, results.indexOf(success));
    this.excursion = { algorithms, seed, watchedSeed };
    this.store.set({ algorithms: [algorithm], seed: watchedSeed, generation: 0, view: "watch" });
  }
}

function makeCountInput(store, problem) {
  return makeStateInput(store, problem, { type: "number", min: 1, max: MOST_RUNS, step: 1 }, {
    name: "runs",
    read: () => store.state.runs,
    write: (runs) => store.set({ runs: checkedInteger("runs", runs, 1, MOST_RUNS) }),
  });
}

function seriesOfRates({ algorithm, counts }) {
  return {
    label: titleOf(algorithm),
    kind: kindOf(algorithm),
    points: counts.map(({ runs, successes }) => [runs, (100 * successes) / runs]),
    band: counts.map(({ runs, low, high }) => [runs, 100 * low, 100 * high]),
  };
}
