// How sure a rate of success is (see safe/results/statistics.py).

const QUANTILE = 1.959963984540054; // of the normal distribution, for 95 %

/** Wilson's 95 % interval for a rate of success, [low, high]; of no runs at all, [0, 1]. */
export function successInterval(successes, runs) {
  if (runs === 0) return [0, 1];
  const rate = successes / runs, square = QUANTILE ** 2;
  const middle = (rate + square / (2 * runs)) / (1 + square / runs);
  const half = (QUANTILE / (1 + square / runs)) * Math.sqrt((rate * (1 - rate)) / runs + square / (4 * runs ** 2));
  return [successes === 0 ? 0 : Math.max(0, middle - half), successes === runs ? 1 : Math.min(1, middle + half)];
}
