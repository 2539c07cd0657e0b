// The paper's algorithms and its Table 1, as data, and the choices beyond the paper (see safe/algorithms.py).
//
// objectives: the objective functions [a, b] of the first generation; null draws as many as the parameters say.
// rating: how objective functions are rated, and so bred; with "none" they stay as they are.
// scaling: of what they weigh. judging: who selects parents.

import { checkedChoice, checkedInteger, checkedNumber, checkedRows, InputError, MOST, shown } from "./checks.js";
import { RATINGS, SCALINGS } from "./judges.js";
import { ADMISSIONS, ARCHIVE_CAPACITY, K } from "./novelty.js";
import { JUDGINGS } from "./operators.js";
import { STEPS } from "./robot.js";

export const COMPONENTS = ["1 / distance", "novelty"]; // what an objective function weighs
export const GOAL = 0;
export const NOVELTY = 1;
export const CHOICES = { rating: RATINGS, scaling: SCALINGS, judging: JUDGINGS }; // of an algorithm

export const ALGORITHMS = {
  standard: completed({ name: "standard", objectives: [[1, 0]] }),
  novelty: completed({ name: "novelty", objectives: [[0, 1]] }),
  safe: completed({ name: "safe", rating: "genotypic novelty" }),
  fixed: completed({ name: "fixed", objectives: [[0.5, 0.5]] }),
  random: completed({ name: "random", objectives: [] }),
};

/** An algorithm with all that it does not say: the first of each of CHOICES. */
function completed({ name, objectives = null, rating = RATINGS[0], scaling = SCALINGS[0], judging = JUDGINGS[0] }) {
  return { name, objectives, rating, scaling, judging };
}

export const PARAMETERS = {
  population: 200, // solutions in a generation
  objectives: 200, // objective functions in a generation, if they evolve
  generations: 500, // at the most
  tournament: 5, // individuals drawn for a tournament
  elites: 2, // fittest individuals that pass on unchanged
  crossover: 0.8, // probability, for a pair of parents
  mutation: 0.4, // probability, for an offspring
  k: K, // nearest neighbours that count for novelty
  archive: ARCHIVE_CAPACITY, // places in each of the two novelty archives
  steps: STEPS, // that a robot takes
  success_distance: 2, // cells, taxicab: an end point this near to the goal is a success
  // beyond the paper:
  admission: ADMISSIONS[0], // what enters the archive of end points
  admitted: 5, // solutions that enter it in each generation, with "random"
  threshold: 6, // novelty above which they enter it at first, with "threshold"
};
export const PROBABILITIES = ["crossover", "mutation"];
const MAY_BE_ZERO = ["elites", "archive", "success_distance"];

/** An algorithm, checked: one of ALGORITHMS by its name, or { name, objectives, rating, scaling, judging }. */
export function checkedAlgorithm(algorithm) {
  if (typeof algorithm !== "object" || algorithm === null) {
    return ALGORITHMS[checkedChoice("algorithm", algorithm, Object.keys(ALGORITHMS))];
  }
  const whole = completed(algorithm), { objectives, rating } = whole;
  for (const [choice, allowed] of Object.entries(CHOICES)) checkedChoice(choice, whole[choice], allowed);
  if (objectives !== null) {
    checkedRows("objectives", objectives, COMPONENTS.length);
    if (rating !== "none" && (objectives.length === 0 || objectives.length % 2)) {
      throw new InputError(
        `objectives must be even in number if they evolve; got ${objectives.length}`,
      );
    }
  }
  return whole;
}

/** The one of ALGORITHMS that an algorithm is but for its choices; undefined if it is none of them. */
export function baseOf({ name, objectives }) {
  return Object.values(ALGORITHMS).find((base) => base.name === name && `${base.objectives}` === `${objectives}`);
}

/** May a reader change this choice of an algorithm? With nobody to judge, or to evolve, there is nothing to choose. */
export function hasChoice(algorithm, choice) {
  if (choice === "rating") return (baseOf(algorithm) ?? algorithm).rating !== "none";
  return algorithm.objectives?.length !== 0;
}

/** An algorithm with other choices, those that it has; one of ALGORITHMS if it becomes that. */
export function withChoices(algorithm, choices) {
  const own = Object.entries(choices).filter(([choice]) => hasChoice(algorithm, choice));
  const changed = checkedAlgorithm({ ...algorithm, ...Object.fromEntries(own) });
  const isChanged = (other) => JSON.stringify(other) === JSON.stringify(changed);
  return Object.values(ALGORITHMS).find(isChanged) ?? changed;
}

/** All parameters, checked: these, and the others as in the paper. */
export function checkedParameters(changes = {}) {
  for (const name of Object.keys(changes)) checkedChoice("the name of a parameter", name, Object.keys(PARAMETERS));
  const parameters = { ...PARAMETERS, ...changes };
  for (const [name, value] of Object.entries(parameters)) {
    if (name === "admission") checkedChoice(name, value, ADMISSIONS);
    else if (name === "threshold") checkedNumber(name, value, 0, MOST);
    else if (PROBABILITIES.includes(name)) checkedNumber(name, value, 0, 1);
    else checkedInteger(name, value, MAY_BE_ZERO.includes(name) ? 0 : 1, MOST);
  }
  for (const name of ["population", "objectives", "elites"]) {
    if (parameters[name] % 2) throw new InputError(`${name} must be an even number; got ${shown(parameters[name])}`);
  }
  if (parameters.elites >= Math.min(parameters.population, parameters.objectives)) {
    throw new InputError(
      `elites must be fewer than the ${parameters.population} solutions and ${parameters.objectives} ` +
        `objective functions; got ${parameters.elites}`,
    );
  }
  return parameters;
}
