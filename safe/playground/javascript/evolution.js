// The generational loop, the same for every algorithm (see safe/evolution.py, also for the order of the draws).

import { checkedAlgorithm, checkedParameters, COMPONENTS, GOAL, NOVELTY } from "./algorithms.js";
import { InputError } from "./checks.js";
import { bestScores, correlations, scale } from "./judges.js";
import {
  admitAbove,
  admitAfterScoring,
  admitDrawn,
  Archive,
  neighboursOf,
  Occupancy,
  scoreCells,
  scorePoints,
} from "./novelty.js";
import { breed, drawGenomes } from "./operators.js";
import { Sfc64 } from "./random.js";
import { Walker, WEIGHTS } from "./robot.js";
import { rowOf, rowsOf } from "./rows.js";

/** A run, to be advanced generation by generation. Matrices are Float64Arrays, row after row. */
export class Evolution {
  constructor(maze, algorithm, seed, parameters = {}) {
    this.maze = maze;
    this.parameters = checkedParameters(parameters);
    const { objectives, rating, scaling, judging } = checkedAlgorithm(algorithm);
    const { population, archive, steps, tournament, elites, crossover, mutation } = this.parameters;
    this.rng = new Sfc64(seed);

    this.genomes = new Float64Array(population * WEIGHTS);
    drawGenomes(this.rng, -1, 1, this.genomes);
    if (objectives === null) {
      this.objectives = new Float64Array(this.parameters.objectives * COMPONENTS.length);
      drawGenomes(this.rng, 0, 1, this.objectives);
    } else this.objectives = Float64Array.from(objectives.flat());
    const judges = this.objectives.length / COMPONENTS.length;
    this.isRandomSearch = judges === 0;
    this.rating = rating;
    this.evolving = rating !== "none";
    if (this.evolving && elites >= judges) {
      throw new InputError(`elites must be fewer than the ${judges} objective functions; got ${elites}`);
    }
    // can an objective function weigh it?
    this.weighed = COMPONENTS.map((_, component) =>
      this.evolving || this.objectives.some((c, i) => i % COMPONENTS.length === component && c !== 0)
    );
    const rates = { tournament, elites, crossover, mutation };
    this.breeding = { ...rates, low: -1, high: 1, judging };
    this.objectiveBreeding = { ...rates, low: 0, high: 1 };

    this.endpoints = new Float64Array(population * 2); // row and column
    this.distances = new Float64Array(population); // to the goal, taxicab
    this.components = COMPONENTS.map(() => new Float64Array(population));
    this.scaling = scaling;
    // what objective functions weigh
    this.scaled = scaling === "raw" ? this.components : COMPONENTS.map(() => new Float64Array(population));
    this.fitness = new Float64Array(population);
    this.winners = new Int32Array(population); // which objective function gave a solution its fitness
    this.archive = new Archive(archive, 2);
    this.archiveBefore = new Archive(archive, 2); // as it was before this generation was scored
    this.threshold = { value: this.parameters.threshold, idle: 0 }; // of admission by threshold
    this.occupancy = new Occupancy(maze.height, maze.width); // of the archive's points
    this.objectiveFitness = new Float64Array(judges);
    this.objectiveArchive = new Archive(archive, COMPONENTS.length);
    this.number = -1; // of the generation
    this.best = { distance: Infinity, controller: null, coefficients: [], endpoint: null };
    this.isOver = false;
    this.offspring = new Float64Array(this.genomes.length);
    this.objectiveOffspring = new Float64Array(this.objectives.length);
    this.walker = new Walker(maze, steps);
  }

