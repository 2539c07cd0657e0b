// The maze: a grid of open and wall cells, a start, a goal, and what a robot senses in each cell (see safe/maze.py).
//
// Cells are numbered row by row; the cell in row r and column c is number r * width + c.

import { InputError, shown } from "./checks.js";

export const SENSORS = [
  "dist_right", "goal_right", "dist_left", "goal_left", "dist_down", "goal_down", "dist_up", "goal_up",
];
export const LONGEST_SIDE = 2048; // cells

const SYMBOLS = new Map([["." , 0], ["0", 0], ["#", 1], ["1", 1], ["S", 2], ["2", 2], ["G", 3], ["3", 3]]);
const FOLLOWS = {
  size: "height,width",
  start: "row,column",
  goal: "row,column",
  wall: "row,column row,column",
};
const BLANK = "[\\t-\\r\\x1c-\\x20\\x85\\xa0\\u1680\\u2000-\\u200a\\u2028\\u2029\\u202f\\u205f\\u3000]";
const BLANKS = new RegExp(BLANK + "+");
const OUTER_BLANKS = new RegExp(`^${BLANK}+|${BLANK}+$`, "g");

/** A maze from its cells, checked.
 *
 * walls: height * width values, 1 where a cell is wall; start and goal: [row, column], open cells that are connected.
 * Gives { name, height, width, walls, start, goal, sensors }; `sensors` holds eight readings a cell. */
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
  const own = Uint8Array.from(walls, (cell) => (cell ? 1 : 0));
  const sensors = senseEverywhere(own, height, width, goal);
  return { name, height, width, walls: own, start: [...start], goal: [...goal], sensors };
}

