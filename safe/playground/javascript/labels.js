// What algorithms are called, and how they look.

import { baseOf, PAPERS } from "./algorithms.js";
import { makeSvg } from "./dom.js";

const LABELS = {
  standard: { title: "Standard EA", summary: "rewards closeness to the goal" },
  novelty: { title: "Novelty search", summary: "rewards ending where none has ended before" },
  safe: { title: "SAFE", summary: "evolves what to reward as well" },
  fixed: { title: "Fixed coefficients", summary: "rewards closeness and novelty, half and half" },
  random: { title: "Random search", summary: "rewards nothing: new robots, drawn by chance" },
  "weighing-and-goals": {
    title: "Weighing and goals",
    summary: "rewards closeness, novelty and rare paths, weighed anew each time",
  },
};

const WORDS = { // for choices and components, if not their own
  none: "unevolved",
  goal: "goals",
  mixed: "weights and goals",
  "1 / distance": "closeness",
  "1 / way": "closeness on the way",
};
const ORDER = ["kind", "components", "rating", "scaling", "judging", "pool"]; // of choices in a title
const SUMMARIES = { // by rating
  mutualism: "evolves what to reward, for high scores of the best",
  competition: "evolves what to reward, for low scores of the best",
  discovery: "evolves what to reward, for new cells on paths",
  shuffled: "evolves what to reward, by ratings that are shuffled",
  patience: "rewards coming near to goals, which are given up in time",
  redrawn: "rewards something else each time, drawn by chance",
};
const LOOKS = ["mutualism", "competition", "discovery"]; // ratings that are shown in a colour of their own

/** What a choice or a component is called in a sentence. */
export function wordOf(choice) {
  return WORDS[choice] ?? choice;
}

/** The title of an algorithm: that of one of ALGORITHMS, or its name, with the choices that depart. */
export function titleOf(algorithm) {
  const base = baseOf(algorithm) ?? { ...PAPERS, rating: algorithm.rating };
  const departing = ORDER.filter((choice) => `${algorithm[choice]}` !== `${base[choice]}`);
  if (algorithm.objectives?.length === 0 && base.name && departing.join() === "pool") return "MAP-Elites";
  const texts = departing.map((choice) => [algorithm[choice]].flat().map(wordOf).join(" + "));
  return (LABELS[base.name]?.title ?? algorithm.name) + (texts.length > 0 ? ` (${texts.join(", ")})` : "");
}

/** What an algorithm rewards, in a few words. */
export function summaryOf(algorithm) {
  const { kind, rating, objectives, pool } = algorithm, base = baseOf(algorithm);
  if (objectives?.length === 0 && pool === "repertoire") {
    return "rewards nothing, but keeps a robot for each cell reached";
  }
  const isOther = !base || (base.rating !== "none" && rating === "none");
  const text = SUMMARIES[rating] ?? (isOther ? "judged by other objective functions" : LABELS[base.name].summary);
  if (kind === "weights") return text;
  return `${text}; ${kind === "goal" ? "its" : "half of its"} objective functions are places to end at`;
}

/** The class in playground.css that gives an algorithm's dots and lines their looks. */
export function kindOf(algorithm) {
  if (LOOKS.includes(algorithm.rating)) return algorithm.rating;
  return baseOf(algorithm) ? algorithm.name : "other";
}

/** A sample of the line by which charts show an algorithm. */
export function makeSwatch(algorithm) {
  const line = makeSvg("polyline", { class: `line ${kindOf(algorithm)}`, points: "0,4 27,4" });
  return makeSvg("svg", { class: "swatch", viewBox: "0 0 27 8", "aria-hidden": "true" }, line);
}
