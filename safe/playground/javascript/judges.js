// How objective functions judge solutions (see safe/judges.py, also for the order in which numbers are added up).
//
// There are two kinds: an objective function weighs the components of a solution by its coefficients, or it is a goal,
// a cell, and its score is minus the distance from there to where the solution's robot ends.
//
// `judges` holds objectives, a Float64Array with the genes of one objective function after the other; genes, how many
// each has; weighers, how many of them weigh, which are the first; components, an array of Float64Arrays: what they
// weigh, of all solutions; endpoints, the row and column of each solution; height and width of the maze.

export const KINDS = ["weights", "goal", "mixed"]; // of objective functions
export const SCALINGS = ["raw", "maximum", "rank"]; // of components

/** How many of so many objective functions of a kind weigh components. */
export function weighersOf(kind, judges) {
  return { weights: judges, goal: 0, mixed: judges / 2 }[kind];
}

/** How many objective functions there are. */
export function countOf({ objectives, genes }) {
  return objectives.length / genes;
}

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
export function rank(values, ranks) {
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

/** The cell that the j-th objective function names, a goal: its row and column. */
export function placeOf({ objectives, genes, height, width }, j) {
  return {
    row: Math.min(Math.floor(objectives[j * genes] * height), height - 1),
    column: Math.min(Math.floor(objectives[j * genes + 1] * width), width - 1),
  };
}

/** The distance from a place to the i-th of some cells. */
export function distanceTo({ row, column }, cells, i) {
  return Math.abs(row - cells[2 * i]) + Math.abs(column - cells[2 * i + 1]);
}

/** The score that the j-th objective function gives the i-th solution, O_j(S_i) (Equation 1, or of a goal). */
export function scoreOne(judges, j, i) {
  const { objectives, genes, components } = judges;
  if (j >= judges.weighers) return -distanceTo(placeOf(judges, j), judges.endpoints, i);
  let score = 0;
  for (let c = 0; c < components.length; c++) score += objectives[j * genes + c] * components[c][i];
  return score;
}

/** The scores that the j-th objective function gives all solutions. */
export function scoreAll(judges, j, scores) {
  const { objectives, genes, components, endpoints } = judges, n = scores.length;
  if (j >= judges.weighers) {
    const place = placeOf(judges, j);
    for (let i = 0; i < n; i++) scores[i] = -distanceTo(place, endpoints, i);
    return;
  }
  scores.fill(0);
  for (let c = 0; c < components.length; c++) {
    const coefficient = objectives[j * genes + c], values = components[c];
    for (let i = 0; i < n; i++) scores[i] += coefficient * values[i];
  }
}

/** Algorithm 1: the fitness of S_i is max_j O_j(S_i), and the first such O_j is its winner. */
export function bestScores(judges, fitness, winners) {
  const scores = new Float64Array(fitness.length);
  fitness.fill(-Infinity);
  for (const j of contenders(judges)) {
    scoreAll(judges, j, scores);
    for (let i = 0; i < scores.length; i++) {
      if (scores[i] > fitness[i]) {
        fitness[i] = scores[i];
        winners[i] = j;
      }
    }
  }
}

/** The objective functions that can win: components are never negative, so none can whose coefficients are all at most
 * those of an earlier one. */
function contenders(judges) {
  const { objectives, genes, weighers } = judges, found = [];
  const isAtMost = (j, other) => {
    for (let gene = 0; gene < genes; gene++) {
      if (objectives[j * genes + gene] > objectives[other * genes + gene]) return false;
    }
    return true;
  };
  for (let j = 0; j < countOf(judges); j++) {
    if (j >= weighers || !found.some((other) => isAtMost(j, other))) found.push(j);
  }
  return found;
}
