// The state of the playground as the part of a page's address behind the #, and back (see safe/playground/address.py).

import {
  ALGORITHMS,
  checkedAlgorithm,
  checkedParameters,
  CHOICES,
  genesOf,
  PAPERS,
  PARAMETERS,
  WEIGHABLE,
} from "./algorithms.js";
import { checkedChoice, checkedInteger, checkedRow, InputError, MOST, shown } from "./checks.js";
import { checkedCourse } from "./course.js";
import { LONGEST_SIDE, makeMaze } from "./maze.js";
import { isNamed, namedMaze, recognised } from "./named_mazes.js";
import { PACKAGED_MAZES } from "./packaged_mazes.js";
import { checkedSeed } from "./random.js";
import { WEIGHTS } from "./robot.js";

export const VIEWS = ["watch", "drive", "draw", "runs", "challenges"];
export const MOST_CHALLENGES = 10;
export const MOST_RUNS = 10000;
const MOST_ALGORITHMS = 8; // side by side in a view

/** The state that an address describes: those of { view, maze, algorithms, seed, parameters, generation, runs,
 * controller, course, challenge } that it names. Throws an InputError if it cannot be read. */
export function readAddress(text) {
  const state = {};
  const parameters = {}, course = {};
  for (const part of text.split("&").filter((part) => part)) {
    const [key, ...rest] = part.split("=");
    const value = decoded(rest.join("="));
    if (key === "view") state.view = checkedChoice("view", value, VIEWS);
    else if (key === "maze") state.maze = readMaze(value);
    else if (key === "algorithm") (state.algorithms ??= []).push(readAlgorithm(value));
    else if (key === "seed") state.seed = readSeed(value);
    else if (key === "generation") state.generation = checkedInteger(key, readNumber(key, value), 0, MOST);
    else if (key === "runs") state.runs = checkedInteger(key, readNumber(key, value), 1, MOST_RUNS);
    else if (key === "challenge") state.challenge = checkedInteger(key, readNumber(key, value), 1, MOST_CHALLENGES);
    else if (key === "class") course.name = value;
    else if (key === "seats" || key === "seat") course[key] = readNumber(key, value);
    else if (key === "controller") state.controller = readController(value);
    else if (Object.hasOwn(PARAMETERS, key)) parameters[key] = key === "admission" ? value : readNumber(key, value);
    else throw new InputError(`an address must hold known keys; got ${shown(key)}`);
  }
  if (state.algorithms?.length > MOST_ALGORITHMS) {
    throw new InputError(`an address must hold at most ${MOST_ALGORITHMS} algorithms; got ${state.algorithms.length}`);
  }
  if (Object.keys(course).length > 0) state.course = checkedCourse(course);
  if (Object.keys(parameters).length > 0) {
    checkedParameters(parameters);
    state.parameters = parameters;
  }
  return state;
}

/** The address of a state. That of a class names no seat, since who follows it takes another one, and a maze
 * only if the package knows the name. */
export function writeAddress(
  { view, maze, algorithms, seed, parameters, generation, runs, controller, course, challenge },
) {
  const isOfClass = view === "runs" && Boolean(course);
  const parts = [
    ["view", view],
    ["maze", writeMaze(maze, isOfClass)],
  ];
  for (const algorithm of algorithms) parts.push(["algorithm", writeAlgorithm(algorithm)]);
  parts.push(["seed", writeSeed(seed)], ...Object.entries(parameters));
  if (view === "watch" && generation > 0) parts.push(["generation", generation]);
  if (view === "drive") parts.push(["controller", controller.join()]);
  if (view === "runs") parts.push(["runs", runs]);
  if (isOfClass) parts.push(["class", course.name], ["seats", course.seats]);
  if (challenge) parts.push(["challenge", challenge]);
  return parts.map(([key, value]) => `${key}=${encoded(String(value))}`).join("&");
}

/** A seed from a text: an integer or several, perhaps with a spawn key behind a slash. */
export function readSeed(text) {
  const lists = text.split("/").map((list) => list.split(","));
  const isSeed = lists.length <= 2 && lists.flat().every((number) => /^([0-9]{1,80}|0x[0-9a-f]{1,64})$/i.test(number));
  if (!isSeed) {
    throw new InputError(`seed must be an integer of at least 0, such as 7; got ${shown(text)}`);
  }
  const [entropy, spawnKey = []] = lists.map((list) => list.map(BigInt));
  return checkedSeed({ entropy, spawnKey });
}

/** The text of a seed. */
export function writeSeed({ entropy, spawnKey }) {
  const number = (value) => (value < 2n ** 64n ? `${value}` : `0x${value.toString(16)}`);
  return [entropy, spawnKey]
    .filter((list) => list.length > 0)
    .map((list) => list.map(number).join())
    .join("/");
}

/** The n-th of the seeds that begin with this one: the n-th run of the experiment, or the n-th integer after it. */
export function nthSeed({ entropy, spawnKey }, n) {
  if (spawnKey.length > 0) return { entropy, spawnKey: [...spawnKey.slice(0, -1), BigInt(n)] };
  return { entropy: [...entropy.slice(0, -1), entropy.at(-1) + BigInt(n)], spawnKey };
}

