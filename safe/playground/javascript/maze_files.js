// Texts to mazes and back: drawings in characters, and lists of walls (see safe/maze_files.py).

import { InputError, shown } from "./checks.js";
import { LONGEST_SIDE, makeMaze } from "./maze.js";

const SYMBOLS = new Map([[".", 0], ["0", 0], ["#", 1], ["1", 1], ["S", 2], ["2", 2], ["G", 3], ["3", 3]]);
const FOLLOWS = {
  size: "height,width",
  start: "row,column",
  goal: "row,column",
  wall: "row,column row,column",
};
const BLANK = "[\\t-\\r\\x1c-\\x20\\x85\\xa0\\u1680\\u2000-\\u200a\\u2028\\u2029\\u202f\\u205f\\u3000]";
const BLANKS = new RegExp(BLANK + "+");
const OUTER_BLANKS = new RegExp(`^${BLANK}+|${BLANK}+$`, "g");

/** The maze that a text describes: a drawing, or a list of size, start, goal and wall lines. */
export function parseMaze(text, name = "maze") {
  if (typeof text !== "string") throw new InputError(`text must be a str; got ${shown(text)}`);
  // deno-lint-ignore no-control-regex -- these end a line for Python, too
  const lines = text.split(/\r\n|[\n-\r\x1c-\x1e\x85\u2028\u2029]/);
  const wordsOfLines = lines.map((line) =>
    line.split("#")[0].replace(OUTER_BLANKS, "").split(BLANKS).filter((word) => word)
  );
  return wordsOfLines.some((words) => words[0] === "size") ? readList(wordsOfLines, name) : readDrawing(lines, name);
}

/** The maze as a maze file: straight lines of wall cells, along a row unless the one along the column is longer. */
export function listOf({ walls, height, width, start, goal }) {
  const lines = [`size ${height},${width}`, `start ${start.join()}`, `goal ${goal.join()}`];
  const remaining = Uint8Array.from(walls);
  const lengthOf = (row, column, down, right) => {
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
      if (!remaining[row * width + column]) continue;
      const across = lengthOf(row, column, 0, 1), down = lengthOf(row, column, 1, 0);
      const step = across >= down ? [0, 1] : [1, 0];
      const last = Math.max(across, down) - 1;
      for (let i = 0; i <= last; i++) remaining[(row + i * step[0]) * width + column + i * step[1]] = 0;
      lines.push(`wall ${row},${column} ${row + last * step[0]},${column + last * step[1]}`);
    }
  }
  return lines.join("\n") + "\n";
}

function readDrawing(lines, name) {
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
  checkSides(
    height,
    width,
    () => `the drawing of a maze must be 1 to ${LONGEST_SIDE} cells a side; got ${height},${width}`,
  );
  return makeMaze(cells.map((cell) => (cell === 1 ? 1 : 0)), height, width, ...ends, name);
}

function readList(wordsOfLines, name) {
  const single = {};
  const wallLines = [];
  wordsOfLines.forEach((words, i) => {
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
    const places = pairs.map((text) => readPair(text, key, i + 1));
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
  for (const [number, first, last] of wallLines) layWall(walls, height, width, first, last, number);
  return makeMaze(walls, height, width, single.start, single.goal, name);
}

function readPair(text, key, number) {
  if (!/^[0-9]{1,9},[0-9]{1,9}$/.test(text)) {
    throw new InputError(`${key} must be followed by ${FOLLOWS[key]}; got ${shown(text)} in line ${number}`);
  }
  return text.split(",").map(Number);
}

/** Make the cells from `first` to `last` wall, both included. */
function layWall(walls, height, width, first, last, number) {
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

function checkSides(height, width, message) {
  if (Math.min(height, width) < 1 || Math.max(height, width) > LONGEST_SIDE) throw new InputError(message());
}
