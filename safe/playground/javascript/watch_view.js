// Watch: algorithms at work on one maze, side by side, generation by generation.

import { make, makeAnnouncement, makeBlock, makeControls, makeLegend, prefersLessMotion } from "./dom.js";
import { makeAlgorithmChoice, makeParameterFields, makeRunField, makeSeedField } from "./fields.js";
import { Inspector } from "./inspector.js";
import { kindOf } from "./labels.js";
import { RunGroup } from "./run_group.js";
import { RunPanel } from "./run_panel.js";
import { SETTINGS } from "./store.js";
import { Transport } from "./transport.js";
import { WatchCharts } from "./watch_charts.js";

const WATCH_LEGEND = [
  ["ring", "start"],
  ["star", "goal"],
  ["dots", "where robots of this generation ended (larger: several)"],
  ["faint", "archive"],
  ["stroke ended", "path of the best robot so far, and its end"],
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
    this.group = new RunGroup(); // the runs that are shown; whatever comes of an earlier group is dropped
    this.isStale = true; // does the group have other settings than the state?
    this.isPlaying = false;
    this.playedGroup = null;
    this.selection = null; // { panel, individual, inspection } of the robot that is looked at

    this.ondrive = (controller) => store.set({ controller, view: "drive" });
    this.transport = new Transport(store, problem, {
      onplay: () => (this.isPlaying ? this.pause() : this.play()),
      onstep: () => this.#step(),
    });
    this.announcement = makeAnnouncement();
    this.origin = make("p", { class: "note" });
    this.row = make("div", { class: "panels" });
    this.legend = makeLegend(WATCH_LEGEND);
    this.charts = new WatchCharts();
    this.linking = make("input", { type: "checkbox", onchange: () => this.#draw() });
    this.goalsKey = makeBlock( // shown only with goals
      makeLegend([["cross", "places that goals name"]]),
      make("label", { class: "choice" }, this.linking, "link places to their favourites, the robots nearest to them"),
    );
    this.goalsKey.hidden = true;
    this.inspector = new Inspector({
      onselect: (i, individual) => this.select(i, () => individual),
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
        makeBlock(this.row, this.legend, this.goalsKey),
        makeBlock(this.inspector.element, this.charts.element),
      ),
    );
  }

  show(names) {
    const { state } = this.store;
    const isOther = names.some((name) => SETTINGS.includes(name));
    const isElsewhere = names.includes("generation") && state.generation !== this.group.generation;
    if (isOther || isElsewhere) this.isStale = true;
    if (this.isStale && state.view === "watch") this.#open();
  }

  /** What becomes part of the state once the view is paused. */
  get reached() {
    return { generation: Math.max(this.store.state.generation, this.group.generation) };
  }

  /** Stop playing once the generation that is being made is there. */
  pause() {
    this.#setPlaying(false);
  }

  destroy() {
    this.group.destroy();
    this.group = new RunGroup();
  }

  #setPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.transport.showPlaying(isPlaying);
  }

  /** Begin the runs of the state, and go to its generation. */
  async #open() {
    const { state } = this.store, { generation } = state;
    this.destroy();
    this.isStale = false;
    this.pause();
    this.selection = null;
    this.origin.textContent = originText(state.seed);
    const group = new RunGroup(state.algorithms.map((algorithm, i) => this.#makePanel(algorithm, i)));
    this.group = group;
    this.row.replaceChildren(...group.panels.map(({ element }) => element));
    this.#colourLegend(state.algorithms);
    this.row.setAttribute("aria-busy", "true");
    group.open(state);
    if (!await this.#isDone(group.opening, group)) return;
    this.row.removeAttribute("aria-busy");
    this.announcement.textContent = "";
    this.#draw();
    if (group.isOver) this.#announceResults();
    if (group.generation !== generation) this.#keepGeneration(); // the run was over before
  }

  /** Show the dots of all algorithms in the legend. */
  #colourLegend(algorithms) {
    const dots = algorithms.map((algorithm) => make("span", { class: `key dot ${kindOf(algorithm)}` }));
    this.legend.querySelector(".dots").replaceChildren(...dots);
  }

  #makePanel(algorithm, i) {
    const onpick = (cell) => this.select(i, (panel) => panel.nearestTo(cell));
    return new RunPanel(algorithm, this.makeWorker, { onpick, ondrive: this.ondrive });
  }

  /** Wait for the workers of a group, and report what goes wrong. Are they done, and is the group still shown? */
  async #isDone(work, group) {
    try {
      await work;
      return group === this.group;
    } catch (error) {
      if (group === this.group) {
        this.pause();
        this.problem.report(error);
      }
      return false;
    }
  }

  async play() {
    if (this.group.isOver && this.group.generation > 0) this.store.set({ generation: 0 }); // which opens another group
    const { group } = this;
    this.#setPlaying(true);
    this.announcement.textContent = "";
    if (this.playedGroup === group) return; // it was paused, and has not stopped yet
    this.playedGroup = group;
    let isDone = await this.#isDone(group.opening, group);
    while (isDone && this.isPlaying && !group.isOver) isDone = await this.#playFrame(group);
    if (group !== this.group) return;
    this.playedGroup = null;
    this.pause();
    if (isDone) this.#finish();
  }

  /** Make as many generations as the speed asks for until the next picture, or fewer if there is no time for them. */
  async #playFrame(group) {
    const { speed } = this.transport;
    const frame = Math.max(prefersLessMotion() ? CALM_FRAME : FRAME, 1000 / speed);
    const begun = performance.now();
    const isDone = await this.#advance(group, Math.max(1, Math.round((speed * frame) / 1000)), frame);
    await new Promise((resolve) => setTimeout(resolve, Math.max(0, frame - (performance.now() - begun))));
    return isDone && group === this.group;
  }

  async #step() {
    this.pause();
    const { group } = this;
    const isReady = await this.#isDone(group.opening, group);
    if (isReady && await this.#advance(group, 1, Infinity)) this.#finish();
  }

  /** Make further generations and show the last. Are they made, and is the group still shown? */
  async #advance(group, generations, milliseconds) {
    group.advance(generations, milliseconds);
    if (!await this.#isDone(group.work, group)) return false;
    this.selection = null;
    this.#draw();
    return true;
  }

  #finish() {
    if (this.group.isOver) this.#announceResults();
    this.#keepGeneration();
  }

  /** The generation that is reached becomes part of the state. */
  #keepGeneration() {
    this.store.set({ generation: this.group.generation });
  }

  #announceResults() {
    this.announcement.textContent = this.group.summary;
    this.store.set({ result: this.group.panels[0].latest.result });
  }

  /** Select a robot of the i-th algorithm: the one that `pick` finds in its panel once all workers rest. */
  async select(i, pick) {
    this.pause();
    const { group } = this, panel = group.panels[i];
    if (!await this.#isDone(group.work, group)) return;
    const individual = pick(panel);
    const inspecting = panel.inspect(individual).then((inspection) => {
      this.selection = { panel, individual, inspection };
    });
    if (await this.#isDone(inspecting, group)) this.#draw();
  }

  #draw() {
    const { selection, group: { panels, generation } } = this;
    for (const panel of panels) {
      panel.show(panel === selection?.panel ? selection.inspection : null, this.linking.checked);
    }
    this.goalsKey.hidden = !panels.some(({ latest }) => latest.goals.length > 0);
    this.transport.showGeneration(generation);
    this.charts.show(panels, selection);
    this.inspector.show(panels, selection);
  }
}

/** If a seed is that of an experiment's run, which. */
function originText({ spawnKey: [run] }) {
  if (run === undefined) return "";
  return `Run ${run} of an experiment (those of the book have runs 0 to 499). Change Run to see the others.`;
}
