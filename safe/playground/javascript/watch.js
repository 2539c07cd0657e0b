// Watch: algorithms at work on one maze, side by side, generation by generation.

import { make, makeAnnouncement, makeBlock, makeControls, makeLegend, prefersLessMotion } from "./dom.js";
import { makeAlgorithmChoice, makeParameterFields, makeRunField, makeSeedField } from "./fields.js";
import { Inspector } from "./inspector.js";
import { titleOf } from "./labels.js";
import { RunPanel } from "./run_panel.js";
import { SETTINGS } from "./store.js";
import { Transport } from "./transport.js";
import { WatchCharts } from "./watch_charts.js";

const WATCH_LEGEND = [
  ["ring", "start"],
  ["star", "goal"],
  ["dot", "where robots of this generation ended (larger: several)"],
  ["faint", "archive"],
  ["stroke", "path of the best robot so far"],
  ["dashes", "how its end moved from generation to generation"],
  ["selected", "the robot looked at, and its nearest neighbours"],
];
const FRAME = 40; // milliseconds between two pictures, at the least
const CALM_FRAME = 1000; // the same, if the reader asks for less motion

export class WatchView {
  constructor({ store, problem, makeWorker }) {
    this.store = store;
    this.problem = problem;
    this.makeWorker = makeWorker;
    this.panels = [];
    this.isStale = true; // do the panels show other settings than those of the state?
    this.isPlaying = false;
    this.session = 0; // of the runs that are shown; whatever belongs to an earlier one is dropped
    this.playedSession = null;
    this.selection = null; // { panel, individual, inspection } of the robot that is looked at

    this.ondrive = (controller) => store.set({ controller, view: "drive" });
    this.transport = new Transport(store, problem, {
      onplay: () => (this.isPlaying ? this.pause() : this.#play()),
      onstep: () => this.#step(),
      generationShown: () => Math.max(0, this.#generation),
    });
    this.announcement = makeAnnouncement();
    this.origin = make("p", { class: "note" });
    this.row = make("div", { class: "panels" });
    this.charts = new WatchCharts();
    this.inspector = new Inspector({
      onselect: (i, individual) => this.#select(i, () => individual),
      ondrive: this.ondrive,
    });
    const settings = [makeAlgorithmChoice(store), makeSeedField(store, problem), makeRunField(store, problem)];
    this.element = makeBlock(
      this.transport.element,
      makeControls(...settings, makeParameterFields(store, problem)),
      this.origin,
      this.announcement,
      make(
        "div",
        { class: "stage" },
        makeBlock(this.row, makeLegend(WATCH_LEGEND)),
        makeBlock(this.inspector.element, this.charts.element),
      ),
    );
  }

  show(names) {
    const { state } = this.store;
    const isOther = names.some((name) => SETTINGS.includes(name));
    const isElsewhere = names.includes("generation") && state.generation !== this.#generation;
    if (isOther || isElsewhere) this.isStale = true;
    if (this.isStale && state.view === "watch") this.#open();
  }

  /** Stop playing once the generation that is being made is there. */
  pause() {
    this.#setPlaying(false);
  }

  destroy() {
    this.session++;
    for (const panel of this.panels) panel.destroy();
  }

  /** The number of the generation that is shown: the latest of all algorithms; -1 before there is one. */
  get #generation() {
    return Math.max(-1, ...this.panels.map(({ generation }) => generation));
  }

  get #isOver() {
    return this.panels.every(({ latest }) => latest?.isOver);
  }

