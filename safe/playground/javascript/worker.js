// What runs in a web worker: evolution, at the request of a page.

import { Evolution, evolve } from "./evolution.js";
import { countOf, distanceTo, placeOf } from "./judges.js";
import { wordOf } from "./labels.js";
import { WEIGHTS } from "./robot.js";
import { rowOf, rowsOf } from "./rows.js";
import { favouriteOf } from "./selection.js";

/** Answer the messages { id, task, ...arguments } of a page by { id, answer } or { id, error }. */
export function serve(scope) {
  let evolution = null;
  const tasks = {
    /** The first generation of a run. */
    start({ maze, algorithm, seed, parameters }) {
      evolution = new Evolution(maze, algorithm, seed, parameters);
      return advance(evolution, 1);
    },
    /** So many further generations, or fewer if they take longer than some milliseconds. */
    advance({ generations, milliseconds }) {
      return advance(evolution, generations, milliseconds);
    },
    /** One solution of the generation. */
    inspect({ individual }) {
      return inspect(evolution, individual);
    },
    /** A whole run. */
    evolve({ maze, algorithm, seed, parameters }) {
      return evolve(maze, algorithm, seed, parameters);
    },
  };
  scope.onmessage = ({ data: { id, task, ...settings } }) => {
    try {
      scope.postMessage({ id, answer: tasks[task](settings) });
    } catch (error) {
      scope.postMessage({ id, error: error.message });
    }
  };
}

/** Advance a run. Returns what a page shows of the last generation, and in `history` a line for each. */
function advance(evolution, generations, milliseconds = Infinity) {
  const deadline = performance.now() + milliseconds;
  const history = [];
  while (history.length < generations && !evolution.isOver && (history.length === 0 || performance.now() < deadline)) {
    evolution.advance();
    history.push(lineOf(evolution));
  }
  return {
    history,
    result: evolution.result(),
    isOver: evolution.isOver,
    route: evolution.route(evolution.best.controller),
    end: evolution.best.endpoint,
    ends: rowsOf(evolution.endpoints, 2),
    archive: rowsOf(evolution.archive.points.subarray(0, 2 * evolution.archive.size), 2),
    goal: evolution.best.goal,
    weights: rowsOf(evolution.objectives.subarray(0, evolution.weighers * evolution.genes), evolution.genes),
    goals: goalsOf(evolution),
    winners: evolution.isJudged ? [...evolution.winners] : [],
    reached: evolution.repertoire?.size ?? null,
  };
}

/** The cells that goals name, each with the cell where its favourite ended: [row, column]. */
function goalsOf({ judges, repertoire, distances }) {
  const goals = [];
  for (let j = judges.weighers; j < countOf(judges); j++) {
    const { row, column } = placeOf(judges, j);
    const slot = favouriteOf(judges, j, repertoire, distances.length);
    goals.push({ place: [row, column], favourite: rowOf(repertoire?.cells ?? judges.endpoints, slot, 2) });
  }
  return goals;
}

/** What charts show of a generation. */
function lineOf(evolution) {
  const novelty = evolution.components[evolution.novelty];
  return {
    generation: evolution.number,
    distance: evolution.best.distance,
    novelty: evolution.isNoveltyWeighed ? novelty.reduce((sum, value) => sum + value) / novelty.length : null,
    archive: evolution.archive.size,
    endpoint: evolution.best.endpoint,
  };
}

/** How the i-th solution of the generation came by its novelty and fitness; null for what it does not have. */
function inspect(evolution, i) {
  const controller = rowOf(evolution.genomes, i, WEIGHTS);
  const { isJudged, isNoveltyWeighed, algorithm } = evolution;
  const winner = isJudged ? evolution.winners[i] : null, place = evolution.goalOf(i);
  return {
    controller,
    endpoint: rowOf(evolution.endpoints, i, 2),
    route: evolution.route(controller),
    distance: evolution.distances[i],
    novelty: isNoveltyWeighed ? evolution.components[evolution.novelty][i] : null,
    neighbours: isNoveltyWeighed ? evolution.neighbours(i) : [],
    k: evolution.parameters.k,
    fitness: isJudged ? evolution.fitness[i] : null,
    winner,
    // of a goal: the cell, and how far it is away
    goal: place && { ...place, distance: distanceTo(place, evolution.endpoints, i) },
    // of weights: each component with its coefficient and what that makes of the fitness
    terms: !isJudged || place ? [] : algorithm.components.map((name, c) => {
      const coefficient = evolution.objectives[winner * evolution.genes + c];
      return { name, coefficient, value: coefficient * evolution.scaled[c][i] };
    }),
    wins: evolution.winners.filter((other) => other === winner).length,
    standings: standingsOf(evolution, i),
  };
}

/** The i-th solution beside the others of the generation, by each measure that it has; equal ones share a place. */
function standingsOf({ algorithm, components, scaled, weighed, fitness, isJudged }, i) {
  const isScaled = scaled !== components;
  const measures = algorithm.components.flatMap((name, c) => [
    [wordOf(name) + (name.startsWith("1") ? ` (${name})` : ""), components[c], weighed[c] || name === "1 / distance"],
    [`${wordOf(name)} as weighed`, scaled[c], isScaled && weighed[c]],
  ]);
  measures.push(["fitness", fitness, isJudged]);
  return measures.filter(([, , isThere]) => isThere).map(([measure, values]) => ({
    measure,
    value: values[i],
    largest: values.reduce((largest, value) => Math.max(largest, value)),
    place: 1 + values.filter((other) => other > values[i]).length,
  }));
}
