// How objective functions are rated by what solutions come of them (see safe/judges.py).

import { rank, scoreAll } from "./judges.js";

export const RATINGS = [ // of objective functions; with "none" they stay as they are
  "none",
  "genotypic novelty",
  "pearson",
  "spearman",
  "mutualism",
  "competition",
  "discovery",
  "shuffled",
  "patience",
  "redrawn",
];
const KEPT = 0.9; // of what was discovered before, from generation to generation
const REACHED = -1; // the score from which on a goal is reached

/** Are objective functions bred by this rating? Others stay, or are drawn. */
export function isBredBy(rating) {
  return !["none", "patience", "redrawn"].includes(rating);
}

/** Does a rating ask what the paths of robots discover? */
export function isOfPaths(rating) {
  return rating === "discovery" || rating === "shuffled";
}

/** The correlation of each objective function's scores, or of their ranks, with minus the distance to the goal. */
export function correlations(judges, distances, ofRanks, fitness) {
  const n = distances.length;
  const scores = distances.map((distance) => -distance);
  const apart = new Float64Array(n), nearness = new Float64Array(n); // deviations from the mean
  const spreadOfNearness = deviationsOf(scores, ofRanks, nearness);
  for (let j = 0; j < fitness.length; j++) {
    scoreAll(judges, j, scores);
    const spread = deviationsOf(scores, ofRanks, apart);
    let product = 0;
    for (let i = 0; i < n; i++) product += apart[i] * nearness[i];
    fitness[j] = spread > 0 && spreadOfNearness > 0 ? product / (spread * spreadOfNearness) : 0;
  }
}

/** The deviations of the values, or of their ranks, from the mean; returns the root of the sum of their squares. */
function deviationsOf(values, ofRanks, deviations) {
  const n = values.length;
  if (ofRanks) rank(values, deviations);
  else for (let i = 0; i < n; i++) deviations[i] = values[i] - values[0]; // exactly 0 if all are equal
  let total = 0;
  for (let i = 0; i < n; i++) total += deviations[i];
  const mean = total / n;
  let squares = 0;
  for (let i = 0; i < n; i++) {
    deviations[i] -= mean;
    squares += deviations[i] * deviations[i];
  }
  return Math.sqrt(squares);
}

/** The highest score that each objective function gives so many solutions, times 1 or -1. */
export function highestScores(judges, n, sign, fitness) {
  const scores = new Float64Array(n);
  for (let j = 0; j < fitness.length; j++) {
    scoreAll(judges, j, scores);
    fitness[j] = sign * scores.reduce((highest, score) => Math.max(highest, score));
  }
}

/** What was discovered by the offspring of parents that an objective function chose, added to what is kept of before.
 *
 * found: cells that each solution was the first to stand on. chosenBy: the objective function of the generation before
 * that chose its parent, or -1. parents: of which of these each objective function is a copy. fitness: of these, and
 * then of the new ones. */
export function discoveries(found, chosenBy, parents, fitness) {
  const before = fitness.slice(), sums = new Float64Array(fitness.length);
  chosenBy.forEach((j, i) => {
    if (j >= 0) sums[j] += found[i];
  });
  for (let j = 0; j < fitness.length; j++) fitness[j] = KEPT * before[parents[j]] + sums[parents[j]];
}

/** Shuffle what objective functions are rated by. */
export function shuffle(fitness, rng) {
  for (let i = fitness.length - 1; i >= 1; i--) {
    const j = Math.floor(rng.random() * (i + 1));
    [fitness[i], fitness[j]] = [fitness[j], fitness[i]];
  }
}

/** How near robots have come to each goal, at the nearest, and for how many generations no nearer. */
export function nearestSoFar(judges, n, fitness, idle) {
  const highest = new Float64Array(fitness.length);
  highestScores(judges, n, 1, highest);
  for (let j = 0; j < fitness.length; j++) {
    if (highest[j] > fitness[j]) {
      fitness[j] = highest[j];
      idle[j] = 0;
    } else idle[j]++;
  }
}

/** Draw anew the goals that are reached, and those to which none has come nearer for too long. */
export function redrawGoals(goals, fitness, idle, patience, rng) {
  for (let j = 0; j < fitness.length; j++) {
    if (fitness[j] >= REACHED || idle[j] >= patience) {
      goals[2 * j] = rng.random();
      goals[2 * j + 1] = rng.random();
      fitness[j] = -Infinity;
      idle[j] = 0;
    }
  }
}
