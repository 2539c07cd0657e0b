// One algorithm at work: its maze, and how far it has come.

import { Client } from "./client.js";
import { make, makeButton } from "./dom.js";
import { cellsText } from "./drive.js";
import { aboutOf, kindOf, makeSwatch, number3, titleOf } from "./fields.js";
import { distanceBetween } from "./maze.js";
import { MazeView } from "./mazeview.js";

const MOST_LINKS = 100; // to neighbours that are drawn
const SLICE = 200; // milliseconds of computing on the way to a generation, after which it is told how far it is

export class Panel {
  /** onpick: called with the { row, column } that is clicked; ondrive: with the best controller, to be driven. */
  constructor(algorithm, makeWorker, { onpick, ondrive }) {
    this.algorithm = algorithm;
    this.client = new Client(makeWorker);
    this.history = []; // of each generation what worker.js tells
    this.trail = []; // where the best robot so far ended, from the first generation to this
    this.now = null; // the last generation, as worker.js tells it
    this.view = new MazeView({}, (cell) => this.now && onpick(cell));
    this.status = make("p", { class: "status" });
    const drive = makeButton("Drive the best", () => this.now && ondrive(this.now.result.controller));
    this.element = make(
      "section",
      { class: "panel", "aria-label": titleOf(algorithm) },
      make("h2", {}, makeSwatch(algorithm), titleOf(algorithm)),
      make("p", { class: "note" }, aboutOf(algorithm)),
      this.view.element,
      this.status,
      drive,
    );
  }

  get generation() {
    return this.now ? this.now.result.generation : -1;
  }

  async start(maze, seed, parameters, generation) {
    this.maze = maze;
    this.view.show({ maze });
    const { algorithm } = this;
    this.#take(await this.client.ask("start", { maze, algorithm, seed, parameters }));
    while (this.generation < generation && !this.now.isOver) {
      await this.advance(generation - this.generation, SLICE);
      this.status.textContent = `Generation ${this.generation} …`;
    }
  }

  async advance(generations, milliseconds) {
    if (!this.now.isOver) this.#take(await this.client.ask("advance", { generations, milliseconds }));
  }

  /** What worker.js tells of the i-th solution. */
  inspect(individual) {
    return this.client.ask("inspect", { individual });
  }

  /** Show the generation, and one solution as worker.js told of it, or null. */
  show(inspected) {
    const { maze, now } = this;
    const { result } = now;
    const best = `best ${cellsText(result.distance)} from the goal`;
    const [a, b] = result.coefficients;
    const isJudged = a !== undefined; // in random search nobody is, and there are no generations
    const inWords = result.success
      ? `Success in generation ${result.generation}`
      : `No success in ${result.generation + 1} generations`;
    const outcome = isJudged ? inWords : result.success ? "Success" : "No success";
    const judged = isJudged ? ` Its fitness: ${number3(a)} · closeness + ${number3(b)} · novelty.` : "";
    this.status.textContent = now.isOver
      ? `${outcome}: ${best}, after ${result.evaluations} robots.${judged}`
      : `Generation ${result.generation}: ${best}.`;
    this.element.classList.toggle("success", result.success);
    this.view.canvas.setAttribute(
      "aria-label",
      `${titleOf(this.algorithm)}: the maze with where the ${now.ends.length} robots of generation ` +
        `${result.generation} ended, ${now.archive.length} points of the archive, and the best path. ${this.status.textContent}`,
    );
    this.view.show({
      maze,
      archive: now.archive,
      ends: now.ends,
      colour: kindOf(this.algorithm),
      trail: this.trail,
      paths: [{ cells: now.route }, ...(inspected ? [{ cells: inspected.route, colour: "mark" }] : [])],
      robot: now.end,
      links: inspected ? inspected.neighbours.slice(0, MOST_LINKS).map(({ point }) => [inspected.endpoint, point]) : [],
      marked: inspected?.endpoint,
    });
  }

  destroy() {
    this.client.close();
    this.view.destroy();
  }

  #take(report) {
    for (const line of report.history) {
      this.history.push(line);
      if (line.endpoint.join() !== this.trail.at(-1)?.join()) this.trail.push(line.endpoint);
    }
    this.now = report;
  }

  /** The number of the solution of the generation that ended nearest to a cell. */
  nearest({ row, column }) {
    const distances = this.now.ends.map((end) => distanceBetween(end, [row, column]));
    return distances.indexOf(distances.reduce((least, distance) => Math.min(least, distance)));
  }
}
