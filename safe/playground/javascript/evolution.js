// The generational loop, the same for every algorithm (see safe/evolution.py, also for the order of the draws).

import { checkedAlgorithm, checkedParameters, genesOf } from "./algorithms.js";
import { InputError } from "./checks.js";
import { bestScores, placeOf, scale, weighersOf } from "./judges.js";
import { waysToGoal } from "./maze.js";
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
import { Visits } from "./paths.js";
import { Sfc64 } from "./random.js";
import {
  correlations,
  discoveries,
  highestScores,
  isBredBy,
  isOfPaths,
  nearestSoFar,
  redrawGoals,
  shuffle,
} from "./ratings.js";
import { Repertoire } from "./repertoire.js";
import { Walker, WEIGHTS } from "./robot.js";
import { rowOf } from "./rows.js";
import { byChance, byDrawnJudge, byFavourite, byFitness, elitesOf, scoresOfDrawn } from "./selection.js";

export const RULES = 1; // version of the rules that runs follow; that of safe/evolution.py

/** A run, to be advanced generation by generation. Matrices are Float64Arrays, row after row. */
export class Evolution {
  constructor(maze, algorithm, seed, parameters = {}) {
    this.maze = maze;
    this.parameters = checkedParameters(parameters);
    this.algorithm = checkedAlgorithm(algorithm);
    const { objectives, rating, scaling, kind, components, pool } = this.algorithm;
    const { population, archive, steps, elites } = this.parameters;
    this.rng = new Sfc64(seed);

    this.genomes = new Float64Array(population * WEIGHTS);
    drawGenomes(this.rng, -1, 1, this.genomes);
    this.genes = genesOf(this.algorithm); // of an objective function
    if (objectives === null) {
      this.objectives = new Float64Array(this.parameters.objectives * this.genes);
      drawGenomes(this.rng, 0, 1, this.objectives);
    } else this.objectives = Float64Array.from(objectives.flat());
    const judges = this.objectives.length / this.genes;
    this.isJudged = judges > 0;
    this.isRandomSearch = !this.isJudged && pool === "generation";
    if (rating !== "none" && elites >= judges) {
      throw new InputError(`elites must be fewer than the ${judges} objective functions; got ${elites}`);
    }
    this.weighers = weighersOf(kind, judges); // objective functions that weigh components
    // can an objective function weigh it?
    const weighing = this.objectives.subarray(0, this.weighers * this.genes);
    this.weighed = components.map((_, component) =>
      this.weighers > 0 && (rating !== "none" || weighing.some((c, i) => i % this.genes === component && c !== 0))
    );
    this.novelty = components.indexOf("novelty"); // the component
    this.isNoveltyWeighed = this.weighed[this.novelty] ?? false;

    this.endpoints = new Float64Array(population * 2); // row and column
    this.distances = new Float64Array(population); // to the goal, taxicab
    this.ways = this.#isWeighed("1 / way") ? waysToGoal(maze) : null; // to the goal, from each cell
    this.visits = isOfPaths(rating) || this.#isWeighed("path rarity") ? new Visits(maze, population) : null;
    this.repertoire = pool === "repertoire" ? new Repertoire(maze, WEIGHTS) : null;
    this.components = components.map(() => new Float64Array(population));
    // what objective functions weigh
    this.scaled = scaling === "raw" ? this.components : components.map(() => new Float64Array(population));
    this.fitness = new Float64Array(population);
    this.winners = new Int32Array(population); // which objective function gave a solution its fitness
    this.archive = new Archive(archive, 2);
    this.archiveBefore = new Archive(archive, 2); // as it was before this generation was scored
    this.threshold = { value: this.parameters.threshold, idle: 0 }; // of admission by threshold
    this.occupancy = new Occupancy(maze.height, maze.width); // of the archive's points
    this.objectiveFitness = new Float64Array(judges).fill(rating === "patience" ? -Infinity : 0);
    this.objectiveArchive = new Archive(archive, this.genes);
    this.idle = new Float64Array(judges); // generations since a robot came nearer to a goal, with patience
    this.number = -1; // of the generation
    this.best = { distance: Infinity, controller: null, coefficients: [], endpoint: null, goal: null };
    this.isOver = false;
    this.parents = new Int32Array(population).fill(-1); // of whom each solution is a copy, before crossover
    this.chosenBy = this.parents.slice(); // the objective function, of the generation before, that chose the parent
    this.objectiveParents = null; // likewise
    this.walker = new Walker(maze, steps);
  }

  /** Breed the next generation and evaluate it (the first is only evaluated). Is there another after it? */
  advance() {
    if (this.number >= 0) this.#breedBoth();
    this.number++;
    this.#evaluate();
    this.#keepBest();
    this.repertoire?.update(this.genomes, this.endpoints);
    this.#rate();
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

  /** Can an objective function weigh a component of this name? */
  #isWeighed(name) {
    return this.weighed[this.algorithm.components.indexOf(name)] ?? false;
  }

  /** The objective functions, and what they judge; see judges.js. */
  get judges() {
    const { objectives, genes, weighers, scaled, endpoints, maze: { height, width } } = this;
    return { objectives, genes, weighers, components: scaled, endpoints, height, width };
  }

  /** The place that won the i-th solution its fitness; null if no goal did. */
  goalOf(i) {
    const { isJudged, winners, weighers } = this;
    return isJudged && winners[i] >= weighers ? placeOf(this.judges, winners[i]) : null;
  }

