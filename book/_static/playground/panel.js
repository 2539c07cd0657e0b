// One algorithm at work: its maze, and how far it has come.

import { Client } from "./client.js";
import { make, makeButton } from "./dom.js";
import { cellsText } from "./drive.js";
import { kindOf, makeSwatch, number3, titleOf } from "./fields.js";
import { MazeView } from "./mazeview.js";

export class Panel {
  /** onpick: called with the number of a solution that is clicked; ondrive: with the best controller, to be driven. */
  constructor(algorithm, makeWorker, { onpick, ondrive }) {
    this.algorithm = algorithm;
    this.client = new Client(makeWorker);
    this.history = []; // of each generation what worker.js tells
    this.now = null; // the last generation, as worker.js tells it
    this.view = new MazeView({}, (cell) => this.now && onpick(this.#nearest(cell)));
    this.status = make("p", { class: "status" });
    const drive = makeButton("Drive the best", () => this.now && ondrive(this.now.result.controller));
    this.element = make(
      "section",
      { class: "panel", "aria-label": titleOf(algorithm) },
      make("h2", {}, makeSwatch(algorithm), titleOf(algorithm)),
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
    this.status.textContent = "…";
    const { algorithm } = this;
    this.#take(await this.client.ask("start", { maze, algorithm, seed, parameters, generation }));
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
    const judged = a === undefined ? "" : ` Judged by a = ${number3(a)}, b = ${number3(b)}.`;
    const end = result.success ? "Success" : "No success";
    this.status.textContent = now.isOver
      ? `${end} in generation ${result.generation}: ${best}, after ${result.evaluations} robots.${judged}`
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
      trail: this.#trail(),
      paths: [{ cells: now.route }, ...(inspected ? [{ cells: inspected.route, colour: "mark" }] : [])],
      robot: now.end,
      links: inspected ? inspected.neighbours.map(({ point }) => [inspected.endpoint, point]) : [],
      marked: inspected?.endpoint,
    });
  }

  destroy() {
    this.client.close();
    this.view.destroy();
  }

  #take(report) {
    this.history.push(...report.history);
    this.now = report;
  }

  /** Where the best robot so far ended, from the first generation to this. */
  #trail() {
    const cells = this.history.map(({ endpoint }) => endpoint);
    return cells.filter((cell, i) => i === 0 || cell.join() !== cells[i - 1].join());
  }

  #nearest({ row, column }) {
    const distances = this.now.ends.map(([r, c]) => Math.abs(r - row) + Math.abs(c - column));
    return distances.indexOf(Math.min(...distances));
  }
}
