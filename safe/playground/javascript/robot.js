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

/** Walks in one maze, all of the same number of steps. */
export class Walker {
  constructor(maze, steps) {
    const cells = maze.height * maze.width;
    this.maze = maze;
    this.steps = steps;
    this.trail = new Int32Array(Math.min(steps, cells) + 1); // the cells that the robot has stood on
    this.stoodAt = new Float64Array(cells).fill(-1); // the time when it last stood on a cell
    this.clock = 0; // goes on from walk to walk, so that nothing need be cleared
    this.length = 0; // cells in the trail
    this.loopStart = 0; // the place in the trail to which the path has come back
  }

  /** Walk by the 16 weights that begin at a place of `genomes`. */
  walk(genomes, place) {
    const { maze, steps, trail, stoodAt, clock } = this;
    const { walls, sensors, height, width } = maze;
    const p1 = genomes[place], p2 = genomes[place + 1], p3 = genomes[place + 2], p4 = genomes[place + 3];
    const p5 = genomes[place + 4], p6 = genomes[place + 5], p7 = genomes[place + 6], p8 = genomes[place + 7];
    const p9 = genomes[place + 8], p10 = genomes[place + 9], p11 = genomes[place + 10], p12 = genomes[place + 11];
    const p13 = genomes[place + 12], p14 = genomes[place + 13], p15 = genomes[place + 14], p16 = genomes[place + 15];
    let [row, column] = maze.start;
    this.clock += steps + 1;
    for (let step = 0; step <= steps; step++) {
      let cell = row * width + column;
      if (stoodAt[cell] >= clock) {
        this.length = step;
        this.loopStart = stoodAt[cell] - clock;
        return;
      }
      stoodAt[cell] = clock + step;
      trail[step] = cell;
      const s = 8 * cell;
      const s1 = sensors[s], s2 = sensors[s + 1], s3 = sensors[s + 2], s4 = sensors[s + 3];
      const s5 = sensors[s + 4], s6 = sensors[s + 5], s7 = sensors[s + 6], s8 = sensors[s + 7];
      const h = p1 * s1 + p2 * s2 + p3 * s3 + p4 * s4 + p5 * s5 + p6 * s6 + p7 * s7 + p8 * s8;
      const v = p9 * s1 + p10 * s2 + p11 * s3 + p12 * s4 + p13 * s5 + p14 * s6 + p15 * s7 + p16 * s8;
      if (h >= 0) {
        if (column + 1 < width && !walls[cell + 1]) column++;
      } else if (column > 0 && !walls[cell - 1]) column--;
      cell = row * width + column;
      if (v >= 0) {
        if (row + 1 < height && !walls[cell + width]) row++;
      } else if (row > 0 && !walls[cell - width]) row--;
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
