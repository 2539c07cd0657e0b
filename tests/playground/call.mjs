// Calls of the engine in JSON, answered in JSON: the same in Node, in a page and in a worker of it.
// A double comes back as it was, since both sides write the shortest digits that tell it from all others.

import { NoveltyArchive, endpoints, evolve, generations, parseMaze, path } from "../../book/_static/playground/engine.js";

const FUNCTIONS = {
    parseMaze: ({ maze, name }) => parseMaze(maze, name),
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
    evolve: ({ maze, algorithm, seed, parameters }) => evolve(parseMaze(maze), algorithm, seedOf(seed), parameters),
    generations: ({ maze, algorithm, seed, parameters }) => [
        ...generations(parseMaze(maze), algorithm, seedOf(seed), parameters),
    ],
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

// Integers that a double may not hold are hexadecimal texts in JSON.
function seedOf(seed) {
    if (typeof seed === "string") return BigInt(seed);
    if (Array.isArray(seed)) return seed.map(seedOf);
    return Object(seed) === seed ? { ...seed, entropy: seedOf(seed.entropy) } : seed;
}

function plain(key, value) {
    if (typeof value === "number" && !Number.isFinite(value)) throw new Error(`${key} is ${value}, not a number of JSON`);
    return ArrayBuffer.isView(value) ? Array.from(value) : value;
}
