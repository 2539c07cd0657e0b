// The runs that are watched side by side.

import { titleOf } from "./labels.js";

export class RunGroup {
  /** panels: a RunPanel for each run. */
  constructor(panels = []) {
    this.panels = panels;
    this.opening = this.work = null; // promises: of the generation that is shown first, of what was asked for last
  }

  destroy() {
    for (const panel of this.panels) panel.destroy();
  }

  /** Begin the runs, and go to a generation. */
  open({ maze, seed, parameters, generation }) {
    this.opening = Promise.all(this.panels.map((panel) => panel.start(maze, seed, parameters, generation)));
    this.work = this.opening;
  }

  /** Make so many further generations, or fewer if they take longer than some milliseconds. */
  advance(generations, milliseconds) {
    this.work = Promise.all(this.panels.map((panel) => panel.advance(generations, milliseconds)));
  }

  /** The number of the latest generation of all runs; -1 before there is one. */
  get generation() {
    return Math.max(-1, ...this.panels.map(({ generation }) => generation));
  }

  get isOver() {
    return this.panels.every(({ latest }) => latest?.isOver);
  }

  /** How far the runs have come, in words. */
  get summary() {
    return this.panels.map(({ algorithm, status }) => `${titleOf(algorithm)}: ${status.textContent}`).join(" ");
  }
}
