// The state of a playground at first, and as it is known outside of the page.

import { readController, readSeed, writeSeed } from "./address.js";
import { ALGORITHMS } from "./algorithms.js";
import { drawingOf } from "./maze.js";
import { parseMaze } from "./maze_files.js";
import { namedMaze, recognised } from "./named_mazes.js";
import { PRESETS } from "./presets.js";

/** The state if an address names none of it. */
export function defaultState() {
  return {
    view: "watch",
    maze: namedMaze("maze1"),
    algorithms: [ALGORITHMS.safe],
    seed: readSeed("0"),
    parameters: {},
    generation: 0,
    runs: 50,
    controller: PRESETS[0].controller,
    course: null,
    challenge: null, // the number of the one that is open
    result: null,
  };
}

/** What a first visit opens on: a run about to succeed. */
export function openingState() {
  return { ...defaultState(), seed: readSeed("3"), generation: 40 };
}

/** Parts of the state, from outside: a drawing, 16 numbers, the text of a seed, a run's result or null.
 *
 * A result is shown by driving its controller. */
export function fromOutside({ maze, controller, seed, result }) {
  const changes = {};
  if (maze !== undefined) changes.maze = recognised(parseMaze(maze, "drawn"));
  if (seed !== undefined) changes.seed = readSeed(seed);
  if (result !== undefined) changes.result = result;
  if (result) changes.controller = readController(result.controller);
  if (controller !== undefined) changes.controller = readController(controller);
  if (maze !== undefined || seed !== undefined) changes.generation = 0;
  return changes;
}

/** Those of the named parts of the state that are known outside, likewise. */
export function toOutside(state, names) {
  return Object.fromEntries(names.filter((name) => name in OUTSIDE).map((name) => [name, OUTSIDE[name](state)]));
}

const OUTSIDE = {
  maze: ({ maze }) => drawingOf(maze),
  controller: ({ controller }) => controller,
  seed: ({ seed }) => writeSeed(seed),
  result: ({ result }) => result,
};
