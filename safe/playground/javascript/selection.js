// Who passes on unchanged, and who become parents (see safe/operators.py, also for the order of the draws).

import { countOf, distanceTo, placeOf, scoreAll, scoreOne } from "./judges.js";

export const JUDGINGS = ["best score", "drawn judge", "favourite"]; // of solutions, when some of them are selected
export const POOLS = ["generation", "repertoire"]; // from which parents are taken

/** A uniform index in 0..n-1. */
export function drawIndex(rng, n) {
  return Math.floor(rng.random() * n);
}

/** So many individuals among n: each the fittest that is not yet one of them, the first on a tie.
 *
 * nextFitness: gives the fitness of all by which the next is taken. */
export function elitesOf(n, count, nextFitness) {
  const elites = [], isElite = new Uint8Array(n);
  while (elites.length < count) {
    const fitness = nextFitness();
    let fittest = -1;
    for (let i = 0; i < n; i++) {
      if (!isElite[i] && (fittest < 0 || fitness[i] > fitness[fittest])) fittest = i;
    }
    isElite[fittest] = 1;
    elites.push(fittest);
  }
  return elites;
}

/** A function that gives all scores by an objective function that it draws. */
export function scoresOfDrawn(judges, n, rng) {
  const scores = new Float64Array(n);
  return () => {
    scoreAll(judges, drawIndex(rng, countOf(judges)), scores);
    return scores;
  };
}

// The following give functions that select the next parent: { genomes, parent, judge }, its index there and that of the
// objective function that chose it, or -1.

/** By tournaments of some size: the fittest of those drawn with replacement wins, the first drawn on a tie.
 *
 * winners: the objective functions to which solutions owe their fitness; null if these are not solutions. */
export function byFitness(genomes, fitness, winners, size, rng) {
  return () => {
    let parent = drawIndex(rng, fitness.length);
    for (let i = 1; i < size; i++) {
      const rival = drawIndex(rng, fitness.length);
      if (fitness[rival] > fitness[parent]) parent = rival;
    }
    return { genomes, parent, judge: winners ? winners[parent] : -1 };
  };
}

/** The same by the scores of one objective function, which is drawn after the individuals.
 *
 * repertoire: from which parents are taken; null if it is the generation. */
export function byDrawnJudge(genomes, repertoire, judges, n, size, rng) {
  const drawn = new Int32Array(size);
  const scoreOf = repertoire
    ? (j, slot) => -distanceTo(placeOf(judges, j), repertoire.cells, slot)
    : (j, i) => scoreOne(judges, j, i);
  return () => {
    for (let i = 0; i < size; i++) drawn[i] = drawIndex(rng, repertoire?.size ?? n);
    const judge = drawIndex(rng, countOf(judges));
    let parent = drawn[0], best = scoreOf(judge, parent);
    for (let i = 1; i < size; i++) {
      const score = scoreOf(judge, drawn[i]);
      if (score > best) {
        parent = drawn[i];
        best = score;
      }
    }
    return { genomes: repertoire?.genomes ?? genomes, parent, judge };
  };
}

/** The one that a drawn objective function scores highest: a goal in the repertoire, if there is one, others in the
 * generation. */
export function byFavourite(genomes, repertoire, judges, n, rng) {
  return () => {
    const judge = drawIndex(rng, countOf(judges)), isKnown = repertoire && judge >= judges.weighers;
    const parent = favouriteOf(judges, judge, repertoire, n);
    return { genomes: isKnown ? repertoire.genomes : genomes, parent, judge };
  };
}

/** The favourite of the j-th objective function, likewise. */
export function favouriteOf(judges, j, repertoire, n) {
  if (repertoire && j >= judges.weighers) return repertoire.nearestTo(placeOf(judges, j));
  const scores = new Float64Array(n);
  scoreAll(judges, j, scores);
  let favourite = 0;
  for (let i = 1; i < n; i++) if (scores[i] > scores[favourite]) favourite = i;
  return favourite;
}

/** Any of the repertoire: nobody judges. */
export function byChance(repertoire, rng) {
  return () => ({ genomes: repertoire.genomes, parent: drawIndex(rng, repertoire.size), judge: -1 });
}
