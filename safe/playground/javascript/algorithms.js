// The paper's algorithms and its Table 1, as data, and the choices beyond the paper (see safe/algorithms.py).
//
// objectives: the objective functions of the first generation; null draws as many as the parameters say.
// rating: how objective functions are rated, and so bred or drawn anew; with "none" they stay as they are.
// scaling: of what they weigh. judging: who selects parents. kind: do they weigh, or name a cell to reach?
// components: what they weigh. pool: from which parents are taken.

import {
  checkedChoice,
  checkedChoices,
  checkedInteger,
  checkedNumber,
  checkedRows,
  InputError,
  MOST,
  shown,
  shownTuple,
} from "./checks.js";
import { KINDS, SCALINGS } from "./judges.js";
import { ADMISSIONS, ARCHIVE_CAPACITY, K } from "./novelty.js";
import { RATINGS } from "./ratings.js";
import { STEPS } from "./robot.js";
import { JUDGINGS, POOLS } from "./selection.js";

export const COMPONENTS = ["1 / distance", "novelty"]; // what an objective function weighs in the paper
export const WEIGHABLE = [...COMPONENTS, "path rarity", "1 / way"]; // what it may weigh
// of an algorithm, in the order of addresses
export const CHOICES = { rating: RATINGS, scaling: SCALINGS, judging: JUDGINGS, kind: KINDS, pool: POOLS };

export const PAPERS = { // what an algorithm is unless it says otherwise
  objectives: null,
  rating: RATINGS[0],
  scaling: SCALINGS[0],
  judging: JUDGINGS[0],
  kind: KINDS[0],
  components: COMPONENTS,
  pool: POOLS[0],
};

export const ALGORITHMS = {
  standard: completed({ name: "standard", objectives: [[1, 0]] }),
  novelty: completed({ name: "novelty", objectives: [[0, 1]] }),
  safe: completed({ name: "safe", rating: "genotypic novelty" }),
  fixed: completed({ name: "fixed", objectives: [[0.5, 0.5]] }),
  random: completed({ name: "random", objectives: [] }),
  "weighing-and-goals": completed({ // beyond the paper
    name: "weighing-and-goals",
    rating: "redrawn",
    scaling: "rank",
    judging: "favourite",
    kind: "mixed",
    components: WEIGHABLE.slice(0, 3),
    pool: "repertoire",
  }),
};

/** An algorithm with all that it does not say. */
function completed({ name, ...fields }) {
  const whole = { name, ...PAPERS };
  for (const field of Object.keys(PAPERS)) if (fields[field] !== undefined) whole[field] = fields[field];
  return whole;
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
  patience: 10, // generations after which a goal to which nothing comes nearer is drawn anew, with "patience"
};
export const PROBABILITIES = ["crossover", "mutation"];
const MAY_BE_ZERO = ["elites", "archive", "success_distance"];

/** How many genes an objective function of an algorithm has. */
export function genesOf({ kind, components }) {
  return { weights: components.length, goal: 2, mixed: Math.max(2, components.length) }[kind];
}

/** An algorithm, checked: one of ALGORITHMS by its name, or { name, objectives, ... } with choices by their names. */
export function checkedAlgorithm(algorithm) {
  if (typeof algorithm !== "object" || algorithm === null) {
    return ALGORITHMS[checkedChoice("algorithm", algorithm, Object.keys(ALGORITHMS))];
  }
  const whole = completed(algorithm);
  for (const [choice, allowed] of Object.entries(CHOICES)) checkedChoice(choice, whole[choice], allowed);
  checkedChoices("components", whole.components, WEIGHABLE);
  if (whole.objectives !== null) checkObjectives(whole);
  checkTogether(whole);
  return whole;
}

function checkObjectives(algorithm) {
  const { objectives, rating, kind } = algorithm, count = objectives?.length;
  checkedRows("objectives", objectives, genesOf(algorithm), ...(kind === "weights" ? [] : [0, 1]));
  if (rating !== "none" && (count === 0 || count % 2)) {
    throw new InputError(`objectives must be even in number if they evolve; got ${count}`);
  }
  if (kind === "mixed" && count % 2) {
    throw new InputError(`objectives must be even in number if they are mixed; got ${count}`);
  }
}

