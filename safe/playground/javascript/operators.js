// Selection and variation: how the next generation is bred (see safe/operators.py, also for the order of the draws).
//
// Genomes are rows of one Float64Array. `breeding` holds tournament, elites, crossover, mutation, and low and high, the
// range of a gene.

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

/** Put the next generation into `offspring`: the elites first, the fittest at the front, then the pairs. */
export function breed(genomes, fitness, breeding, rng, offspring) {
  const n = fitness.length, length = genomes.length / n;
  const copy = (parent, place) => {
    for (let gene = 0; gene < length; gene++) offspring[place * length + gene] = genomes[parent * length + gene];
  };
  const isElite = new Uint8Array(n);
  for (let place = 0; place < breeding.elites; place++) {
    let fittest = -1;
    for (let i = 0; i < n; i++) {
      if (!isElite[i] && (fittest < 0 || fitness[i] > fitness[fittest])) fittest = i;
    }
    isElite[fittest] = 1;
    copy(fittest, place);
  }
  for (let place = breeding.elites; place < n; place += 2) {
    copy(tournament(fitness, breeding.tournament, rng), place);
    copy(tournament(fitness, breeding.tournament, rng), place + 1);
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
