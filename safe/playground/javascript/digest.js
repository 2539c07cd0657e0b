// What identifies an experiment of the package: the digest of its content (see safe/experiments/experiment.py).

import { checkedAlgorithm, PAPERS, PARAMETERS, PROBABILITIES } from "./algorithms.js";
import { RULES } from "./evolution.js";
import { drawingOf } from "./maze.js";
import { sha256 } from "./sha256.js";

/** The digest of an experiment, in hexadecimal. seed: a BigInt. */
export function digestOf(maze, algorithm, seed, parameters) {
  return sha256(contentText(maze, checkedAlgorithm(algorithm), seed, parameters));
}

/** The content as Python's JSON writes it: keys in order, and only what departs from the paper. */
function contentText(maze, algorithm, seed, parameters) {
  const { objectives, rating } = algorithm;
  const rows = objectives?.map((genes) => listed(genes.map(pythonFloat)));
  const described = { objectives: rows ? listed(rows) : "null", rating: JSON.stringify(rating) };
  for (const name of ["scaling", "judging", "kind", "components", "pool"]) {
    const value = algorithm[name];
    if (`${value}` === `${PAPERS[name]}`) continue;
    described[name] = Array.isArray(value) ? listed(value.map((one) => JSON.stringify(one))) : JSON.stringify(value);
  }
  const departing = Object.entries(parameters).filter(([name, value]) => value !== PARAMETERS[name]);
  return object({
    rules: `${RULES}`,
    seed: `${seed}`,
    maze: JSON.stringify(drawingOf(maze)),
    algorithm: object(described),
    parameters: object(Object.fromEntries(departing.map(([name, value]) => [name, parameterText(name, value)]))),
  });
}

function parameterText(name, value) {
  if (typeof value === "string") return JSON.stringify(value);
  return name === "threshold" || PROBABILITIES.includes(name) ? pythonFloat(value) : `${value}`;
}

function object(fields) {
  return `{${Object.keys(fields).sort().map((name) => `"${name}": ${fields[name]}`).join(", ")}}`;
}

function listed(texts) {
  return `[${texts.join(", ")}]`;
}

/** A double as Python writes it: the same digits, but other exponents, and a point in whole numbers. */
function pythonFloat(value) {
  if (Object.is(value, -0)) return "-0.0";
  const [digits, exponent] = value.toExponential().split("e").map((part, i) => (i ? Number(part) : part));
  if (exponent < -4 || exponent >= 16) {
    return `${digits}e${exponent < 0 ? "-" : "+"}${String(Math.abs(exponent)).padStart(2, "0")}`;
  }
  return Number.isInteger(value) ? `${value}.0` : `${value}`;
}
