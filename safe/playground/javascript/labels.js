// What algorithms are called, and how they look.

import { ALGORITHMS } from "./algorithms.js";
import { makeSvg } from "./dom.js";

const LABELS = {
  standard: { title: "Standard EA", summary: "rewards closeness to the goal" },
  novelty: { title: "Novelty search", summary: "rewards ending where none has ended before" },
  safe: { title: "SAFE", summary: "evolves what to reward as well" },
  fixed: { title: "Fixed weights", summary: "rewards closeness and novelty, half and half" },
  random: { title: "Random search", summary: "rewards nothing: new robots, drawn by chance" },
};

/** Is this one of ALGORITHMS, and not another by the same name? */
export function isNamedAlgorithm(algorithm) {
  return ALGORITHMS[algorithm.name] === algorithm;
}

/** The title of an algorithm. */
export function titleOf(algorithm) {
  return isNamedAlgorithm(algorithm) ? LABELS[algorithm.name].title : algorithm.name;
}

/** What an algorithm rewards, in a few words. */
export function summaryOf(algorithm) {
  return isNamedAlgorithm(algorithm) ? LABELS[algorithm.name].summary : "judged by other objective functions";
}

/** The class in playground.css that gives an algorithm's dots and lines their looks. */
export function kindOf(algorithm) {
  return isNamedAlgorithm(algorithm) ? algorithm.name : "other";
}

/** A sample of the line by which charts show an algorithm. */
export function makeSwatch(algorithm) {
  const line = makeSvg("polyline", { class: `line ${kindOf(algorithm)}`, points: "0,4 27,4" });
  return makeSvg("svg", { class: "swatch", viewBox: "0 0 27 8", "aria-hidden": "true" }, line);
}
