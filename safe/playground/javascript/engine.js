// The science of the package once more, for readers without Python: the same seed gives the same run, bit for bit.
//
// These modules have no dependencies and touch no page, so they run in a browser, in its workers and in Node.

export { ALGORITHMS, PARAMETERS } from "./algorithms.js";
export { endpoints } from "./endpoints.js";
export { evolve } from "./evolution.js";
export { generations } from "./generations.js";
export { parseMaze } from "./maze_files.js";
export { NoveltyArchive } from "./novelty_archive.js";
export { path } from "./robot.js";