/** Do the choices of an algorithm go together? */
function checkTogether(algorithm) {
  const { objectives, rating, kind, pool } = algorithm;
  const check = (name, allowed, reason) => {
    const value = algorithm[name], show = Array.isArray(value) ? shownTuple : shown;
    if (allowed.some((one) => areEqual(one, value))) return;
    const options = [allowed.slice(0, -1).map(show).join(", "), show(allowed.at(-1))].filter((text) => text);
    throw new InputError(`${name} must be ${options.join(" or ")} ${reason}; got ${show(value)}`);
  };
  if (objectives?.length === 0) {
    check("kind", ["weights"], "without objective functions");
    if (pool === "repertoire") check("judging", ["best score"], "without objective functions");
    return;
  }
  if (kind === "goal") {
    check("scaling", ["raw"], "for goals, which weigh nothing");
    check("components", [COMPONENTS], "for goals, which weigh nothing");
  }
  if (kind === "mixed") check("rating", ratingsOf(kind), "for a mixture with goals");
  if (rating === "patience") check("kind", ["goal"], "for a rating by patience");
  if (pool === "repertoire") {
    check("kind", ["goal", "mixed"], "to choose from the repertoire");
    check("judging", judgingsOf(algorithm), "to choose from the repertoire");
  }
}

/** The ratings that go with a kind of objective function. */
function ratingsOf(kind) {
  if (kind === "mixed") return ["none", "redrawn"];
  return kind === "goal" ? RATINGS : RATINGS.filter((rating) => rating !== "patience");
}

/** By what judging the objective functions of an algorithm may choose. */
function judgingsOf({ kind, pool }) {
  if (pool === "generation") return JUDGINGS;
  return kind === "goal" ? ["drawn judge", "favourite"] : ["favourite"];
}

/** Are these equal, as JSON writes them? */
function areEqual(list, other) {
  return JSON.stringify(list) === JSON.stringify(other);
}

/** The one of ALGORITHMS that an algorithm is but for its choices; undefined if it is none of them. */
export function baseOf({ name, objectives }) {
  return Object.values(ALGORITHMS).find((base) => base.name === name && `${base.objectives}` === `${objectives}`);
}

/** May a reader change this choice of an algorithm, or its components? Only if it means something there. */
export function hasChoice(algorithm, choice) {
  const { objectives, kind } = algorithm;
  if (objectives?.length === 0) return choice === "pool"; // nobody judges
  if (choice === "rating") return (baseOf(algorithm) ?? algorithm).rating !== "none";
  if (choice === "scaling") return kind !== "goal";
  if (choice === "pool") return kind !== "weights";
  if (choice === "components") return objectives === null && kind !== "goal"; // given ones have their coefficients
  return choice === "judging" || objectives === null;
}

/** An algorithm with other choices, those that it has; one of ALGORITHMS if it becomes that.
 *
 * The kind of objective function comes first, then the pool: what does not go with these becomes what does. */
export function withChoices(algorithm, choices) {
  const changed = { ...algorithm };
  for (const [choice, value] of Object.entries(choices)) if (hasChoice(changed, choice)) changed[choice] = value;
  if (changed.objectives?.length !== 0) {
    const { kind } = changed;
    if (kind === "weights") changed.pool = POOLS[0];
    if (kind === "goal") Object.assign(changed, { scaling: SCALINGS[0], components: COMPONENTS });
    if (!ratingsOf(kind).includes(changed.rating)) changed.rating = kind === "mixed" ? "redrawn" : RATINGS[1];
    if (!judgingsOf(changed).includes(changed.judging)) changed.judging = "favourite";
  }
  const checked = checkedAlgorithm(changed);
  return Object.values(ALGORITHMS).find((other) => areEqual(other, checked)) ?? checked;
}

/** The values of a choice that go with the kind and the pool of an algorithm. */
export function optionsOf(algorithm, choice) {
  return CHOICES[choice].filter((value) => withChoices(algorithm, { [choice]: value })[choice] === value);
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