  /** End points, components, fitness. */
  #evaluate() {
    const { genomes, endpoints, distances, walker, visits, parameters } = this;
    const [goalRow, goalColumn] = this.maze.goal;
    for (let i = 0; i < distances.length; i++) {
      walker.walk(genomes, i * WEIGHTS);
      const end = walker.cellAt(parameters.steps);
      const row = Math.floor(end / this.maze.width), column = end % this.maze.width;
      endpoints[2 * i] = row;
      endpoints[2 * i + 1] = column;
      distances[i] = Math.abs(row - goalRow) + Math.abs(column - goalColumn);
      visits?.add(i, walker.trail, walker.length);
    }
    this.algorithm.components.forEach((name, c) => this.#measure(name, this.weighed[c], this.components[c]));
    const { scaling } = this.algorithm;
    if (scaling !== "raw") {
      this.components.forEach((values, c) => this.weighed[c] && scale(values, scaling, this.scaled[c]));
    }
    if (this.isJudged) bestScores(this.judges, this.fitness, this.winners);
  }

  /** A component of all solutions. Closeness is always measured, and others if they are weighed. */
  #measure(name, isWeighed, values) {
    const { distances, endpoints, ways, maze } = this;
    if (name === "1 / distance") { for (let i = 0; i < values.length; i++) values[i] = nearness(distances[i]); }
    else if (!isWeighed) return;
    else if (name === "novelty") this.#scoreNovelty(values);
    else if (name === "path rarity") this.visits.rarities(values);
    else {
      for (let i = 0; i < values.length; i++) {
        values[i] = nearness(ways[endpoints[2 * i] * maze.width + endpoints[2 * i + 1]]);
      }
    }
  }

  #scoreNovelty(novelty) {
    const { endpoints, archive, occupancy, parameters: { k, admission, admitted } } = this;
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
          coefficients: this.isJudged ? rowOf(this.objectives, this.winners[i], this.genes) : [],
          endpoint: rowOf(this.endpoints, i, 2),
          goal: this.goalOf(i),
        };
      }
    }
  }

  /** The fitness of objective functions, if they are rated. */
  #rate() {
    const { algorithm: { rating }, judges, distances, objectiveFitness } = this;
    if (rating === "genotypic novelty") {
      // Algorithm 2: the fitness of an objective function is the novelty of its genome
      scorePoints(this.objectives, this.objectiveArchive, this.parameters.k, false, objectiveFitness);
    } else if (rating === "pearson" || rating === "spearman") {
      correlations(judges, distances, rating === "spearman", objectiveFitness);
    } else if (rating === "mutualism" || rating === "competition") {
      highestScores(judges, distances.length, rating === "mutualism" ? 1 : -1, objectiveFitness);
    } else if (isOfPaths(rating)) {
      if (this.number > 0) discoveries(this.visits.found, this.chosenBy, this.objectiveParents, objectiveFitness);
      if (rating === "shuffled") shuffle(objectiveFitness, this.rng);
    } else if (rating === "patience") nearestSoFar(judges, distances.length, objectiveFitness, this.idle);
  }

  /** The next generation of solutions and, unless they stay, of objective functions. */
  #breedBoth() {
    if (this.isRandomSearch) return drawGenomes(this.rng, -1, 1, this.genomes);
    const { algorithm: { rating }, parameters, rng, objectives, objectiveFitness } = this;
    const { tournament, crossover, mutation, elites, patience } = parameters;
    const rates = { crossover, mutation, low: -1, high: 1 }, n = this.fitness.length;
    const brood = breed(this.genomes, n, this.#elites(), this.#selector(), rates, rng);
    if (isBredBy(rating)) {
      const m = objectiveFitness.length, best = elitesOf(m, elites, () => objectiveFitness);
      const select = byFitness(objectives, objectiveFitness, null, tournament, rng);
      const next = breed(objectives, m, best, select, { ...rates, low: 0 }, rng);
      this.objectives = next.offspring;
      this.objectiveParents = next.parents;
    } else if (rating === "redrawn") drawGenomes(rng, 0, 1, objectives);
    else if (rating === "patience") redrawGoals(objectives, objectiveFitness, this.idle, patience, rng);
    Object.assign(this, { genomes: brood.offspring, parents: brood.parents, chosenBy: brood.chosenBy });
  }

  /** The solutions that pass on unchanged: none, if parents are taken from a repertoire. */
  #elites() {
    const { judges, fitness, repertoire, rng, parameters: { elites } } = this, n = fitness.length;
    if (repertoire) return [];
    const isCommon = this.algorithm.judging === "best score";
    return elitesOf(n, elites, isCommon ? () => fitness : scoresOfDrawn(judges, n, rng));
  }

  /** What selects the parents of solutions; see selection.js. */
  #selector() {
    const { genomes, fitness, winners, judges, repertoire, rng, parameters: { tournament } } = this;
    const { judging } = this.algorithm, n = fitness.length;
    if (!this.isJudged) return byChance(repertoire, rng);
    if (judging === "best score") return byFitness(genomes, fitness, winners, tournament, rng);
    if (judging === "favourite") return byFavourite(genomes, repertoire, judges, n, rng);
    return byDrawnJudge(genomes, repertoire, judges, n, tournament, rng);
  }
}

/** 1 / distance to the goal; at the goal itself, where that has no value, as at distance 1/2. */
function nearness(distance) {
  return distance > 0 ? 1 / distance : 2;
}

/** One run, from its first generation to its end; as safe.evolve. */
export function evolve(maze, algorithm, seed, parameters = {}) {
  const evolution = new Evolution(maze, algorithm, seed, parameters);
  while (evolution.advance());
  return evolution.result();
}
