// Many runs: how often each algorithm succeeds, and how many runs it takes to be sure.

import { nthSeed } from "./address.js";
import { LineChart } from "./chart.js";
import { Client } from "./client.js";
import { labelled, make, makeButton, makeSelect } from "./dom.js";
import { kindOf, makeAlgorithmChoice, makeParameterFields, makeSeedFields, makeSwatch, titleOf } from "./fields.js";
import { wilsonInterval } from "./interval.js";

const MOST_WORKERS = 8;
const SETTINGS = ["maze", "algorithms", "seed", "parameters"];
const COUNTS = [10, 20, 50, 100, 200, 500];

export class RunsView {
  constructor(store, { complain, report, makeWorker }) {
    this.store = store;
    this.report = report;
    this.makeWorker = makeWorker;
    this.clients = [];
    this.settings = {}; // of these runs
    this.left = null; // { algorithms, seed } of these runs, while one of them, `opened` by its seed, is watched
    this.outcomes = []; // of each algorithm { algorithm, results }: by the number of the run, whether it succeeded
    this.turn = 0;
    this.count = 50;
    this.button = makeButton("Run", () => (this.isRunning ? this.pause() : this.#start()), { class: "primary" });
    this.chart = new LineChart("Success in %, with its 95 % interval", "runs");
    this.status = make("p", { class: "note", role: "status" });
    this.body = make("tbody");
    const counts = makeSelect(COUNTS.map((count) => [count, `${count} runs`]), (count) => {
      this.count = Number(count);
      this.#draw();
    });
    counts.value = this.count;
    this.element = make(
      "div",
      {},
      make("div", { class: "controls" }, this.button, labelled("of each algorithm", counts)),
      make(
        "div",
        { class: "controls" },
        makeAlgorithmChoice(store),
        ...makeSeedFields(store, complain),
        makeParameterFields(store, complain),
      ),
      make(
        "p",
        { class: "note" },
        "Runs count in the order of their seeds, each as soon as all before it are over: failures take longest, so counting runs as they finish would flatter everyone.",
      ),
      this.status,
      make("div", { class: "charts single" }, this.chart.element),
      make(
        "div",
        { class: "scroll" },
        make(
          "table",
          { class: "outcomes" },
          make("caption", {}, "Runs so far"),
          make(
            "thead",
            {},
            make(
              "tr",
              {},
              ...["Algorithm", "Runs", "Successes", "Rate", "95 % interval", "Watch"].map((text, i) =>
                make("th", { scope: "col", class: i > 0 && i < 5 ? "number" : null }, text),
              ),
            ),
          ),
          this.body,
        ),
      ),
    );
    this.#draw();
  }

  show() {
    const { state } = this.store;
    if (state.view !== "runs") return;
    const { left } = this;
    this.left = null;
    if (left?.opened === state.seed) this.store.set({ algorithms: left.algorithms, seed: left.seed });
    else if (SETTINGS.some((name) => state[name] !== this.settings[name])) {
      this.pause();
      this.settings = Object.fromEntries(SETTINGS.map((name) => [name, state[name]]));
      this.outcomes = [];
      this.#draw();
    }
  }

  get isRunning() {
    return this.clients.length > 0;
  }

  /** Stop; runs that are over stay, and a further start goes on after them. */
  pause() {
    this.turn++;
    for (const client of this.clients) client.close();
    this.clients = [];
    this.button.textContent = "Run";
  }

  destroy() {
    this.pause();
  }

  async #start() {
    const { algorithms } = this.settings;
    if (this.outcomes.length === 0) this.outcomes = algorithms.map((algorithm) => ({ algorithm, results: [] }));
    const waiting = [];
    for (let number = 0; number < this.count; number++) {
      for (const outcome of this.outcomes) if (outcome.results[number] === undefined) waiting.push([outcome, number]);
    }
    if (waiting.length === 0) {
      this.#draw();
      return;
    }
    const { turn } = this;
    const workers = Math.min(MOST_WORKERS, navigator.hardwareConcurrency || 2, waiting.length);
    this.clients = Array.from({ length: workers }, () => new Client(this.makeWorker));
    this.button.textContent = "Stop";
    try {
      await Promise.all(this.clients.map((client) => this.#work(client, waiting, turn)));
    } catch (error) {
      if (turn === this.turn) this.report(error);
    }
    if (turn === this.turn) this.pause();
  }

  /** Let a worker make one run after the other, until none waits. */
  async #work(client, waiting, turn) {
    const { maze, seed, parameters } = this.settings;
    while (waiting.length > 0) {
      const [outcome, number] = waiting.shift();
      const { algorithm } = outcome;
      const result = await client.ask("evolve", { maze, algorithm, seed: nthSeed(seed, number), parameters });
      if (turn !== this.turn) return;
      outcome.results[number] = result.success;
      this.#draw();
    }
  }

  #draw() {
    const counted = this.outcomes.map(({ algorithm, results }) => ({ algorithm, ...tally(results) }));
    this.chart.show(
      counted.map(({ algorithm, steps }) => ({
        label: titleOf(algorithm),
        kind: kindOf(algorithm),
        points: steps.map(({ runs, successes }) => [runs, (100 * successes) / runs]),
        band: steps.map(({ runs, low, high }) => [runs, 100 * low, 100 * high]),
      })),
      100,
      this.count,
    );
    this.body.replaceChildren(
      ...counted.map(({ algorithm, steps, results }) => {
        const { runs = 0, successes = 0, low = 0, high = 1 } = steps.at(-1) ?? {};
        const numbers = [
          runs,
          successes,
          runs > 0 ? `${((100 * successes) / runs).toFixed(0)} %` : "–",
          `${(100 * low).toFixed(0)} to ${(100 * high).toFixed(0)} %`,
        ];
        return make(
          "tr",
          {},
          make("th", { scope: "row" }, makeSwatch(algorithm), titleOf(algorithm)),
          ...numbers.map((number) => make("td", { class: "number" }, String(number))),
          make("td", {}, ...[["a success", true], ["a failure", false]].map(([text, success]) => this.#opener(text, algorithm, results.indexOf(success)))),
        );
      }),
    );
    this.status.textContent = verdicts(counted);
  }

  #opener(text, algorithm, number) {
    const open = () => {
      const { algorithms, seed } = this.settings;
      const opened = nthSeed(seed, number);
      this.left = { algorithms, seed, opened };
      this.store.set({ algorithms: [algorithm], seed: opened, generation: 0, view: "watch" });
    };
    return makeButton(text, open, { disabled: number < 0, "aria-label": `Watch ${text} of ${titleOf(algorithm)}` });
  }
}

/** Successes after each run that is over and before which all are. */
function tally(results) {
  const steps = [];
  let successes = 0;
  for (let runs = 1; results[runs - 1] !== undefined; runs++) {
    successes += results[runs - 1];
    const [low, high] = wilsonInterval(successes, runs);
    steps.push({ runs, successes, low, high });
  }
  return { steps, results };
}

/** Of each pair of algorithms: since which run their intervals have been apart. */
function verdicts(counted) {
  const sentences = [];
  counted.forEach((one, i) => {
    for (const other of counted.slice(i + 1)) {
      const runs = Math.min(one.steps.length, other.steps.length);
      if (runs === 0) continue;
      const isApart = (n) => one.steps[n].low > other.steps[n].high || other.steps[n].low > one.steps[n].high;
      let since = runs;
      while (since > 0 && isApart(since - 1)) since--;
      const pair = `${titleOf(one.algorithm)} and ${titleOf(other.algorithm)}`;
      sentences.push(
        since < runs
          ? `${pair}: their intervals have been apart since run ${since + 1}.`
          : `${pair}: after ${runs} runs their intervals overlap.`,
      );
    }
  });
  return sentences.join(" ");
}
