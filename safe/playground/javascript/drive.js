// Drive: 16 weights by hand, and the path that they give.

import { PARAMETERS } from "./algorithms.js";
import { Client } from "./client.js";
import { labelled, make, makeButton, makeLegend, makeSelect, prefersLessMotion } from "./dom.js";
import { distanceBetween, SENSORS } from "./maze.js";
import { MazeView } from "./mazeview.js";
import { PRESETS } from "./presets.js";
import { STEPS, Walker, WEIGHTS } from "./robot.js";

const DRIVEN = [
  ["ring", "start"],
  ["star", "goal"],
  ["stroke", "path"],
  ["sight", "how far it is to a wall"],
];
const PAUSE = 60; // milliseconds between two steps
const DIRECTIONS = { right: [0, 1], left: [0, -1], down: [1, 0], up: [-1, 0] };

export class DriveView {
  constructor(store, { report, makeWorker }) {
    this.store = store;
    this.report = report;
    this.makeWorker = makeWorker;
    this.step = 0;
    this.timer = null;
    this.walker = null; // has walked the path that is shown
    this.view = new MazeView({ class: "drive-maze" });
    this.play = makeButton("Play", () => (this.timer ? this.pause() : this.#start()), { class: "primary" });
    this.slider = make("input", {
      type: "range",
      min: 0,
      step: 1,
      oninput: () => this.#stand(this.slider.valueAsNumber),
    });
    this.where = make("p", { class: "status" });
    this.said = make("p", { class: "unseen", role: "status" }); // the same, where it is not one of many
    this.client = null; // evolves weights to start from
    this.outcome = make("p", { class: "outcome" });
    this.sliders = Array.from({ length: WEIGHTS }, (_, i) => this.#makeSlider(i));
    this.readings = SENSORS.map(() => make("td", { class: "number" }));
    this.sums = ["h", "v"].map(() => make("td", { class: "number" }));
    const presets = PRESETS.map(({ title }, i) => [i, title]);
    const choice = makeSelect([["", "choose…"], ...presets, ["random", "random weights"]], (value) => {
      if (value !== "") this.#take(value);
      choice.value = "";
    });
    this.explained = make("p", { class: "note", role: "status" });
    this.element = make(
      "div",
      { class: "columns" },
      make(
        "div",
        {},
        this.view.element,
        makeLegend(DRIVEN),
        make(
          "div",
          { class: "controls" },
          this.play,
          makeButton("One step", () => this.#standAndSay(this.step + 1)),
          makeButton("Back to the start", () => this.#standAndSay(0)),
        ),
        labelled("Step", this.slider, { class: "field wide" }),
        this.where,
        this.said,
        this.outcome,
      ),
      make(
        "div",
        {},
        labelled("Weights", choice),
        this.explained,
        make(
          "table",
          { class: "weights" },
          make(
            "caption",
            {},
            "What the robot reads where it stands: dist is how far the next wall is; goal is the size of the maze on the " +
              "sides where the goal lies, and 0 on the others",
          ),
          make(
            "thead",
            {},
            make(
              "tr",
              {},
              ...[
                "Sensor",
                "Reading",
                "Weight in h (right if h ≥ 0, else left)",
                "Weight in v (down if v ≥ 0, else up)",
              ].map((text, i) => make("th", { scope: "col", class: i === 1 ? "number" : null }, text)),
            ),
          ),
          make(
            "tbody",
            {},
            ...SENSORS.map((sensor, i) =>
              make(
                "tr",
                {},
                make("th", { scope: "row" }, sensor.replace("_", " ")),
                this.readings[i],
                make("td", {}, this.sliders[i].element),
                make("td", {}, this.sliders[i + SENSORS.length].element),
              ),
            ),
            make("tr", { class: "sums" }, make("th", { scope: "row" }, "sum"), make("td"), ...this.sums),
          ),
        ),
      ),
    );
  }

  show(names) {
    if (names.includes("maze") || names.includes("controller")) this.#forget();
    if (names.some((name) => ["maze", "controller", "parameters", "view"].includes(name))) this.#walk();
  }

  /** Another view is shown from now on. */
  pause() {
    if (this.timer) this.said.textContent = this.where.textContent;
    clearInterval(this.timer);
    this.timer = null;
    this.play.textContent = "Play";
  }

  destroy() {
    this.pause();
    this.#forget();
    this.view.destroy();
  }

  #makeSlider(i) {
    const sensor = SENSORS[i % SENSORS.length].replace("_", " "),
      sum = i < SENSORS.length ? "h" : "v";
    const shown = make("output");
    const field = make("input", {
      type: "range",
      min: -1,
      max: 1,
      step: "any",
      "aria-label": `p${i + 1}: ${sensor} in ${sum}`,
      oninput: () => this.#weigh(i, Math.round(field.valueAsNumber * 100) / 100),
      onkeydown: (event) => {
        const change = {
          ArrowRight: 0.05,
          ArrowUp: 0.05,
          ArrowLeft: -0.05,
          ArrowDown: -0.05,
          PageUp: 0.25,
          PageDown: -0.25,
        };
        if (!Object.hasOwn(change, event.key)) return;
        event.preventDefault();
        const weight = Math.round((field.valueAsNumber + change[event.key]) * 100) / 100;
        this.#weigh(i, Math.min(1, Math.max(-1, weight)));
      },
    });
    const show = (weight) => {
      field.value = weight;
      field.setAttribute("aria-valuetext", weight.toFixed(2));
      shown.value = weight.toFixed(2);
    };
    return { element: make("label", { class: "weight" }, make("span", {}, `p${i + 1}`), field, shown), show };
  }

  #weigh(i, weight) {
    const controller = [...this.store.state.controller];
    controller[i] = weight;
    this.store.set({ controller });
  }

  async #take(choice) {
    const maze = this.store.state.maze;
    if (choice === "random") {
      this.store.set({
        controller: Array.from({ length: WEIGHTS }, () => Math.round(200 * Math.random() - 100) / 100),
      });
      return;
    }
    const { explanation, controller, run } = PRESETS[choice];
    if (controller) this.store.set({ controller });
    else {
      this.#forget();
      this.explained.textContent = "Evolving …";
      this.client = new Client(this.makeWorker);
      try {
        const { controller: found } = await this.client.ask("evolve", { maze, parameters: {}, ...run(maze) });
        this.store.set({ controller: found });
      } catch (error) {
        this.#forget();
        this.report(error);
        return;
      }
    }
    this.explained.textContent = explanation;
  }

  /** What was explained or is being evolved is of other weights, or of another maze. */
  #forget() {
    this.client?.close();
    this.client = null;
    this.explained.textContent = "";
  }

  #standAndSay(step) {
    this.#stand(step);
    this.said.textContent = this.where.textContent;
  }