/** The maze that a text describes: a drawing, or a list of size, start, goal and wall lines. */
export function parseMaze(text, name = "maze") {
  if (typeof text !== "string") throw new InputError(`text must be a str; got ${shown(text)}`);
  const lines = text.split(/\r\n|[\n-\r\x1c-\x1e\x85\u2028\u2029]/);
  const lists = lines.map((line) => line.split("#")[0].replace(OUTER_BLANKS, "").split(BLANKS).filter((word) => word));
  return lists.some((words) => words[0] === "size") ? parseList(lists, name) : parseDrawing(lines, name);
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

/** The maze as a maze file: straight lines of wall cells, along rows where they are as long there as along columns. */
export function listOf({ walls, height, width, start, goal }) {
  const lines = [`size ${height},${width}`, `start ${start.join()}`, `goal ${goal.join()}`];
  const left = Uint8Array.from(walls);
  const run = (row, column, down, right) => {
    let length = 0;
    while (row < height && column < width && walls[row * width + column]) {
      length++;
      row += down;
      column += right;
    }
    return length;
  };
  for (let row = 0; row < height; row++) {
    for (let column = 0; column < width; column++) {
      if (!left[row * width + column]) continue;
      const across = run(row, column, 0, 1), down = run(row, column, 1, 0);
      const step = across >= down ? [0, 1] : [1, 0];
      const last = Math.max(across, down) - 1;
      for (let i = 0; i <= last; i++) left[(row + i * step[0]) * width + column + i * step[1]] = 0;
      lines.push(`wall ${row},${column} ${row + last * step[0]},${column + last * step[1]}`);
    }
  }
  return lines.join("\n") + "\n";
}

/** How many cells it is from each cell to the goal through open cells, along rows and columns; -1 where no way leads. */
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

/** Taxicab distance between two cells. */
export function distanceBetween([row, column], [otherRow, otherColumn]) {
  return Math.abs(row - otherRow) + Math.abs(column - otherColumn);
}

function parseDrawing(lines, name) {
  const rows = lines.map((line) => line.replace(OUTER_BLANKS, "")).filter((line) => line).map((line) => [...line]);
  if (rows.length === 0) throw new InputError("the drawing of a maze must have at least one row; got none");
  const height = rows.length, width = rows[0].length;
  rows.forEach((row, i) => {
    if (row.length !== width) {
      throw new InputError(
        `the drawing of a maze must be a rectangle; got ${row.length} cells wide in row ${i + 1}, ${width} in row 1`,
      );
    }
    for (const character of row) {
      if (!SYMBOLS.has(character)) {
        const symbols = [...SYMBOLS.keys()].join(" ");
        throw new InputError(
          `the drawing of a maze must use only ${symbols}; got ${shown(character)} in row ${i + 1}`,
        );
      }
    }
  });
  const cells = rows.flat().map((character) => SYMBOLS.get(character));
  const ends = [["start", 2], ["goal", 3]].map(([end, kind]) => {
    const count = cells.filter((cell) => cell === kind).length;
    if (count !== 1) throw new InputError(`the drawing of a maze must have exactly one ${end}; got ${count}`);
    const cell = cells.indexOf(kind);
    return [Math.floor(cell / width), cell % width];
  });
  checkSides(height, width, () => `the drawing of a maze must be 1 to ${LONGEST_SIDE} cells a side; got ${height},${width}`);
  return makeMaze(cells.map((cell) => (cell === 1 ? 1 : 0)), height, width, ...ends, name);
}

function parseList(lists, name) {
  const single = {};
  const wallLines = [];
  lists.forEach((words, i) => {
    if (words.length === 0) return;
    const [key, ...pairs] = words;
    if (!Object.hasOwn(FOLLOWS, key)) {
      throw new InputError(
        `a line of a maze file must begin with size, start, goal or wall; got ${shown(key)} in line ${i + 1}`,
      );
    }
    if (pairs.length !== (key === "wall" ? 2 : 1)) {
      throw new InputError(`${key} must be followed by ${FOLLOWS[key]}; got something else in line ${i + 1}`);
    }
    const places = pairs.map((text) => {
      if (!/^[0-9]{1,9},[0-9]{1,9}$/.test(text)) {
        throw new InputError(`${key} must be followed by ${FOLLOWS[key]}; got ${shown(text)} in line ${i + 1}`);
      }
      return text.split(",").map(Number);
    });
    if (key === "wall") wallLines.push([i + 1, ...places]);
    else if (key in single) throw new InputError(`${key} must be given once; got it again in line ${i + 1}`);
    else single[key] = places[0];
  });
  for (const key of ["size", "start", "goal"]) {
    if (!(key in single)) throw new InputError(`a maze file must give the ${key}; got none`);
  }
  const [height, width] = single.size;
  checkSides(height, width, () => `size must be 1 to ${LONGEST_SIDE} cells a side; got ${height},${width}`);
  const walls = new Uint8Array(height * width);
  for (const [number, first, last] of wallLines) {
    for (const [row, column] of [first, last]) {
      if (row >= height || column >= width) {
        throw new InputError(
          `wall must lie within the ${height} by ${width} cells; got ${row},${column} in line ${number}`,
        );
      }
    }
    const down = last[0] - first[0], right = last[1] - first[1];
    if (down && right && Math.abs(down) !== Math.abs(right)) {
      throw new InputError(`wall must be horizontal, vertical or diagonal; got something else in line ${number}`);
    }
    for (let i = 0; i <= Math.max(Math.abs(down), Math.abs(right)); i++) {
      walls[(first[0] + Math.sign(down) * i) * width + first[1] + Math.sign(right) * i] = 1;
    }
  }
  return makeMaze(walls, height, width, single.start, single.goal, name);
}

function checkSides(height, width, message) {
  if (Math.min(height, width) < 1 || Math.max(height, width) > LONGEST_SIDE) throw new InputError(message());
}

/** The eight readings of every cell, in the order of SENSORS. */
function senseEverywhere(walls, height, width, goal) {
  const sensors = new Float64Array(height * width * 8);
  // how far one can go in a direction is one more than from the next cell, or one where the next cell is wall
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
