// Watch: algorithms at work on one maze, side by side, generation by generation.

import { PARAMETERS } from "./algorithms.js";
import { LineChart, ObjectiveSquare } from "./chart.js";
import { checkedInteger, MOST } from "./checks.js";
import { labelled, make, makeButton, makeLegend, makeSelect, prefersLessMotion } from "./dom.js";
import { cellsText } from "./drive.js";
import { kindOf, makeAlgorithmChoice, makeParameterFields, makeSeedFields, number3, titleOf } from "./fields.js";
import { Panel } from "./panel.js";
import { SETTINGS } from "./store.js";

const SPEEDS = [1, 2, 5, 10, 30, 100, Infinity]; // generations a second
const WATCHED = [
  ["ring", "start"],
  ["star", "goal"],
  ["dot", "where robots of this generation ended (larger: several)"],
  ["faint", "archive"],
  ["stroke", "path of the best robot so far"],
  ["dashes", "how its end moved from generation to generation"],
  ["looked", "the robot looked at, and its nearest neighbours"],
];
const MOST_SUMMANDS = 30; // of a novelty that are written out
const FRAME = 40; // milliseconds between two pictures, at the least
const CALM_FRAME = 1000; // the same, where the reader asks for less motion

export class WatchView {
  constructor(store, { complain, report, makeWorker, onresult }) {
    this.store = store;
    this.report = report;
    this.makeWorker = makeWorker;
    this.onresult = onresult;
    this.panels = [];
    this.isStale = true;
    this.isPlaying = false;
    this.playing = null; // the turn that is being played
    this.turn = 0; // of the runs that are shown: what belongs to earlier ones comes to nothing
    this.looked = null; // { panel, individual, inspected } of the solution that is looked at
    this.told = null; // what the inspector tells of: the same, or where there is none the turn

    this.play = makeButton("Play", () => (this.isPlaying ? this.pause() : this.#start()), { class: "primary" });
    this.single = makeButton("One generation", () => this.#stepOnce());
    this.generation = make("input", { type: "number", min: 0, step: 1, value: 0 });
    this.generation.addEventListener("change", () =>
      complain(
        () => this.store.set({ generation: checkedInteger("generation", this.generation.valueAsNumber, 0, MOST) }),
        () => (this.generation.value = this.#shown()),
      ),
    );
    const told = make("output");
    this.speed = make("input", { type: "range", min: 0, max: SPEEDS.length - 1, step: 1, value: 3 });
    const tell = () => {
      const speed = SPEEDS[this.speed.valueAsNumber];
      told.value = speed === Infinity ? "as fast as it can" : `${speed} a second`;
      this.speed.setAttribute("aria-valuetext", told.value);
    };
    this.speed.addEventListener("input", tell);
    tell();
    this.status = make("p", { class: "unseen", role: "status" }); // tells all results to those who hear it
    this.replayed = make("p", { class: "note" });
    this.row = make("div", { class: "panels" });
    this.charts = {
      distance: new LineChart("Best distance, in cells", "generation"),
      novelty: new LineChart("Mean novelty", "generation"),
      archive: new LineChart("Points in the archive", "generation"),
    };
    this.square = new ObjectiveSquare();
    this.inspector = make("section", { class: "inspector", "aria-label": "One robot" });
    this.element = make(
      "div",
      {},
      make(
        "div",
        { class: "controls" },
        this.play,
        this.single,
        makeButton("From the start", () => this.store.set({ generation: 0 })),
        labelled("Generation", this.generation),
        make("label", { class: "field" }, make("span", {}, "Speed"), this.speed, told),
      ),
      make(
        "div",
        { class: "controls" },
        makeAlgorithmChoice(store),
        ...Object.values(makeSeedFields(store, complain)),
        makeParameterFields(store, complain),
      ),
      this.replayed,
      this.status,
      make(
        "div",
        { class: "stage" },
        make("div", {}, this.row, makeLegend(WATCHED)),
        make(
          "div",
          {},
          this.inspector,
          make(
            "div",
            { class: "charts" },
            ...[this.square, ...Object.values(this.charts)].map(({ element }) => element),
          ),
        ),
      ),
    );
  }

  show(names) {
    const { state } = this.store;
    const isOther = names.some((name) => SETTINGS.includes(name));
    const isElsewhere = names.includes("generation") && state.generation !== this.#shown();
    if (isOther || isElsewhere) this.isStale = true;
    if (this.isStale && state.view === "watch") this.#open();
  }

  /** Stop playing, when the generation that is being made is there. */
  pause() {
    this.isPlaying = false;
    this.play.textContent = "Play";
  }

  destroy() {
    this.turn++;
    for (const panel of this.panels) panel.destroy();
  }

  /** The generation that is shown: the latest of all algorithms. */
  #shown() {
    return Math.max(-1, ...this.panels.map(({ generation }) => generation));
  }

  get #isOver() {
    return this.panels.every(({ now }) => now?.isOver);
  }

  /** Begin the runs of the state anew, and go to its generation. */
  async #open() {
    const { maze, algorithms, seed, parameters, generation } = this.store.state;
    this.destroy();
    this.isStale = false;
    this.isPlaying = false;
    this.play.textContent = "Play";
    this.looked = null;
    const [run] = seed.spawnKey;
    this.replayed.textContent =
      run === undefined
        ? ""
        : `Run ${run} of an experiment (those of the book have runs 0 to 499). Change Run to see the others.`;
    const { turn } = this;
    const ondrive = (controller) => this.store.set({ controller, view: "drive" });
    this.panels = algorithms.map(
      (algorithm, i) =>
        new Panel(algorithm, this.makeWorker, {
          onpick: (cell) => this.#look(i, (panel) => panel.nearest(cell)),
          ondrive,
        }),
    );
    this.row.replaceChildren(...this.panels.map(({ element }) => element));
    this.row.setAttribute("aria-busy", "true");
    this.ready = this.work = Promise.all(this.panels.map((panel) => panel.start(maze, seed, parameters, generation)));
    await this.#until(this.ready, turn);
    if (turn !== this.turn) return;
    this.row.removeAttribute("aria-busy");
    this.#draw();
    if (this.#isOver) this.#tellResults();
    else this.status.textContent = "";
    if (this.#shown() !== generation) this.#keep(); // the run was over before
  }

  /** Wait for workers, and tell what goes wrong in them. */
  async #until(work, turn) {
    try {
      await work;
    } catch (error) {
      if (turn === this.turn) {
        this.turn++;
        this.pause();
        this.report(error);
      }
    }
  }

  async #start() {
    if (this.#isOver && this.#shown() > 0) this.store.set({ generation: 0 });
    const { turn } = this;
    this.isPlaying = true;
    this.play.textContent = "Pause";
    this.status.textContent = "";
    if (this.playing === turn) return; // it had been told to stop, and has not yet
    this.playing = turn;
    await this.#until(this.ready, turn);
    while (this.isPlaying && turn === this.turn && !this.#isOver) {
      const speed = SPEEDS[this.speed.valueAsNumber];
      const frame = Math.max(prefersLessMotion() ? CALM_FRAME : FRAME, 1000 / speed);
      const begun = performance.now();
      await this.#advance(Math.max(1, Math.round((speed * frame) / 1000)), frame, turn);
      await new Promise((resolve) => setTimeout(resolve, Math.max(0, frame - (performance.now() - begun))));
    }
    if (turn !== this.turn) return;
    this.playing = null;
    this.pause();
    if (this.#isOver) this.#tellResults();
    this.#keep();
  }

  async #stepOnce() {
    this.pause();
    const { turn } = this;
    await this.#until(this.ready, turn);
    if (turn !== this.turn) return;
    await this.#advance(1, Infinity, turn);
    if (this.#isOver) this.#tellResults();
    this.#keep();
  }

  /** The generation that is reached becomes part of the state. */
  #keep() {
    this.store.set({ generation: this.#shown() });
  }

  async #advance(generations, milliseconds, turn) {
    this.work = Promise.all(this.panels.map((panel) => panel.advance(generations, milliseconds)));
    await this.#until(this.work, turn);
    if (turn !== this.turn) return;
    this.looked = null;
    this.#draw();
  }

  #tellResults() {
    const told = this.panels.map(({ algorithm, status }) => `${titleOf(algorithm)}: ${status.textContent}`);
    this.status.textContent = told.join(" ");
    this.onresult(this.panels[0].now.result);
  }

  #draw() {
    for (const panel of this.panels) panel.show(panel === this.looked?.panel ? this.looked.inspected : null);
    this.generation.value = this.#shown();
    const seriesOf = (key) =>
      this.panels
        .map(({ algorithm, history }) => ({
          label: titleOf(algorithm),
          kind: kindOf(algorithm),
          points: history.filter((line) => line[key] !== null).map((line) => [line.generation, line[key]]),
        }))
        .filter(({ points }) => points.length > 0);
    for (const [key, chart] of Object.entries(this.charts)) chart.show(seriesOf(key));
    this.square.show(
      this.panels.map((panel) => ({
        label: titleOf(panel.algorithm),
        kind: kindOf(panel.algorithm),
        objectives: panel.now.objectives,
        winners: panel.now.winners,
        chosen: panel === this.looked?.panel ? this.looked.inspected.winner : null,
      })),
    );
    this.#drawInspector();
  }

  /** Look at the solution of the i-th algorithm that `pick` names, in the generation that is there once all rest. */
  async #look(i, pick) {
    this.pause();
    const panel = this.panels[i],
      { turn } = this;
    await this.#until(this.work, turn);
    if (turn !== this.turn) return;
    const individual = pick(panel);
    await this.#until(
      panel.inspect(individual).then((inspected) => (this.looked = { panel, individual, inspected })),
      turn,
    );
    if (turn === this.turn) this.#draw();
  }

  #drawInspector() {
    const { looked, panels } = this;
    const told = looked ?? this.turn;
    if (told === this.told) return; // so that nobody is interrupted
    this.told = told;
    const number = make("input", {
      type: "number",
      min: 0,
      max: panels[0].now.ends.length - 1,
      step: 1,
      value: looked ? looked.individual : "",
    });
    const choice = makeSelect(
      panels.map(({ algorithm }, i) => [i, titleOf(algorithm)]),
      () => look(),
    );
    if (looked) choice.value = panels.indexOf(looked.panel);
    const look = () => {
      const n = Math.max(0, Math.round(number.valueAsNumber || 0));
      this.#look(Number(choice.value), ({ now }) => Math.min(n, now.ends.length - 1));
    };
    number.addEventListener("change", look);
    const had = this.inspector.contains(document.activeElement) ? document.activeElement.tagName : null;
    this.inspector.replaceChildren(
      make("h2", {}, "One robot"),
      make("p", { class: "note" }, "Click where one ended, or give its number in the generation, counted from 0."),
      make(
        "div",
        { class: "controls" },
        labelled("Robot", number),
        ...(panels.length > 1 ? [labelled("of", choice)] : []),
      ),
      ...(looked ? this.#describe(looked) : []),
    );
    if (had) this.inspector.querySelector(had.toLowerCase())?.focus();
  }

  #describe({ individual, inspected }) {
    const { endpoint, distance, novelty, neighbours, fitness, coefficients, winner, fromGoal, fromNovelty } = inspected;
    const lines = [
      `Robot ${individual} ended at row ${endpoint[0]}, column ${endpoint[1]}, ${cellsText(distance)} from the goal.`,
    ];
    if (novelty !== null) {
      const own = neighbours.filter(({ from }) => from === "population").length;
      const all = neighbours.map((neighbour) => neighbour.distance);
      const summands = all.slice(0, MOST_SUMMANDS).join(" + ") + (all.length > MOST_SUMMANDS ? " + …" : "");
      lines.push(
        `Novelty ${number3(novelty)}: its nearest neighbours, ${own} of its own generation and ` +
          `${neighbours.length - own} of the archive, are at distances that add up to ` +
          `${all.reduce((a, b) => a + b, 0)} (${summands}); that over k = ${this.store.state.parameters.k ?? PARAMETERS.k}.`,
      );
    }
    const parts = [];
    if (fitness !== null) {
      const hasShares = Math.min(fromGoal, fromNovelty) >= 0 && fitness > 0; // not so with negative weights
      const share = fromGoal / fitness;
      const [percent, rest] = [share, 1 - share].map((part) => `${(100 * part).toFixed(1)} %`);
      const inWords = (text) => (hasShares ? ` (${text})` : "");
      lines.push(
        `Fitness ${number3(fitness)}, by objective function ${winner} with a = ${number3(coefficients[0])} and ` +
          `b = ${number3(coefficients[1])}: ${number3(fromGoal)} for being near the goal${inWords(percent)} and ` +
          `${number3(fromNovelty)} for novelty${inWords(rest)}.`,
      );
      if (hasShares)
        parts.push(
          make(
            "div",
            { class: "shares", role: "img", "aria-label": `Of its fitness, ${percent} is goal and ${rest} novelty` },
            make("span", { class: "goal", style: `flex-grow: ${share}` }, share > 0.1 ? "goal" : ""),
            make("span", { class: "novelty", style: `flex-grow: ${1 - share}` }, share < 0.9 ? "novelty" : ""),
          ),
        );
    } else lines.push("Nobody judges it: in random search there is nothing to select by.");
    return [
      ...lines.map((line) => make("p", { class: "told" }, line)),
      ...parts,
      makeButton("Drive this robot", () => this.store.set({ controller: inspected.controller, view: "drive" })),
    ];
  }
}