/** 16 weights from a text, or from an array of numbers. */
export function readController(value) {
  const weights = typeof value === "string" ? value.split(",").map(readDecimal) : value;
  return [...checkedRow("controller", weights, WEIGHTS, -1, 1)];
}

function readDecimal(text) {
  return text.trim() ? Number(text) : NaN;
}

function readNumber(name, text) {
  if (!/^[0-9]{1,9}(\.[0-9]{1,30})?(e-[0-9]{1,3})?$/.test(text)) {
    throw new InputError(`${name} must be a number; got ${shown(text)}`);
  }
  return Number(text);
}

// Behind the objective functions, the choices of an algorithm follow in these steps, each left out if it and all behind
// it are the paper's.
const LATER = [["scaling", "judging"], ["kind", "pool", "components"]];

function readAlgorithm(text) {
  const [name, rating, objectives, ...more] = text.split(":");
  if (rating === undefined) return checkedAlgorithm(name);
  const genes = objectives === "drawn" ? null : objectives ? objectives.split(",").map(readDecimal) : [];
  const fields = LATER.flat().slice(0, more.length), isStep = [0, 2, 5].includes(more.length);
  const choices = { rating: choiceOf("rating", rating) };
  fields.forEach((field, i) => (choices[field] = choiceOf(field, more[i])));
  const areKnown = Object.values(choices).every((choice) => choice);
  const width = areKnown ? genesOf({ ...PAPERS, ...choices }) : NaN;
  if (!areKnown || !isStep || objectives === undefined || (genes?.length ?? 0) % width > 0) {
    throw new InputError(
      "algorithm must be a name, or name:rating:a,b,..., perhaps with :scaling:judging, and then :kind:pool:components; " +
        `got ${shown(text)}`,
    );
  }
  const rows = genes?.flatMap((_, i) => (i % width ? [] : [genes.slice(i, i + width)])) ?? null;
  return checkedAlgorithm({ name, objectives: rows, ...choices });
}

function writeAlgorithm(algorithm) {
  const { name, objectives, rating } = algorithm;
  if (ALGORITHMS[name] === algorithm) return name;
  const steps = LATER.map((fields) => fields.map((field) => codeOf(field, algorithm[field])));
  const papers = LATER.map((fields) => fields.map((field) => codeOf(field, PAPERS[field])));
  while (steps.length > 0 && `${steps.at(-1)}` === `${papers[steps.length - 1]}`) steps.pop();
  return [name, codeOf("rating", rating), objectives?.flat().join() ?? "drawn", ...steps.flat()].join(":");
}

/** What stands for a choice: its first word; for components, the last word of each. */
function codeOf(field, choice) {
  return field === "components" ? choice.map((name) => name.split(" ").at(-1)).join() : choice.split(" ")[0];
}

/** The choice for which a code stands; undefined or null if there is none. */
function choiceOf(field, code) {
  if (field !== "components") return CHOICES[field].find((choice) => codeOf(field, choice) === code);
  const names = code.split(",").map((one) => WEIGHABLE.find((name) => codeOf(field, [name]) === one));
  return names.every((name) => name) ? names : null;
}

function readMaze(text) {
  if (!text.includes("/")) return namedMaze(text);
  const match = /^([0-9]{1,4})x([0-9]{1,4})\/([0-9]{1,4}),([0-9]{1,4})\/([0-9]{1,4}),([0-9]{1,4})\/([\w-]*)$/.exec(
    text,
  );
  const numbers = match?.slice(1, 7).map(Number);
  const [height, width] = numbers ?? [0, 0];
  const bytes = match ? bytesOf(match[7]) : [];
  if (!match || Math.max(height, width) > LONGEST_SIDE || bytes.length !== Math.ceil((height * width) / 8)) {
    throw new InputError(`maze must be a name, or the cells of a maze as an address gives them; got ${shown(text)}`);
  }
  const walls = Uint8Array.from({ length: height * width }, (_, cell) => (bytes[cell >> 3] >> (7 - (cell & 7))) & 1);
  return recognised(makeMaze(walls, height, width, numbers.slice(2, 4), numbers.slice(4, 6), "drawn"));
}

function writeMaze(maze, isForPackage) {
  if (isNamed(maze) && (!isForPackage || maze.name in PACKAGED_MAZES)) return maze.name;
  const { height, width, start, goal, walls } = maze;
  const bytes = new Uint8Array(Math.ceil(walls.length / 8));
  walls.forEach((wall, cell) => (bytes[cell >> 3] |= wall << (7 - (cell & 7))));
  const base64 = btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
  const bits = base64.replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
  return `${height}x${width}/${start.join()}/${goal.join()}/${bits}`;
}

function bytesOf(base64) {
  try {
    return Uint8Array.from(atob(base64.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  } catch {
    return [];
  }
}

function encoded(text) {
  return encodeURIComponent(text).replace(/%(2C|3A|2F)/g, (code) => decodeURIComponent(code));
}

function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    throw new InputError(`an address must be encoded as a browser does; got ${shown(text)}`);
  }
}
