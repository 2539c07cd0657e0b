// One run on the watch: the maze with its generation, and how far it has come.

import { make, makeButton } from "./dom.js";
import { kindOf, makeSwatch, summaryOf, titleOf, wordOf } from "./labels.js";
import { distanceBetween } from "./maze.js";
import { MazeView } from "./maze_view.js";
import { cellsText, shortNumber } from "./text.js";
import { WorkerClient } from "./worker_client.js";

const MOST_LINKS = 100; // to neighbours that are drawn
const SLICE = 200; // milliseconds of computing on the way to a generation, after which the panel says how far it is

export class RunPanel {
  /** onpick: called with the { row, column } that is clicked; ondrive: with the best controller, to be driven. */
  constructor(algorithm, makeWorker, { onpick, ondrive }) {
    this.algorithm = algorithm;
    this.client = new WorkerClient(makeWorker);
    this.history = []; // a line for each generation; see worker.js, also for the next one
    this.latest = null; // the last generation
    this.trail = []; // where the best robot so far ended, from the first generation to this
    this.view = new MazeView({}, (cell) => this.latest && onpick(cell));
    this.status = make("p", { class: "status" });
    this.element = make(
      "section",
      { class: "panel", "aria-label": titleOf(algorithm) },
      make("h2", {}, makeSwatch(algorithm), titleOf(algorithm)),
      make("p", { class: "note" }, summaryOf(algorithm)),
      this.view.element,
      this.status,
      makeButton("Drive the best", () => this.latest && ondrive(this.latest.result.controller)),
    );
  }

  destroy() {
    this.client.close();
    this.view.destroy();
  }

  /** The number of the last generation; -1 before the first. */
  get generation() {
    return this.latest ? this.latest.result.generation : -1;
  }

  /** Begin the run, and go to a generation. */
  async start(maze, seed, parameters, generation) {
    this.maze = maze;
    this.view.show({ maze });
    const { algorithm } = this;
    this.#add(await this.client.ask("start", { maze, algorithm, seed, parameters }));
    while (this.generation < generation && !this.latest.isOver) {
      await this.advance(generation - this.generation, SLICE);
      this.status.textContent = `Generation ${this.generation} …`;
    }
  }

  /** Make so many further generations, or fewer if they take longer than some milliseconds. */
  async advance(generations, milliseconds) {
    if (!this.latest.isOver) this.#add(await this.client.ask("advance", { generations, milliseconds }));
  }

  #add(progress) {
    for (const line of progress.history) {
      this.history.push(line);
      if (line.endpoint.join() !== this.trail.at(-1)?.join()) this.trail.push(line.endpoint);
    }
    this.latest = progress;
  }

  /** What the worker says of the i-th solution. */
  inspect(individual) {
    return this.client.ask("inspect", { individual });
  }

  /** The number of the solution of the generation that ended nearest to a cell. */
  nearestTo({ row, column }) {
    const distances = this.latest.ends.map((end) => distanceBetween(end, [row, column]));
    return distances.indexOf(distances.reduce((least, distance) => Math.min(least, distance)));
  }

  /** Show the last generation, and in it the solution of an inspection, or none if that is null.
   *
   * isLinking: are all goals linked to their favourites, or only those of which the solution is it? */
  show(inspection, isLinking) {
    const { latest, status, algorithm } = this;
    status.textContent = statusText(latest, algorithm);
    this.element.classList.toggle("success", latest.result.success);
    this.view.canvas.setAttribute(
      "aria-label",
      `${titleOf(this.algorithm)}: the maze with where the ${latest.ends.length} robots of generation ` +
        `${latest.result.generation} ended, ${latest.archive.length} points of the archive, ` +
        `${latest.goals.length > 0 ? `the places of ${latest.goals.length} goals, ` : ""}and the best path. ` +
        status.textContent,
    );
    const { route, endpoint, neighbours } = inspection ?? { neighbours: [] };
    const linked = latest.goals.filter(({ favourite }) => isLinking || `${favourite}` === `${endpoint}`);
    this.view.show({
      maze: this.maze,
      archive: latest.archive,
      ends: latest.ends,
      colour: kindOf(this.algorithm),
      trail: this.trail,
      paths: [{ cells: latest.route }, ...(inspection ? [{ cells: route, colour: "mark" }] : [])],
      robot: latest.end,
      places: latest.goals.map(({ place }) => place),
      favourites: linked.map(({ place, favourite }) => [place, favourite]),
      links: neighbours.slice(0, MOST_LINKS).map(({ point }) => [endpoint, point]),
      marked: endpoint,
    });
  }
}

/** How far a run has come, in words. */
function statusText({ result, isOver, goal }, { components, objectives, pool }) {
  const { success, generation, distance, evaluations, coefficients } = result;
  const best = `best ${cellsText(distance)} from the goal`;
  if (!isOver) return `Generation ${generation}: ${best}.`;
  const outcome = success ? "Success" : "No success", robots = `after ${evaluations} robots.`;
  const isJudged = objectives?.length !== 0;
  // in random search generations mean nothing
  if (!isJudged && pool === "generation") return `${outcome}: ${best}, ${robots}`;
  const time = success ? `in generation ${generation}` : `in ${generation + 1} generations`;
  const weighed = components.map((name, c) => `${shortNumber(coefficients[c] ?? 0)} · ${wordOf(name)}`).join(" + ");
  const judge = goal ? `how near it came to the place (${goal.row}, ${goal.column})` : weighed;
  return `${outcome} ${time}: ${best}, ${robots}${isJudged ? ` Its fitness: ${judge}.` : ""}`;
}
