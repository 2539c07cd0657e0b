// What runs in a web worker: evolution, at the request of a page.

import { COMPONENTS, GOAL, NOVELTY } from "./algorithms.js";
import { Evolution, evolve } from "./evolution.js";
import { WEIGHTS } from "./robot.js";
import { rowOf, rowsOf } from "./rows.js";

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
    objectives: rowsOf(evolution.objectives, COMPONENTS.length),
    winners: evolution.isRandomSearch ? [] : [...evolution.winners],
  };
}

/** What charts show of a generation. */
function lineOf(evolution) {
  const novelty = evolution.components[NOVELTY];
  return {
    generation: evolution.number,
    distance: evolution.best.distance,
    novelty: evolution.weighed[NOVELTY] ? novelty.reduce((sum, value) => sum + value) / novelty.length : null,
    archive: evolution.archive.size,
    endpoint: evolution.best.endpoint,
  };
}

/** How the i-th solution of the generation came by its novelty and fitness; null for what it does not have. */
function inspect(evolution, i) {
  const controller = rowOf(evolution.genomes, i, WEIGHTS);
  const isJudged = !evolution.isRandomSearch;
  const winner = isJudged ? evolution.winners[i] : null;
  const coefficients = isJudged ? rowOf(evolution.objectives, winner, COMPONENTS.length) : [];
  const parts = coefficients.map((coefficient, c) => coefficient * evolution.scaled[c][i]);
  return {
    controller,
    endpoint: rowOf(evolution.endpoints, i, 2),
    route: evolution.route(controller),
    distance: evolution.distances[i],
    novelty: evolution.weighed[NOVELTY] ? evolution.components[NOVELTY][i] : null,
    neighbours: evolution.weighed[NOVELTY] ? evolution.neighbours(i) : [],
    k: evolution.parameters.k,
    fitness: isJudged ? evolution.fitness[i] : null,
    winner,
    coefficients,
    fromGoal: isJudged ? parts[GOAL] : null,
    fromNovelty: isJudged ? parts[NOVELTY] : null,
    wins: evolution.winners.filter((other) => other === winner).length,
    areJudgesDrawn: evolution.breeding.judging === "drawn judge",
    standings: standingsOf(evolution, i),
  };
}

/** The i-th solution beside the others of the generation, by each measure that it has; equal ones share a place. */
function standingsOf({ components, scaled, weighed, fitness, isRandomSearch }, i) {
  const isScaled = scaled !== components;
  const measures = [
    ["closeness (1 / distance)", components[GOAL], true],
    ["closeness as weighed", scaled[GOAL], isScaled && weighed[GOAL]],
    ["novelty", components[NOVELTY], weighed[NOVELTY]],
    ["novelty as weighed", scaled[NOVELTY], isScaled && weighed[NOVELTY]],
    ["fitness", fitness, !isRandomSearch],
  ];
  return measures.filter(([, , isThere]) => isThere).map(([measure, values]) => ({
    measure,
    value: values[i],
    largest: values.reduce((largest, value) => Math.max(largest, value)),
    place: 1 + values.filter((other) => other > values[i]).length,
  }));
}
