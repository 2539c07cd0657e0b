// Selection and variation: how the next generation is bred (see safe/operators.py, also for the order of the draws).
//
// Genomes are rows of one Float64Array. `breeding` holds tournament, elites, crossover, mutation, low and high, the range
// of a gene, and judging.

import { scoreAll, scoreOne } from "./judges.js";

export const JUDGINGS = ["best score", "drawn judge"]; // of solutions, when some of them are selected

/** A uniform value in [low, high). */
function drawUniform(rng, low, high) {
  return low + (high - low) * rng.random();
}

/** A uniform index in 0..n-1. */
function drawIndex(rng, n) {
  return Math.floor(rng.random() * n);
}

/** Fill all genomes with uniform values, one genome after the other. */
export function drawGenomes(rng, low, high, genomes) {
  for (let gene = 0; gene < genomes.length; gene++) genomes[gene] = drawUniform(rng, low, high);
}

/** The fittest of `size` individuals drawn with replacement, the first drawn on a tie. */
function tournament(fitness, size, rng) {
  let winner = drawIndex(rng, fitness.length);
  for (let i = 1; i < size; i++) {
    const rival = drawIndex(rng, fitness.length);
    if (fitness[rival] > fitness[winner]) winner = rival;
  }
  return winner;
}

/** The same by the scores that one objective function gives, which is drawn after the individuals. */
function judgedTournament(judges, n, drawn, rng) {
  for (let i = 0; i < drawn.length; i++) drawn[i] = drawIndex(rng, n);
  const judge = drawJudge(judges, rng);
  let winner = drawn[0], best = scoreOne(judges, judge, winner);
  for (let i = 1; i < drawn.length; i++) {
    const rival = scoreOne(judges, judge, drawn[i]);
    if (rival > best) {
      winner = drawn[i];
      best = rival;
    }
  }
  return winner;
}

function drawJudge({ objectives, components }, rng) {
  return drawIndex(rng, objectives.length / components.length);
}

/** Put the next generation into `offspring`: the elites first, the fittest at the front, then the pairs. */
export function breed(genomes, fitness, judges, breeding, rng, offspring) {
  const n = fitness.length, length = genomes.length / n;
  const isJudged = breeding.judging === "drawn judge";
  const scores = isJudged ? new Float64Array(n) : fitness;
  const drawn = new Int32Array(isJudged ? breeding.tournament : 0);
  const select = () =>
    isJudged ? judgedTournament(judges, n, drawn, rng) : tournament(fitness, breeding.tournament, rng);
  const copy = (parent, place) => {
    for (let gene = 0; gene < length; gene++) offspring[place * length + gene] = genomes[parent * length + gene];
  };
  const isElite = new Uint8Array(n);
  for (let place = 0; place < breeding.elites; place++) {
    if (isJudged) scoreAll(judges, drawJudge(judges, rng), scores);
    let fittest = -1;
    for (let i = 0; i < n; i++) {
      if (!isElite[i] && (fittest < 0 || scores[i] > scores[fittest])) fittest = i;
    }
    isElite[fittest] = 1;
    copy(fittest, place);
  }
  for (let place = breeding.elites; place < n; place += 2) {
    copy(select(), place);
    copy(select(), place + 1);
    if (rng.random() < breeding.crossover) {
      for (let gene = 1 + drawIndex(rng, length - 1); gene < length; gene++) {
        const first = place * length + gene, second = first + length;
        [offspring[first], offspring[second]] = [offspring[second], offspring[first]];
      }
    }
    for (let child = place; child < place + 2; child++) {
      if (rng.random() < breeding.mutation) {
        const gene = drawIndex(rng, length);
        offspring[child * length + gene] = drawUniform(rng, breeding.low, breeding.high);
      }
    }
  }
}
