// What algorithms are called, and how they look.

import { baseOf, CHOICES } from "./algorithms.js";
import { makeSvg } from "./dom.js";

const LABELS = {
  standard: { title: "Standard EA", summary: "rewards closeness to the goal" },
  novelty: { title: "Novelty search", summary: "rewards ending where none has ended before" },
  safe: { title: "SAFE", summary: "evolves what to reward as well" },
  fixed: { title: "Fixed weights", summary: "rewards closeness and novelty, half and half" },
  random: { title: "Random search", summary: "rewards nothing: new robots, drawn by chance" },
};

/** The title of an algorithm: that of one of ALGORITHMS, with the choices that depart from it. */
export function titleOf(algorithm) {
  const base = baseOf(algorithm);
  if (!base) return algorithm.name;
  const departing = Object.keys(CHOICES).filter((choice) => algorithm[choice] !== base[choice]);
  const texts = departing.map((choice) => (algorithm[choice] === "none" ? "unevolved" : algorithm[choice]));
  return LABELS[base.name].title + (texts.length > 0 ? ` (${texts.join(", ")})` : "");
}

/** What an algorithm rewards, in a few words. */
export function summaryOf(algorithm) {
  const base = baseOf(algorithm), isOther = !base || (base.rating !== "none" && algorithm.rating === "none");
  return isOther ? "judged by other objective functions" : LABELS[base.name].summary;
}

/** The class in playground.css that gives an algorithm's dots and lines their looks. */
export function kindOf(algorithm) {
  return baseOf(algorithm) ? algorithm.name : "other";
}

/** A sample of the line by which charts show an algorithm. */
export function makeSwatch(algorithm) {
  const line = makeSvg("polyline", { class: `line ${kindOf(algorithm)}`, points: "0,4 27,4" });
  return makeSvg("svg", { class: "swatch", viewBox: "0 0 27 8", "aria-hidden": "true" }, line);
}
