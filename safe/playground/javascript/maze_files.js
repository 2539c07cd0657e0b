// Texts to mazes and back: drawings in characters, lists of walls, and line segments (see safe/maze_files.py).

import { InputError, shown } from "./checks.js";
import { LONGEST_SIDE, makeMaze } from "./maze.js";

const BOX_LINES = Array.from({ length: 0x80 }, (_, i) => String.fromCharCode(0x2500 + i));
const CELL_SYMBOLS = [[..." .0"], [..."#1Xx+-|█▓■", ...BOX_LINES], [..."S2s"], [..."G3gEe"]]; // open, wall, start, goal
const SYMBOLS = new Map(CELL_SYMBOLS.flatMap((symbols, kind) => symbols.map((symbol) => [symbol, kind])));
const FOLLOWS = {
  size: "height,width",
  start: "row,column",
  goal: "row,column",
  wall: "row,column row,column",
};
const NUMBER = /^[+-]?[0-9]{1,9}(\.[0-9]{0,20})?(e[+-]?[0-9]{1,2})?$/;
const SEGMENTS_SIDE = 100; // cells on the longer side of a maze of line segments

/** The text in a file, given by its bytes. */
export function textOf(bytes) {
  const encodings = { "255,254": "utf-16le", "254,255": "utf-16be" };
  return new TextDecoder(encodings[bytes.slice(0, 2).join()] ?? "utf-8", { ignoreBOM: true }).decode(bytes);
}

/** The maze that a text describes: a list of size, start, goal and wall lines, line segments, or a drawing. */
export function parseMaze(text, name = "maze") {
  if (typeof text !== "string") throw new InputError(`text must be a str; got ${shown(text)}`);
  const all = linesOf(text);
  if (text.includes("\0")) {
    throw new InputError(
      "a maze file must be text in UTF-8, or in UTF-16 with a byte order mark; got NUL characters",
    );
  }
  const lines = all.map((line) => line.split("#")[0]);
  if (lines.some((line) => splitWords(line)[0] === "size")) {
    return readList(lines.map((line) => splitWords(line.split(",").map((part) => part.trim()).join())), name);
  }
  const numbers = lines.map((line) => splitWords(line.replaceAll(",", " "))).filter((words) => words.length > 0);
  if (numbers.every((words) => words.every((word) => NUMBER.test(word))) && numbers.some((words) => words.length > 1)) {
    return readSegments(numbers.map((words) => words.map(Number)), name);
  }
  return readDrawing(all, name);
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

/** The lines of a text, with all blanks but tabs as spaces. */
function linesOf(text) {
  // deno-lint-ignore no-control-regex -- these end a line for Python, too
  const lines = text.replaceAll("\ufeff", "").split("\x1a")[0].split(/\r\n|[\n-\r\x1c-\x1e\x85\u2028\u2029]/);
  // deno-lint-ignore no-control-regex
  return lines.map((line) => line.replace(/[\x1f\p{Zs}]/gu, " "));
}

function splitWords(line) {
  return line.split(/[ \t]+/).filter((word) => word);
}

function readDrawing(lines, name) {
  const drawn = [...lines.keys()].filter((i) => lines[i].trim());
  if (drawn.length === 0) throw new InputError("the drawing of a maze must have at least one row; got none");
  const height = drawn.length;
  let rows = drawn.map((i) => [...lines[i].trim()]);
  rows.forEach((row, i) => {
    const unknown = row.find((character) => !SYMBOLS.has(character));
    if (unknown !== undefined) {
      throw new InputError(
        "a maze must be a drawing in . 0 or blanks (open), # 1 X + - | or blocks (wall), S 2 (start) and G E 3 " +
          `(goal), or a list that gives its size, or line segments; got ${shown(unknown)} in row ${i + 1}`,
      );
    }
  });
  if (rows.some((row) => row.includes(" "))) rows = rowsWithBlanks(rows, lines, drawn);
  const width = rows[0].length;
  rows.forEach((row, i) => {
    if (row.length !== width) {
      throw new InputError(
        `the drawing of a maze must be a rectangle; got ${row.length} cells wide in row ${i + 1}, ${width} in row 1`,
      );
    }
  });
  const cells = rows.flat().map((character) => SYMBOLS.get(character));
  const ends = [["start", 2], ["goal", 3]].map(([end, kind]) => {
    const count = cells.filter((cell) => cell === kind).length;
    if (count !== 1) throw new InputError(`the drawing of a maze must have exactly one ${end}; got ${count}`);
    const cell = cells.indexOf(kind);
    return [Math.floor(cell / width), cell % width];
  });
  checkSides("the drawing of a maze", height, width);
  return makeMaze(cells.map((cell) => (cell === 1 ? 1 : 0)), height, width, ...ends, name);
}

/**
 * The rows of a drawing in which blanks are open cells, from those without the blanks around them; `drawn` counts, from
 * 0, its lines that are not blank.
 */
function rowsWithBlanks(rows, lines, drawn) {
  const both = rows.findIndex((row) => row.includes(".") || row.includes("0"));
  if (both >= 0) {
    throw new InputError(
      "the drawing of a maze must show open cells by blanks, or by . and 0; " +
        `got blanks, and one of these in row ${both + 1}`,
    );
  }
  const gap = drawn.findIndex((line, i) => line !== drawn[0] + i);
  if (gap >= 0) {
    throw new InputError(
      "the drawing of a maze must have no blank line between its rows if blanks are open cells; " +
        `got one in line ${drawn[gap - 1] + 2}`,
    );
  }
  if (rows.every((row) => row.length === rows[0].length)) return rows;
  const indent = least(drawn.map((i) => lines[i].length - lines[i].trimStart().length));
  rows = drawn.map((i) => [...lines[i].trimEnd()].slice(indent));
  const tabbed = rows.findIndex((row) => row.includes("\t"));
  if (tabbed >= 0) {
    throw new InputError(
      "the drawing of a maze must be indented by the same tabs in all rows if blanks are open cells; " +
        `got another in row ${tabbed + 1}`,
    );
  }
  const width = -least(rows.map((row) => -row.length));
  return rows.map((row) => [...row, ...Array(width - row.length).fill(" ")]);
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
    if (key === "wall") wallLines.push([i + 1, places]);
    else if (key in single) throw new InputError(`${key} must be given once; got it again in line ${i + 1}`);
    else single[key] = places[0];
  });
  for (const key of ["size", "start", "goal"]) {
    if (!(key in single)) throw new InputError(`a maze file must give the ${key}; got none`);
  }
  const [height, width] = single.size;
  checkSides("size", height, width);
  for (const [number, places] of wallLines) {
    const outside = places.find(([row, column]) => row >= height || column >= width);
    if (outside) {
      throw new InputError(
        `wall must lie within the ${height} by ${width} cells; got ${outside} in line ${number}`,
      );
    }
  }
  return walledMaze(height, width, single.start, single.goal, wallLines.flatMap(([, places]) => places), name);
}