  /** Work the path out, and show it. */
  #walk() {
    const { maze, controller, parameters } = this.store.state;
    const steps = parameters.steps ?? STEPS;
    controller.forEach((weight, i) => this.sliders[i].show(weight));
    this.walker = new Walker(maze, steps);
    this.walker.walk(controller, 0);
    this.slider.max = steps;
    const distance = distanceBetween(this.walker.position(steps), maze.goal);
    const reached = parameters.success_distance ?? PARAMETERS.success_distance;
    this.outcome.textContent =
      `After ${steps} steps the robot is ${cellsText(distance)} from the goal: ` +
      (distance <= reached ? "a success." : `no success, which takes ${reached} or fewer.`);
    this.#stand(Math.min(this.step, steps));
  }

  #stand(step) {
    const { maze, controller } = this.store.state;
    const { walker } = this;
    this.step = Math.min(step, walker.steps);
    if (this.step === walker.steps) this.pause();
    this.slider.value = this.step;
    const robot = walker.position(this.step);
    const place = 8 * (robot[0] * maze.width + robot[1]);
    const readings = [...maze.sensors.subarray(place, place + SENSORS.length)];
    readings.forEach((reading, i) => (this.readings[i].textContent = reading));
    const sums = [0, SENSORS.length].map((first) =>
      readings.reduce((sum, reading, i) => sum + controller[first + i] * reading, 0),
    );
    const goes = [sums[0] >= 0 ? "right" : "left", sums[1] >= 0 ? "down" : "up"];
    ["h", "v"].forEach((name, i) => (this.sums[i].textContent = `${name} = ${sums[i].toFixed(1)}: ${goes[i]}`));
    const distance = cellsText(distanceBetween(robot, maze.goal));
    this.where.textContent = `Step ${this.step}: row ${robot[0]}, column ${robot[1]}, ${distance} from the goal.`;
    const rays = Object.entries(DIRECTIONS).map(([direction, [down, right]]) => {
      const reach = readings[SENSORS.indexOf(`dist_${direction}`)];
      return [robot, [robot[0] + down * reach, robot[1] + right * reach]];
    });
    this.view.canvas.setAttribute("aria-label", `The maze with the robot's path. ${this.where.textContent}`);
    this.view.show({ maze, paths: [{ cells: walker.route }], robot, rays });
  }

  #start() {
    if (this.step === this.walker.steps) this.#stand(0);
    this.play.textContent = "Pause";
    const pause = prefersLessMotion() ? 10 * PAUSE : PAUSE;
    this.timer = setInterval(() => this.#stand(this.step + 1), pause);
  }
}

/** So many cells, in words. */
export function cellsText(count) {
  return `${count} cell${count === 1 ? "" : "s"}`;
}
