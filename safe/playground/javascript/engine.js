// The package `safe` once more, for a reader without a kernel: the same seed gives the same run, bit for bit.
//
// Plain modules without dependencies that know of no page: they run in a browser, in a worker and in Node.

export { ALGORITHMS, PARAMETERS } from "./algorithms.js";
export { evolve, generations } from "./evolution.js";
export { parseMaze } from "./maze.js";
export { NoveltyArchive } from "./novelty.js";
export { endpoints, path } from "./robot.js";