function readPair(text, key, number) {
  if (!/^[0-9]{1,9},[0-9]{1,9}$/.test(text)) {
    throw new InputError(`${key} must be followed by ${FOLLOWS[key]}; got ${shown(text)} in line ${number}`);
  }
  return text.split(",").map(Number);
}

/** The maze of line segments, given by the numbers of each line. */
function readSegments(lines, name) {
  const counts = lines.map((numbers) => numbers.length);
  const before = Math.max(counts.indexOf(2), 0); // lines before the start
  const after = before + (counts[before + 3] === 2 ? 4 : 3); // lines before the walls
  const isInOrder = counts.every((count, i) => count === (i < before ? 1 : i < after ? [2, 1, 2, 2][i - before] : 4));
  if (!isInOrder || before === 0 || lines.length < after) {
    throw new InputError(
      "line segments must be lines of 1, 2, 1, 2 and then 4 numbers: how many, start, heading, goal, the ends of " +
        `each; got ${shown(counts)} numbers`,
    );
  }
  const count = lines.length - after;
  if (lines[before - 1][0] !== count) {
    throw new InputError(`line segments must be as many as the line before the start says; got ${count}`);
  }
  const walls = lines.slice(after).flatMap(([x, y, otherX, otherY]) => [[x, y], [otherX, otherY]]);
  const points = [lines[before], lines[before + 2], ...walls];
  const [left, top] = [0, 1].map((axis) => least(points.map((point) => point[axis])));
  const [right, bottom] = [0, 1].map((axis) => -least(points.map((point) => -point[axis])));
  const longer = Math.max(right - left, bottom - top) || 1; // or else all points are the same, and so in cell 0,0
  const cellOf = ([x, y]) =>
    [y - top, x - left].map((distance) => Math.floor((SEGMENTS_SIDE - 1) * distance / longer + 0.5));
  const [start, goal, ...ends] = points.map(cellOf);
  const [height, width] = cellOf([right, bottom]).map((last) => last + 1);
  return walledMaze(height, width, start, goal, ends, name);
}

/** The maze with walls from cell to cell, given by both ends of each, one after the other. */
function walledMaze(height, width, start, goal, ends, name) {
  const walls = new Uint8Array(height * width);
  for (let i = 0; i < ends.length; i += 2) layWall(walls, width, ends[i], ends[i + 1]);
  return makeMaze(walls, height, width, start, goal, name);
}

/** Make the cells wall whose inside the line between the centres of two cells crosses, these two included. */
function layWall(walls, width, [row, column], [lastRow, lastColumn]) {
  const down = Math.sign(lastRow - row), right = Math.sign(lastColumn - column);
  const rows = Math.abs(lastRow - row), columns = Math.abs(lastColumn - column);
  let i = 0, j = 0;
  walls[row * width + column] = 1;
  while (i !== rows || j !== columns) {
    const side = (2 * i + 1) * columns - (2 * j + 1) * rows; // through which it leaves a cell: < 0 below, > 0 beside
    if (side <= 0) i++;
    if (side >= 0) j++;
    walls[(row + i * down) * width + column + j * right] = 1;
  }
}

function checkSides(name, height, width) {
  if (Math.min(height, width) < 1 || Math.max(height, width) > LONGEST_SIDE) {
    throw new InputError(`${name} must be 1 to ${LONGEST_SIDE} cells a side; got ${height},${width}`);
  }
}

function least(numbers) {
  return numbers.reduce((a, b) => Math.min(a, b));
}
