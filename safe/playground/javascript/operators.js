// Variation: how the next generation is bred (see safe/operators.py, also for the order of the draws).
//
// Genomes are rows of one Float64Array.

import { drawIndex } from "./selection.js";

/** A uniform value in [low, high). */
function drawUniform(rng, low, high) {
  return low + (high - low) * rng.random();
}

/** Fill all genomes with uniform values, one genome after the other. */
export function drawGenomes(rng, low, high, genomes) {
  for (let gene = 0; gene < genomes.length; gene++) genomes[gene] = drawUniform(rng, low, high);
}

/** The next generation: the elites first, the fittest at the front, then the pairs.
 *
 * elites: the indices in `genomes`, of n, that pass on unchanged. select: gives a parent (see selection.js). rates:
 * { crossover, mutation, low and high, the range of a gene }. Returns { offspring, parents, chosenBy }: genomes, and of
 * which parent each was a copy before crossover, and the objective function that chose that. */
export function breed(genomes, n, elites, select, rates, rng) {
  const offspring = new Float64Array(genomes.length), length = genomes.length / n;
  const parents = new Int32Array(n), chosenBy = new Int32Array(n);
  const copy = (place, { genomes, parent, judge }) => {
    for (let gene = 0; gene < length; gene++) offspring[place * length + gene] = genomes[parent * length + gene];
    parents[place] = parent;
    chosenBy[place] = judge;
  };
  elites.forEach((parent, place) => copy(place, { genomes, parent, judge: -1 }));
  for (let place = elites.length; place < n; place += 2) {
    copy(place, select());
    copy(place + 1, select());
    if (rng.random() < rates.crossover) {
      for (let gene = 1 + drawIndex(rng, length - 1); gene < length; gene++) {
        const first = place * length + gene, second = first + length;
        [offspring[first], offspring[second]] = [offspring[second], offspring[first]];
      }
    }
    for (let child = place; child < place + 2; child++) {
      if (rng.random() < rates.mutation) {
        const gene = drawIndex(rng, length);
        offspring[child * length + gene] = drawUniform(rng, rates.low, rates.high);
      }
    }
  }
  return { offspring, parents, chosenBy };
}
