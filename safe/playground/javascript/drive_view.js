// Drive: one robot by hand, its 16 weights and the path that they give.

import { PARAMETERS } from "./algorithms.js";
import {
  labelled,
  make,
  makeAnnouncement,
  makeBlock,
  makeButton,
  makeControls,
  makeLegend,
  prefersLessMotion,
} from "./dom.js";
import { distanceBetween, readingsAt, SENSORS } from "./maze.js";
import { MazeView } from "./maze_view.js";
import { PresetChoice } from "./preset_choice.js";
import { STEPS, Walker } from "./robot.js";
import { cellsText } from "./text.js";
import { WeightTable } from "./weight_table.js";

const DRIVE_LEGEND = [
  ["ring", "start"],
  ["star", "goal"],
  ["stroke ended", "path, and the robot on it"],
  ["sight", "how far it is to a wall"],
];
const STEP_TIME = 60; // milliseconds between two steps
const DIRECTIONS = { right: [0, 1], left: [0, -1], down: [1, 0], up: [-1, 0] };

export class DriveView {
  /** weights: the numbers, from 1, of those whose sliders take the place of the table; the robot is then at its end. */
  constructor({ store, problem, makeWorker, weights = [] }) {
    this.store = store;
    this.step = weights.length > 0 ? Infinity : 0;
    this.timer = null;
    this.walker = null; // has walked the path that is shown
    this.view = new MazeView({ class: "drive-maze" });
    this.presets = new PresetChoice(store, problem, makeWorker);
    this.weights = new WeightTable((i, weight) => this.#setWeight(i, weight));
    this.playButton = makeButton("Play", () => (this.isPlaying ? this.pause() : this.play()), { class: "primary" });
    const oninput = () => this.#goTo(this.slider.valueAsNumber);
    this.slider = make("input", { type: "range", min: 0, step: 1, oninput });
    this.position = make("p", { class: "status" });
    this.announcement = makeAnnouncement(); // the position, but not while one step follows another
    this.outcome = make("p", { class: "outcome" });
    this.element = make("div", { class: "columns" }, this.#makePathSide(), this.#makeWeightSide(weights));
  }

  #makePathSide() {
    return makeBlock(
      this.view.element,
      makeLegend(DRIVE_LEGEND),
      makeControls(
        this.playButton,
        makeButton("One step", () => this.#goToAndAnnounce(this.step + 1)),
        makeButton("Back to the start", () => this.#goToAndAnnounce(0)),
      ),
      labelled("Step", this.slider, { class: "field wide" }),
      this.position,
      this.announcement,
      this.outcome,
    );
  }

  #makeWeightSide(chosen) {
    if (chosen.length > 0) return makeBlock(...this.weights.alone(chosen));
    return makeBlock(labelled("Weights", this.presets.element), this.presets.explanation, this.weights.element);
  }

  show(names) {
    if (names.includes("maze") || names.includes("controller")) this.presets.forget();
    if (names.some((name) => ["maze", "controller", "parameters", "view"].includes(name))) this.#walk();
  }

  get isPlaying() {
    return this.timer !== null;
  }

  pause() {
    if (this.isPlaying) this.#announce();
    clearInterval(this.timer);
    this.timer = null;
    this.playButton.textContent = "Play";
  }

  destroy() {
    this.pause();
    this.presets.forget();
    this.view.destroy();
  }

  #setWeight(i, weight) {
    const { controller } = this.store.state;
    this.store.set({ controller: controller.map((other, j) => (j === i ? weight : other)) });
  }

  /** Compute the path of the state's controller, and show it. */
  #walk() {
    const { maze, controller, parameters } = this.store.state;
    const { steps = STEPS, success_distance: reach = PARAMETERS.success_distance } = parameters;
    this.weights.show(controller);
    this.walker = new Walker(maze, steps);
    this.walker.walk(controller, 0);
    this.slider.max = steps;
    const distance = distanceBetween(this.walker.position(steps), maze.goal);
    const verdict = distance <= reach ? "a success." : `no success, which takes ${reach} or fewer.`;
    this.outcome.textContent = `After ${steps} steps the robot is ${cellsText(distance)} from the goal: ${verdict}`;
    this.#goTo(Math.min(this.step, steps));
  }

  /** Show the robot at a step of its path. */
  #goTo(step) {
    const { maze, controller } = this.store.state;
    const { walker } = this;
    this.step = Math.min(step, walker.steps);
    if (this.step === walker.steps) this.pause();
    this.slider.value = this.step;
    const robot = walker.position(this.step), readings = readingsAt(maze, robot);
    this.weights.showReadings(readings, controller);
    const distance = cellsText(distanceBetween(robot, maze.goal));
    this.position.textContent = `Step ${this.step}: row ${robot[0]}, column ${robot[1]}, ${distance} from the goal.`;
    this.view.canvas.setAttribute("aria-label", `The maze with the robot's path. ${this.position.textContent}`);
    this.view.show({ maze, paths: [{ cells: walker.route }], robot, rays: raysFrom(robot, readings) });
  }

  #goToAndAnnounce(step) {
    this.#goTo(step);
    this.#announce();
  }

  #announce() {
    this.announcement.textContent = this.position.textContent;
  }

  play() {
    if (this.step === this.walker.steps) this.#goTo(0);
    this.playButton.textContent = "Pause";
    this.timer = setInterval(() => this.#goTo(this.step + 1), prefersLessMotion() ? 10 * STEP_TIME : STEP_TIME);
  }
}

/** From a robot to the nearest wall in each direction. */
function raysFrom([row, column], readings) {
  return Object.entries(DIRECTIONS).map(([direction, [down, right]]) => {
    const reach = readings[SENSORS.indexOf(`dist_${direction}`)];
    return [[row, column], [row + down * reach, column + right * reach]];
  });
}
