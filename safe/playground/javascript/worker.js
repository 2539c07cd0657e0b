// What runs in a web worker: evolution, at the request of a page.

import { Evolution, evolve } from "./evolution.js";
import { COMPONENTS, GOAL, NOVELTY } from "./algorithms.js";
import { rowOf, rowsOf } from "./novelty.js";
import { WEIGHTS } from "./robot.js";

/** Answer the messages { id, task, ...arguments } of a page by { id, answer } or { id, error }. */
export function serve(scope) {
  let evolution = null;
  const tasks = {
    /** The first generation of a run. */
    start({ maze, algorithm, seed, parameters }) {
      evolution = new Evolution(maze, algorithm, seed, parameters);
      return report(evolution, 1);
    },
    /** So many further generations, or fewer where they take longer than some milliseconds. */
    advance({ generations, milliseconds }) {
      return report(evolution, generations, milliseconds);
    },
    /** What is to be known of one solution of the generation. */
    inspect({ individual }) {
      return inspected(evolution, individual);
    },
    /** A whole run. */
    evolve({ maze, algorithm, seed, parameters }) {
      return evolve(maze, algorithm, seed, parameters);
    },
  };
  scope.onmessage = ({ data: { id, task, ...given } }) => {
    try {
      scope.postMessage({ id, answer: tasks[task](given) });
    } catch (error) {
      scope.postMessage({ id, error: error.message });
    }
  };
}

/** Advance, and tell of each generation a line, and of the last one what is to be seen. */
function report(evolution, generations, milliseconds = Infinity) {
  const until = performance.now() + milliseconds;
  const history = [];
  while (history.length < generations && !evolution.isOver && (history.length === 0 || performance.now() < until)) {
    evolution.advance();
    const novelty = evolution.components[NOVELTY];
    history.push({
      generation: evolution.number,
      distance: evolution.best.distance,
      novelty: evolution.weighNovelty ? novelty.reduce((sum, value) => sum + value) / novelty.length : null,
      archive: evolution.archive.size,
      endpoint: evolution.best.endpoint,
    });
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

function inspected(evolution, i) {
  const controller = rowOf(evolution.genomes, i, WEIGHTS);
  const judged = !evolution.isRandomSearch;
  const winner = judged ? evolution.winners[i] : null;
  const coefficients = judged ? rowOf(evolution.objectives, winner, COMPONENTS.length) : [];
  const parts = coefficients.map((weight, component) => weight * evolution.components[component][i]);
  return {
    controller,
    endpoint: rowOf(evolution.endpoints, i, 2),
    route: evolution.route(controller),
    distance: evolution.distances[i],
    novelty: evolution.weighNovelty ? evolution.components[NOVELTY][i] : null,
    neighbours: evolution.weighNovelty ? evolution.neighbours(i) : [],
    fitness: judged ? evolution.fitness[i] : null,
    winner,
    coefficients,
    fromGoal: judged ? parts[GOAL] : null,
    fromNovelty: judged ? parts[NOVELTY] : null,
  };
}
