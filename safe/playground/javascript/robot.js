// The robot: a controller of 16 weights that walks the maze for a fixed number of steps (see safe/robot.py).
//
// Where it goes next depends only on where it stands, so a path that comes back to a cell repeats from there for ever,
// and its end follows without walking on.

import { checkedInteger, checkedRow, MOST } from "./checks.js";

export const WEIGHTS = 16; // p1..p16
export const STEPS = 300;

/** The cells that the robot stands on, [row, column] each, the start first; steps + 1 of them. */
export function path(maze, controller, steps = STEPS) {
  const walker = new Walker(maze, checkedInteger("steps", steps, 0, MOST));
  walker.walk(checkedRow("controller", controller, WEIGHTS, -1, 1), 0);
  return Array.from({ length: steps + 1 }, (_, step) => walker.position(step));
}

// directions in which a cell can be left
const RIGHTWARDS = 1, LEFTWARDS = 2, DOWNWARDS = 4, UPWARDS = 8;
const LATEST = 2 ** 30; // time: beyond, a browser may keep numbers in a slower form

/** Walks in one maze, all of the same number of steps. */
export class Walker {
  constructor(maze, steps) {
    const cells = maze.height * maze.width;
    this.maze = maze;
    this.steps = steps;
    this.exits = exitsOf(maze);
    this.trail = new Int32Array(Math.min(steps, cells) + 1); // the cells that the robot has stood on
    this.stoodAt = new Int32Array(cells).fill(-1); // the time when it last stood on a cell
    this.clock = 0; // goes on from walk to walk, so that nothing need be cleared
    this.length = 0; // cells in the trail
    this.loopStart = 0; // the place in the trail to which the path has come back
  }

  /** Walk by the 16 weights that begin at a place of `genomes`. */
  walk(genomes, place) {
    const { maze, steps, exits, trail, stoodAt } = this;
    const { sensors, width, start } = maze;
    const p1 = genomes[place], p2 = genomes[place + 1], p3 = genomes[place + 2], p4 = genomes[place + 3];
    const p5 = genomes[place + 4], p6 = genomes[place + 5], p7 = genomes[place + 6], p8 = genomes[place + 7];
    const p9 = genomes[place + 8], p10 = genomes[place + 9], p11 = genomes[place + 10], p12 = genomes[place + 11];
    const p13 = genomes[place + 12], p14 = genomes[place + 13], p15 = genomes[place + 14], p16 = genomes[place + 15];
    if (this.clock > LATEST - 2 * (steps + 1)) {
      stoodAt.fill(-1);
      this.clock = 0;
    }
    const { clock } = this;
    this.clock += steps + 1;
    let cell = start[0] * width + start[1];
    for (let step = 0; step <= steps; step++) {
      if (stoodAt[cell] >= clock) {
        this.length = step;
        this.loopStart = stoodAt[cell] - clock;
        return;
      }
      stoodAt[cell] = clock + step;
      trail[step] = cell;
      const s = cell << 3; // with | rather than +, an index needs no check for overflow
      const s1 = sensors[s], s2 = sensors[s | 1], s3 = sensors[s | 2], s4 = sensors[s | 3];
      const s5 = sensors[s | 4], s6 = sensors[s | 5], s7 = sensors[s | 6], s8 = sensors[s | 7];
      const h = p1 * s1 + p2 * s2 + p3 * s3 + p4 * s4 + p5 * s5 + p6 * s6 + p7 * s7 + p8 * s8;
      const v = p9 * s1 + p10 * s2 + p11 * s3 + p12 * s4 + p13 * s5 + p14 * s6 + p15 * s7 + p16 * s8;
      if (h >= 0) {
        if (exits[cell] & RIGHTWARDS) cell++;
      } else if (exits[cell] & LEFTWARDS) cell--;
      if (v >= 0) {
        if (exits[cell] & DOWNWARDS) cell += width;
      } else if (exits[cell] & UPWARDS) cell -= width;
    }
    this.length = steps + 1;
    this.loopStart = steps;
  }

  /** The cells that the robot of the last walk has stood on, [row, column] each, until its path came back to one. */
  get route() {
    return Array.from({ length: this.length }, (_, step) => this.position(step));
  }

  /** The number of the cell where the robot of the last walk stands at a step. */
  cellAt(step) {
    const { trail, length, loopStart } = this;
    return trail[step < length ? step : loopStart + ((step - loopStart) % (length - loopStart))];
  }

  /** The same as [row, column]. */
  position(step) {
    const cell = this.cellAt(step), width = this.maze.width;
    return [Math.floor(cell / width), cell % width];
  }
}

/** In which directions each cell can be left. */
function exitsOf({ walls, height, width }) {
  const isOpen = (row, column) =>
    row >= 0 && row < height && column >= 0 && column < width && !walls[row * width + column];
  return Uint8Array.from(walls, (_, cell) => {
    const row = Math.floor(cell / width), column = cell % width;
    return (isOpen(row, column + 1) ? RIGHTWARDS : 0) | (isOpen(row, column - 1) ? LEFTWARDS : 0) |
      (isOpen(row + 1, column) ? DOWNWARDS : 0) | (isOpen(row - 1, column) ? UPWARDS : 0);
  });
}
