// The maze: a grid of open and wall cells, a start, a goal, and what a robot senses in each cell (see safe/maze.py).
//
// Cells are numbered row by row; the cell in row r and column c is number r * width + c.

import { InputError } from "./checks.js";

export const SENSORS = [
  "dist_right",
  "goal_right",
  "dist_left",
  "goal_left",
  "dist_down",
  "goal_down",
  "dist_up",
  "goal_up",
];
export const LONGEST_SIDE = 2048; // cells

/** A maze from its cells, checked.
 *
 * walls: height * width values, 1 for a wall; start and goal: [row, column], open cells that are connected.
 * Returns { name, height, width, walls, start, goal, sensors }; `sensors` holds eight readings a cell. */
export function makeMaze(walls, height, width, start, goal, name = "maze") {
  for (const [end, [row, column]] of [["start", start], ["goal", goal]]) {
    if (row < 0 || row >= height || column < 0 || column >= width) {
      throw new InputError(
        `${end} must be a (row, column) within the ${height} by ${width} cells; got (${row}, ${column})`,
      );
    }
    if (walls[row * width + column]) {
      throw new InputError(`${end} must be an open cell; got (${row}, ${column}), which is wall`);
    }
  }
  if (start[0] === goal[0] && start[1] === goal[1]) {
    throw new InputError(`goal must differ from the start; got (${goal.join(", ")}) for both`);
  }
  const ways = waysToGoal({ walls, height, width, goal });
  if (ways[start[0] * width + start[1]] < 0) {
    throw new InputError(
      `goal must be reachable from the start (${start.join(", ")}) through open cells; ` +
        `got (${goal.join(", ")}), cut off by walls`,
    );
  }
  const copy = Uint8Array.from(walls, (cell) => (cell ? 1 : 0));
  const sensors = senseEverywhere(copy, height, width, goal);
  return { name, height, width, walls: copy, start: [...start], goal: [...goal], sensors };
}

/** The maze as a drawing: one line a row, `symbols` for open, wall, start and goal. */
export function drawingOf({ walls, height, width, start, goal }, symbols = ".#SG") {
  const rows = [];
  for (let row = 0; row < height; row++) {
    let line = "";
    for (let column = 0; column < width; column++) line += symbols[walls[row * width + column] ? 1 : 0];
    rows.push(line);
  }
  for (const [[row, column], symbol] of [[start, symbols[2]], [goal, symbols[3]]]) {
    rows[row] = rows[row].slice(0, column) + symbol + rows[row].slice(column + 1);
  }
  return rows.join("\n");
}

/** The length of the shortest way from each cell to the goal, along rows and columns of open cells; -1 without one. */
export function waysToGoal({ walls, height, width, goal }) {
  const ways = new Int32Array(height * width).fill(-1);
  const first = goal[0] * width + goal[1];
  const queue = [first];
  ways[first] = 0;
  for (let next = 0; next < queue.length; next++) {
    const cell = queue[next], column = cell % width;
    const beside = [
      column > 0 ? cell - 1 : -1,
      column + 1 < width ? cell + 1 : -1,
      cell - width,
      cell + width < height * width ? cell + width : -1,
    ];
    for (const other of beside) {
      if (other >= 0 && !walls[other] && ways[other] < 0) {
        ways[other] = ways[cell] + 1;
        queue.push(other);
      }
    }
  }
  return ways;
}

/** What a robot senses in a cell, in the order of SENSORS. */
export function readingsAt({ sensors, width }, [row, column]) {
  const first = SENSORS.length * (row * width + column);
  return [...sensors.subarray(first, first + SENSORS.length)];
}

/** Taxicab distance between two cells. */
export function distanceBetween([row, column], [otherRow, otherColumn]) {
  return Math.abs(row - otherRow) + Math.abs(column - otherColumn);
}

/** The eight readings of every cell, in the order of SENSORS. */
function senseEverywhere(walls, height, width, goal) {
  const sensors = new Float64Array(height * width * 8);
  // how far one can go in a direction is one more than from the next cell, or one if the next cell is wall
  const reach = (sensor, cell, next, isEdge) => {
    sensors[8 * cell + sensor] = isEdge ? 0 : walls[next] ? 1 : sensors[8 * next + sensor] + 1;
  };
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      const cell = row * width + column, last = height * width - 1 - cell;
      reach(2, cell, cell - 1, column === 0);
      reach(6, cell, cell - width, row === 0);
      reach(0, last, last + 1, column === 0);
      reach(4, last, last + width, row === 0);
      sensors[8 * cell + (goal[1] > column ? 1 : 3)] = width;
      sensors[8 * cell + (goal[0] > row ? 5 : 7)] = height;
    }
  }
  return sensors;
}
