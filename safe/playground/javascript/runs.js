// Many runs: how often each algorithm succeeds, and how many runs it takes to be sure.

import { MOST_RUNS, nthSeed } from "./address.js";
import { LineChart } from "./chart.js";
import { checkedInteger } from "./checks.js";
import { Client } from "./client.js";
import { labelled, make, makeButton } from "./dom.js";
import { kindOf, makeAlgorithmChoice, makeParameterFields, makeSeedFields, makeSwatch, titleOf } from "./fields.js";
import { wilsonInterval } from "./interval.js";
import { SETTINGS } from "./store.js";

const MOST_WORKERS = 8;

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
    this.button = makeButton("Run", () => (this.isRunning ? this.pause() : this.#start()), { class: "primary" });
    this.chart = new LineChart("Success in %, with its 95 % interval", "runs");
    this.verdict = make("p", { class: "note" });
    this.status = make("p", { class: "unseen", role: "status" }); // tells the verdict at the end, to those who hear it
    this.body = make("tbody");
    const count = make("input", { type: "number", min: 1, max: MOST_RUNS, step: 1 });
    const showCount = () => (count.value = store.state.runs);
    count.addEventListener("change", () =>
      complain(() => store.set({ runs: checkedInteger("runs", count.valueAsNumber, 1, MOST_RUNS) }), showCount),
    );
    store.listen((names) => names.includes("runs") && showCount());
    showCount();
    this.element = make(
      "div",
      {},
      make("div", { class: "controls" }, this.button, labelled("runs of each algorithm", count)),
      make(
        "div",
        { class: "controls" },
        makeAlgorithmChoice(store),
        makeSeedFields(store, complain).seed,
        makeParameterFields(store, complain),
      ),
      make(
        "p",
        { class: "note" },
        "The first run has the seed above, the next one the seed after it, and so on. A run is counted once all before " +
          "it are over: failures take longest, and would otherwise be counted too late. Intervals are Wilson's. Whoever " +
          "looks after every run and stops when they part will find differences that are not there: decide first how many " +
          "runs to make.",
      ),
      this.verdict,
      this.status,
      make("div", { class: "charts single" }, this.chart.element),
      make(
        "div",
        { class: "scroll", role: "region", "aria-label": "Runs so far", tabindex: 0 },
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
  }

  show() {
    const { state } = this.store;
    if (state.view !== "runs") return;
    const { left } = this;
    this.left = null;
    if (left?.opened === state.seed) return this.store.set({ algorithms: left.algorithms, seed: left.seed });
    if (SETTINGS.some((name) => state[name] !== this.settings[name])) {
      this.pause();
      this.settings = Object.fromEntries(SETTINGS.map((name) => [name, state[name]]));
      this.outcomes = [];
      this.body.replaceChildren();
    }
    this.#draw();
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
    if (this.outcomes.length === 0) {
      this.outcomes = algorithms.map((algorithm) => ({ algorithm, results: [], row: this.#makeRow(algorithm) }));
      this.body.replaceChildren(...this.outcomes.map(({ row }) => row.element));
    }
    this.status.textContent = "";
    const waiting = [];
    for (let number = 0; number < this.store.state.runs; number++) {
      for (const outcome of this.outcomes) if (outcome.results[number] === undefined) waiting.push([outcome, number]);
    }
    if (waiting.length === 0) return;
    const { turn } = this;
    const workers = Math.min(MOST_WORKERS, navigator.hardwareConcurrency || 2, waiting.length);
    this.clients = Array.from({ length: workers }, () => new Client(this.makeWorker));
    this.button.textContent = "Stop";
    try {
      await Promise.all(this.clients.map((client) => this.#work(client, waiting, turn)));
    } catch (error) {
      if (turn === this.turn) this.report(error);
    }
    if (turn !== this.turn) return;
    this.pause();
    this.status.textContent = this.verdict.textContent;
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
    const counted = this.outcomes.map((outcome) => ({ ...outcome, steps: tally(outcome.results) }));
    this.chart.show(
      counted.map(({ algorithm, steps }) => ({
        label: titleOf(algorithm),
        kind: kindOf(algorithm),
        points: steps.map(({ runs, successes }) => [runs, (100 * successes) / runs]),
        band: steps.map(({ runs, low, high }) => [runs, 100 * low, 100 * high]),
      })),
      100,
      this.store.state.runs,
    );
    for (const { row, steps, results } of counted) {
      const { runs = 0, successes = 0, low = 0, high = 1 } = steps.at(-1) ?? {};
      const numbers = [
        runs,
        successes,
        runs > 0 ? `${percent(successes / runs)} %` : "–",
        `${percent(low)} to ${percent(high)} %`,
      ];
      numbers.forEach((number, i) => (row.cells[i].textContent = number));
      for (const { button, success } of row.openers) button.disabled = !results.includes(success);
    }
    this.verdict.textContent = verdicts(counted);
  }

  /** A row of the table, which stays while its texts change, so that nobody loses the button under the finger. */
  #makeRow(algorithm) {
    const cells = Array.from({ length: 4 }, () => make("td", { class: "number" }));
    const openers = [
      ["a success", true],
      ["a failure", false],
    ].map(([text, success]) => {
      const open = () => {
        const { results } = this.outcomes.find((outcome) => outcome.algorithm === algorithm);
        const { algorithms, seed } = this.settings;
        const opened = nthSeed(seed, results.indexOf(success));
        this.left = { algorithms, seed, opened };
        this.store.set({ algorithms: [algorithm], seed: opened, generation: 0, view: "watch" });
      };
      return { success, button: makeButton(text, open, { "aria-label": `Watch ${text} of ${titleOf(algorithm)}` }) };
    });
    const element = make(
      "tr",
      {},
      make("th", { scope: "row" }, makeSwatch(algorithm), titleOf(algorithm)),
      ...cells,
      make("td", {}, ...openers.map(({ button }) => button)),
    );
    return { element, cells, openers };
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
  return steps;
}

/** A share in %, with a decimal where it is small. */
function percent(share) {
  return (100 * share).toFixed(share > 0 && share < 0.1 ? 1 : 0);
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
          : `${pair}: after ${runs} runs their intervals overlap, which does not show that they are equal.`,
      );
    }
  });
  return sentences.join(" ");
}
