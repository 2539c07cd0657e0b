// Many runs: how often each algorithm succeeds, and how many runs it takes to be sure.

import { MOST_RUNS, nthSeed } from "./address.js";
import { LineChart } from "./chart.js";
import { checkedInteger } from "./checks.js";
import { experimentsOf, firstRunOf, seedOfRun } from "./course.js";
import { CoursePanel, seated } from "./course_panel.js";
import { labelled, make, makeAnnouncement, makeBlock, makeButton, makeControls } from "./dom.js";
import { makeAlgorithmChoice, makeParameterFields, makeSeedField, makeStateInput } from "./fields.js";
import { OutcomeTable } from "./outcome_table.js";
import { SETTINGS } from "./store.js";
import { compareTallies, seriesOfRates, tally } from "./tally.js";
import { makeClients } from "./worker_client.js";

const SHARED = [...SETTINGS, "course"]; // other ones have other runs
const NOTE =
  "A run is counted once all before it are over: failures take longest, and would otherwise be counted too late. " +
  "Intervals are Wilson's. If you look after every run and stop when they part, you will find differences that are " +
  "not there: decide first how many runs to make.";
const SEEDS = { // what the seed is the seed of
  run: "The seed is that of one run: the first run has it, the next one the seed after it, and so on.",
  experiment: "The seed is that of an experiment's run, and the runs here are runs of that experiment.",
  course: "The seed is that of the experiment which the class shares; from it follow the seeds of all runs.",
};

export class RunsView {
  /** page: the window in whose address the state is, or null; without it there are no classes. */
  constructor({ store, problem, makeWorker, page = null }) {
    this.store = store;
    this.problem = problem;
    this.makeWorker = makeWorker;
    this.clients = []; // one for each worker, while they run
    this.settings = {}; // of the runs in the table
    this.seeds = []; // of them: for each algorithm { algorithm, seedOf }, which gives the seed of the i-th run
    this.outcomes = []; // the same with { results, made }: by number, the successes (see tally.js), and all of a run
    this.session = 0; // of the workers; what an earlier one answers is dropped
    this.excursion = null; // { algorithms, seed, watchedSeed } while one of these runs is watched
    this.button = makeButton("Run", () => (this.isPlaying ? this.pause() : this.play()), { class: "primary" });
    this.chart = new LineChart("Success in %, with its 95 % interval", "runs");
    this.table = new OutcomeTable((algorithm, success) => this.#watch(algorithm, success));
    this.verdict = make("p", { class: "note verdict" });
    this.announcement = makeAnnouncement(); // the verdict, at the end
    this.coursePanel = new CoursePanel({ store, problem, page });
    this.count = labelled("runs of each algorithm", makeCountInput(store, problem));
    this.fields = makeControls(
      makeAlgorithmChoice(store),
      makeSeedField(store, problem),
      makeParameterFields(store, problem),
    );
    this.seedNote = make("p", { class: "note" });
    this.element = makeBlock(
      this.coursePanel.current,
      makeControls(this.button, this.count),
      this.fields,
      this.seedNote,
      this.coursePanel.begin,
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
    if (state.course) {
      // the seat of the reader, and the settings of the class whatever other tabs have changed
      const course = seated(state.course), { settings } = this;
      const isSame = settings.course === course;
      const changes = isSame ? settings : { course };
      if (Object.entries(changes).some(([name, value]) => state[name] !== value)) return this.store.set({ ...changes });
    }
    if (SHARED.some((name) => state[name] !== this.settings[name])) this.#begin();
    this.#draw();
  }

  /** Forget all runs: these settings have others. */
  #begin() {
    const { state } = this.store, { course, seed } = state;
    this.pause();
    this.settings = this.#settings();
    this.seeds = this.outcomes = [];
    if (course) this.problem.attempt(() => (this.seeds = this.#seedsInClass()));
    else this.seeds = state.algorithms.map((algorithm) => ({ algorithm, seedOf: (i) => nthSeed(seed, i) }));
    this.table.begin([]);
    for (const field of [this.count, this.fields]) field.hidden = Boolean(course);
    this.button.disabled = course?.seat === null || this.seeds.length === 0;
    this.seedNote.textContent = SEEDS[course ? "course" : seed.spawnKey.length > 0 ? "experiment" : "run"];
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
      this.outcomes = this.seeds.map((one) => ({ ...one, results: [], made: [] }));
      this.table.begin(this.settings.algorithms);
    }
    this.announcement.textContent = "";
    const queue = this.#missingRuns();
    if (queue.length === 0) return;
    const { session } = this;
    this.clients = makeClients(this.makeWorker, queue.length);
    this.button.textContent = "Stop";
    try {
      await Promise.all(this.clients.map((client) => this.#work(client, queue, session)));
    } catch (error) {
      if (session === this.session) this.problem.report(error);
    }
    if (session !== this.session) return;
    this.pause();
    this.announcement.textContent = this.verdict.textContent;
    this.store.set({ counted: { of: this.#settings(), outcomes: this.outcomes.map(countsOf) } });
  }

  /** The parts of the state that its runs have. */
  #settings() {
    return Object.fromEntries([...SHARED, "runs"].map((name) => [name, this.store.state[name]]));
  }

  #seedsInClass() {
    const { course, runs } = this.settings;
    const first = firstRunOf(course.seat, runs);
    return experimentsOf(course, this.settings).map(({ algorithm, digest }) => ({
      algorithm,
      seedOf: (i) => seedOfRun(digest, first + i),
    }));
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
    const { maze, parameters } = this.settings;
    while (queue.length > 0) {
      const [outcome, number] = queue.shift();
      const { algorithm, seedOf } = outcome;
      const result = await client.ask("evolve", { maze, algorithm, seed: seedOf(number), parameters });
      if (session !== this.session) return;
      outcome.results[number] = result.success;
      outcome.made[number] = result;
      this.#draw();
    }
  }

  #draw() {
    const tallies = this.outcomes.map((outcome) => ({ ...outcome, counts: tally(outcome.results) }));
    this.chart.show(tallies.map(seriesOfRates), 100, this.store.state.runs);
    this.table.show(tallies);
    this.verdict.textContent = compareTallies(tallies);
    this.coursePanel.show(this.outcomes);
  }

  /** Watch the first run of an algorithm that succeeded, or failed. These runs stay until the reader comes back. */
  #watch(algorithm, success) {
    const { results, seedOf } = this.outcomes.find((outcome) => outcome.algorithm === algorithm);
    const { algorithms, seed } = this.settings;
    const watchedSeed = seedOf(results.indexOf(success));
    this.excursion = { algorithms, seed, watchedSeed };
    this.store.set({ algorithms: [algorithm], seed: watchedSeed, generation: 0, view: "watch" });
  }
}
function countsOf({ algorithm, results }) {
  return { algorithm, runs: results.length, successes: results.filter((success) => success).length };
}

function makeCountInput(store, problem) {
  return makeStateInput(store, problem, { type: "number", min: 1, max: MOST_RUNS, step: 1 }, {
    name: "runs",
    read: () => store.state.runs,
    write: (runs) => store.set({ runs: checkedInteger("runs", runs, 1, MOST_RUNS) }),
  });
}
