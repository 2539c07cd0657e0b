// How objective functions judge solutions, and how they are rated (see safe/judges.py, also for the order in which
// numbers are added up).
//
// `judges` holds objectives, a Float64Array with the coefficients of one objective function after the other, and
// components, an array of Float64Arrays: what is weighed, of all solutions.

export const RATINGS = ["none", "genotypic novelty", "pearson", "spearman"]; // of objective functions
export const SCALINGS = ["raw", "maximum", "rank"]; // of components

/** Scale one component of all solutions, which is never negative, by a scaling other than "raw". */
export function scale(values, scaling, scaled) {
  if (scaling === "maximum") {
    let largest = 0;
    for (let i = 0; i < values.length; i++) largest = Math.max(largest, values[i]);
    for (let i = 0; i < values.length; i++) scaled[i] = largest > 0 ? values[i] / largest : 0;
  } else {
    rank(values, scaled);
    for (let i = 0; i < values.length; i++) scaled[i] /= values.length - 1;
  }
}

/** The rank of each value, from 0; equal values share the average. */
function rank(values, ranks) {
  const sorted = values.slice().sort();
  for (let i = 0; i < values.length; i++) {
    ranks[i] = (countBelow(sorted, values[i], false) + countBelow(sorted, values[i], true) - 1) / 2;
  }
}

/** How many of some sorted values are below a value, or equal to it. */
function countBelow(sorted, value, orEqual) {
  let low = 0, high = sorted.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (sorted[middle] < value || (orEqual && sorted[middle] === value)) low = middle + 1;
    else high = middle;
  }
  return low;
}

/** The score that the j-th objective function gives the i-th solution, O_j(S_i) (Equation 1). */
export function scoreOne({ objectives, components }, j, i) {
  const width = components.length;
  let score = 0;
  for (let c = 0; c < width; c++) score += objectives[j * width + c] * components[c][i];
  return score;
}

/** The scores that the j-th objective function gives all solutions. */
export function scoreAll(judges, j, scores) {
  for (let i = 0; i < scores.length; i++) scores[i] = scoreOne(judges, j, i);
}

/** Algorithm 1: the fitness of S_i is max_j O_j(S_i), and the first such O_j is its winner. */
export function bestScores({ objectives, components }, fitness, winners) {
  const width = components.length, judges = objectives.length / width;
  for (let i = 0; i < fitness.length; i++) {
    fitness[i] = -Infinity;
    for (let j = 0; j < judges; j++) {
      let score = 0;
      for (let c = 0; c < width; c++) score += objectives[j * width + c] * components[c][i]; // as scoreOne, but faster
      if (score > fitness[i]) {
        fitness[i] = score;
        winners[i] = j;
      }
    }
  }
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
