// Calls of the engine in JSON, answered in JSON: the same in Node, in a page and in a worker of it.
// A double comes back as it was, since both sides write the shortest digits that distinguish it from all others.

import { shown } from "../../../safe/playground/javascript/checks.js";
import { digestOf } from "../../../safe/playground/javascript/digest.js";
import {
  endpoints,
  evolve,
  generations,
  NoveltyArchive,
  parseMaze,
  path,
} from "../../../safe/playground/javascript/engine.js";
import { Evolution } from "../../../safe/playground/javascript/evolution.js";
import { drawingOf, waysToGoal } from "../../../safe/playground/javascript/maze.js";
import { listOf, textOf } from "../../../safe/playground/javascript/maze_files.js";
import { admitAbove, Archive, Occupancy } from "../../../safe/playground/javascript/novelty.js";
import { listed } from "../../../safe/playground/javascript/novelty_archive.js";

const FUNCTIONS = {
  host: () => {
    const node = globalThis.process?.versions.node;
    return node ? `Node ${node}` : `Chromium ${navigator.userAgent.match(/Chrom\w*\/(\d+)/)[1]}`;
  },
  shown: ({ value }) => shown(value),
  parseMaze: ({ maze, name }) => parseMaze(maze, name),
  readMaze: ({ bytes }) => parseMaze(textOf(Uint8Array.from(bytes))),
  writtenMaze: ({ maze }) => {
    const parsed = parseMaze(maze);
    return { drawing: drawingOf(parsed), list: listOf(parsed), ways: waysToGoal(parsed) };
  },
  path: ({ maze, controller, steps }) => path(parseMaze(maze), controller, steps),
  endpoints: ({ maze, controllers, steps }) => endpoints(parseMaze(maze), controllers, steps),
  NoveltyArchive: ({ capacity, k, metric, generations }) => {
    const archive = new NoveltyArchive(capacity, k, metric);
    return generations.map((points) => ({
      novelty: archive.score(points),
      points: archive.points,
      scores: archive.scores,
      length: archive.length,
    }));
  },
  admitAbove: ({ threshold, scores }) => {
    const archive = new Archive(5, 2), occupancy = new Occupancy(1, 1), kept = { value: threshold, idle: 0 };
    return scores.map((generation) => {
      admitAbove(new Float64Array(2 * generation.length), archive, occupancy, kept, generation);
      return { ...kept, entered: listed(archive).scores };
    });
  },
  evolve: ({ maze, algorithm, seed, parameters }) => evolve(parseMaze(maze), algorithm, seedOf(seed), parameters),
  generations: ({ maze, algorithm, seed, parameters }) => [
    ...generations(parseMaze(maze), algorithm, seedOf(seed), parameters),
  ],
  digest: ({ maze, algorithm, seed, parameters }) => digestOf(parseMaze(maze), algorithm, BigInt(seed), parameters),
  neighbours: ({ maze, algorithm, seed, parameters }) => {
    const evolution = new Evolution(parseMaze(maze), algorithm, seedOf(seed), parameters);
    while (evolution.advance());
    return Array.from(evolution.distances, (_, i) => evolution.neighbours(i));
  },
};

export function answer(text) {
  return JSON.stringify(JSON.parse(text).map(answerOne), plain);
}

function answerOne(call) {
  try {
    return { result: FUNCTIONS[call.function](call) };
  } catch (error) {
    return { error: error.message, stack: error.stack };
  }
}

// In JSON, integers that a double may not hold are hexadecimal texts.
function seedOf(seed) {
  if (typeof seed === "string") return BigInt(seed);
  if (Array.isArray(seed)) return seed.map(seedOf);
  if (Object(seed) === seed) return { entropy: seedOf(seed.entropy), spawnKey: seed.spawnKey.map(seedOf) };
  return seed;
}

// JSON would write null for a number that is not finite.
function plain(key, value) {
  if (typeof value === "number" && !Number.isFinite(value)) throw new Error(`${key} is ${value}`);
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}