  #setPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.transport.showPlaying(isPlaying);
  }

  /** Begin the runs of the state, and go to its generation. */
  async #open() {
    const { maze, algorithms, seed, parameters, generation } = this.store.state;
    this.destroy();
    this.isStale = false;
    this.#setPlaying(false);
    this.selection = null;
    this.origin.textContent = originText(seed);
    const { session } = this;
    this.panels = algorithms.map((algorithm, i) => this.#makePanel(algorithm, i));
    this.row.replaceChildren(...this.panels.map(({ element }) => element));
    this.row.setAttribute("aria-busy", "true");
    this.opening = Promise.all(this.panels.map((panel) => panel.start(maze, seed, parameters, generation)));
    this.work = this.opening;
    await this.#until(this.opening, session);
    if (session !== this.session) return;
    this.row.removeAttribute("aria-busy");
    this.announcement.textContent = "";
    this.#draw();
    if (this.#isOver) this.#announceResults();
    if (this.#generation !== generation) this.#keepGeneration(); // the run was over before
  }

  #makePanel(algorithm, i) {
    const onpick = (cell) => this.#select(i, (panel) => panel.nearestTo(cell));
    return new RunPanel(algorithm, this.makeWorker, { onpick, ondrive: this.ondrive });
  }

  /** Wait for workers, and report what goes wrong in them. */
  async #until(work, session) {
    try {
      await work;
    } catch (error) {
      if (session !== this.session) return;
      this.session++;
      this.pause();
      this.problem.report(error);
    }
  }

  async #play() {
    if (this.#isOver && this.#generation > 0) this.store.set({ generation: 0 });
    const { session } = this;
    this.#setPlaying(true);
    this.announcement.textContent = "";
    if (this.playedSession === session) return; // it was paused, and has not stopped yet
    this.playedSession = session;
    await this.#until(this.opening, session);
    while (this.isPlaying && session === this.session && !this.#isOver) await this.#playFrame(session);
    if (session !== this.session) return;
    this.playedSession = null;
    this.pause();
    this.#finish();
  }

  /** Make as many generations as the speed asks for until the next picture, or fewer if there is no time for them. */
  async #playFrame(session) {
    const { speed } = this.transport;
    const frame = Math.max(prefersLessMotion() ? CALM_FRAME : FRAME, 1000 / speed);
    const begun = performance.now();
    await this.#advance(Math.max(1, Math.round((speed * frame) / 1000)), frame, session);
    await new Promise((resolve) => setTimeout(resolve, Math.max(0, frame - (performance.now() - begun))));
  }

  async #step() {
    this.pause();
    const { session } = this;
    await this.#until(this.opening, session);
    if (session !== this.session) return;
    await this.#advance(1, Infinity, session);
    this.#finish();
  }

  async #advance(generations, milliseconds, session) {
    this.work = Promise.all(this.panels.map((panel) => panel.advance(generations, milliseconds)));
    await this.#until(this.work, session);
    if (session !== this.session) return;
    this.selection = null;
    this.#draw();
  }

  #finish() {
    if (this.#isOver) this.#announceResults();
    this.#keepGeneration();
  }

  /** The generation that is reached becomes part of the state. */
  #keepGeneration() {
    this.store.set({ generation: this.#generation });
  }

  #announceResults() {
    const results = this.panels.map(({ algorithm, status }) => `${titleOf(algorithm)}: ${status.textContent}`);
    this.announcement.textContent = results.join(" ");
    this.store.set({ result: this.panels[0].latest.result });
  }

  /** Select a robot of the i-th algorithm: the one that `pick` finds in its panel once all workers rest. */
  async #select(i, pick) {
    this.pause();
    const panel = this.panels[i], { session } = this;
    await this.#until(this.work, session);
    if (session !== this.session) return;
    const individual = pick(panel);
    const inspecting = panel.inspect(individual).then((inspection) => {
      this.selection = { panel, individual, inspection };
    });
    await this.#until(inspecting, session);
    if (session === this.session) this.#draw();
  }

  #draw() {
    const { panels, selection } = this;
    for (const panel of panels) panel.show(panel === selection?.panel ? selection.inspection : null);
    this.transport.showGeneration(this.#generation);
    this.charts.show(panels, selection);
    this.inspector.show(panels, selection);
  }
}

/** If a seed is that of an experiment's run, which. */
function originText({ spawnKey: [run] }) {
  if (run === undefined) return "";
  return `Run ${run} of an experiment (those of the book have runs 0 to 499). Change Run to see the others.`;
}
