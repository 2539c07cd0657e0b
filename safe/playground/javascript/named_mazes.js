// Mazes to choose from: those of the package, and others to compare them with.

import { checkedChoice } from "./checks.js";
import { drawingOf } from "./maze.js";
import { parseMaze } from "./maze_files.js";
import { PACKAGED_MAZES } from "./packaged_mazes.js"; // written by bundle.py, from safe/mazes

export const MAZES = {
  ...PACKAGED_MAZES,
  trap: `size 41,41
start 20,4
goal 20,34
wall 0,0 0,40
wall 40,0 40,40
wall 0,0 40,0
wall 0,40 40,40
wall 9,10 9,28
wall 31,10 31,28
wall 9,28 31,28
`,
  spiral: `size 41,41
start 2,2
goal 20,20
wall 0,0 0,40
wall 40,0 40,40
wall 0,0 40,0
wall 0,40 40,40
wall 5,5 5,35
wall 5,35 35,35
wall 35,5 35,35
wall 10,5 35,5
wall 10,5 10,30
wall 10,30 30,30
wall 30,10 30,30
wall 15,10 30,10
wall 15,10 15,25
wall 15,25 25,25
wall 25,15 25,25
wall 20,15 25,15
`,
  rooms: `size 43,43
start 4,4
goal 38,38
wall 0,0 0,42
wall 42,0 42,42
wall 0,0 42,0
wall 0,42 42,42
wall 1,14 9,14
wall 12,14 34,14
wall 37,14 41,14
wall 1,28 5,28
wall 8,28 20,28
wall 23,28 41,28
wall 14,1 14,6
wall 14,9 14,20
wall 14,23 14,41
wall 28,1 28,10
wall 28,13 28,34
wall 28,37 28,41
`,
  open: `size 41,41
start 4,4
goal 34,30
wall 0,0 0,40
wall 40,0 40,40
wall 0,0 40,0
wall 0,40 40,40
`,
};

const parsed = new Map(); // mazes by their names, once they are asked for

/** A maze of MAZES by its name. */
export function namedMaze(name) {
  if (!parsed.has(name)) {
    parsed.set(name, parseMaze(MAZES[checkedChoice("maze", name, Object.keys(MAZES))], name));
  }
  return parsed.get(name);
}

/** Is this the maze of MAZES that has its name? */
export function isNamed(maze) {
  return Object.hasOwn(MAZES, maze.name) && drawingOf(namedMaze(maze.name)) === drawingOf(maze);
}

/** A maze, under its name in MAZES if it is one of them. */
export function recognised(maze) {
  const renamed = Object.keys(MAZES).map((name) => ({ ...maze, name }));
  return renamed.find(isNamed) ?? maze;
}