  /** Breed the next generation and evaluate it (the first is only evaluated). Is there another after it? */
  advance() {
    if (this.number >= 0) this.#breedBoth();
    this.number++;
    this.#evaluate();
    this.#keepBest();
    if (this.rating === "genotypic novelty") {
      // Algorithm 2: the fitness of an objective function is the novelty of its genome
      scorePoints(this.objectives, this.objectiveArchive, this.parameters.k, false, this.objectiveFitness);
    } else if (this.evolving) {
      correlations(this.#judges, this.distances, this.rating === "spearman", this.objectiveFitness);
    }
    const isLast = this.number + 1 >= this.parameters.generations;
    // random search has no first success to stop at: it looks for the best of all that it may draw
    this.isOver = isLast || (this.hasSucceeded && !this.isRandomSearch);
    return !this.isOver;
  }

  get hasSucceeded() {
    return this.best.distance <= this.parameters.success_distance;
  }

  /** The run so far; as safe.Run. */
  result() {
    return {
      success: this.hasSucceeded,
      generation: this.number,
      distance: this.best.distance,
      controller: this.best.controller,
      coefficients: this.best.coefficients,
      evaluations: (this.number + 1) * this.parameters.population,
    };
  }

  /** The generation, as plain arrays; as safe.Generation. */
  generation() {
    const listed = (values, isThere) => (isThere ? Array.from(values) : null);
    return {
      ...this.result(),
      genomes: rowsOf(this.genomes, WEIGHTS),
      endpoints: rowsOf(this.endpoints, 2),
      distances: Array.from(this.distances),
      components: this.components.map((values) => Array.from(values)),
      scaled: this.scaling === "raw" ? null : this.scaled.map((values) => Array.from(values)),
      novelty: listed(this.components[NOVELTY], this.weighed[NOVELTY]),
      fitness: listed(this.fitness, !this.isRandomSearch),
      objectives: rowsOf(this.objectives, COMPONENTS.length),
      objectiveFitness: listed(this.objectiveFitness, this.evolving),
      winners: listed(this.winners, !this.isRandomSearch),
      archive: this.archive.listed(),
      objectiveArchive: this.objectiveArchive.listed(),
    };
  }

  /** The cells that a robot stands on, the start first, until its path comes back to one. */
  route(controller) {
    this.walker.walk(controller, 0);
    return this.walker.route;
  }

  /** The k nearest neighbours by which the i-th solution of this generation was scored: see `neighboursOf`. */
  neighbours(i) {
    const { endpoints, distances, archiveBefore, parameters: { k } } = this;
    return neighboursOf(endpoints, distances.length, i, archiveBefore, this.#isOffering ? i : 0, k, true);
  }

  /** Is each solution offered to the archive right after it is scored? */
  get #isOffering() {
    return this.parameters.admission === "lowest replaced";
  }

  /** The objective functions, and what they weigh. */
  get #judges() {
    return { objectives: this.objectives, components: this.scaled };
  }

  /** End points, components, fitness. */
  #evaluate() {
    const { genomes, endpoints, distances, walker, parameters } = this;
    const [goalRow, goalColumn] = this.maze.goal;
    for (let i = 0; i < distances.length; i++) {
      walker.walk(genomes, i * WEIGHTS);
      const end = walker.cellAt(parameters.steps);
      const row = Math.floor(end / this.maze.width), column = end % this.maze.width;
      endpoints[2 * i] = row;
      endpoints[2 * i + 1] = column;
      const distance = Math.abs(row - goalRow) + Math.abs(column - goalColumn);
      distances[i] = distance;
      // at the goal itself 1 / distance has no value: it counts as at distance 1/2
      this.components[GOAL][i] = distance > 0 ? 1 / distance : 2;
    }
    if (this.weighed[NOVELTY]) this.#scoreNovelty();
    if (this.scaling !== "raw") {
      this.components.forEach((values, c) => this.weighed[c] && scale(values, this.scaling, this.scaled[c]));
    }
    if (!this.isRandomSearch) bestScores(this.#judges, this.fitness, this.winners);
  }

  #scoreNovelty() {
    const { endpoints, archive, occupancy, parameters: { k, admission, admitted } } = this;
    const novelty = this.components[NOVELTY];
    this.archiveBefore.copyFrom(archive);
    scoreCells(endpoints, archive, occupancy, k, admission, novelty);
    if (admission === "random") admitDrawn(endpoints, archive, occupancy, admitted, this.rng, novelty);
    else if (admission === "threshold") admitAbove(endpoints, archive, occupancy, this.threshold, novelty);
    else if (!this.#isOffering) admitAfterScoring(endpoints, archive, occupancy, admission === "distinct", novelty);
  }

  /** Keep the first solution that is nearer to the goal than all before it. */
  #keepBest() {
    for (let i = 0; i < this.distances.length; i++) {
      if (this.distances[i] < this.best.distance) {
        this.best = {
          distance: this.distances[i],
          controller: rowOf(this.genomes, i, WEIGHTS),
          coefficients: this.isRandomSearch ? [] : rowOf(this.objectives, this.winners[i], COMPONENTS.length),
          endpoint: rowOf(this.endpoints, i, 2),
        };
      }
    }
  }

  /** The next generation of solutions and, if they evolve, of objective functions. */
  #breedBoth() {
    if (this.isRandomSearch) return drawGenomes(this.rng, -1, 1, this.genomes);
    const judges = this.#judges;
    breed(this.genomes, this.fitness, judges, this.breeding, this.rng, this.offspring);
    [this.genomes, this.offspring] = [this.offspring, this.genomes];
    if (this.evolving) {
      breed(this.objectives, this.objectiveFitness, judges, this.objectiveBreeding, this.rng, this.objectiveOffspring);
      [this.objectives, this.objectiveOffspring] = [this.objectiveOffspring, this.objectives];
    }
  }
}

/** One run, from its first generation to its end; as safe.evolve. */
export function evolve(maze, algorithm, seed, parameters = {}) {
  const evolution = new Evolution(maze, algorithm, seed, parameters);
  while (evolution.advance());
  return evolution.result();
}

/** One run, generation by generation; as safe.generations. Arguments are checked at once, not at the first step. */
export function generations(maze, algorithm, seed, parameters = {}) {
  return eachGeneration(new Evolution(maze, algorithm, seed, parameters));
}

function* eachGeneration(evolution) {
  while (!evolution.isOver) {
    evolution.advance();
    yield evolution.generation();
  }
}
