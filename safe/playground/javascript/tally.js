// Successes counted run by run, and what they say of two algorithms.

import { kindOf, titleOf } from "./labels.js";
import { successInterval } from "./statistics.js";

/** Successes after each run that is over and before which all are: { runs, successes, low, high }, the 95 % interval.
 *
 * results: by the number of a run, whether it succeeded; undefined if it is not over. */
export function tally(results) {
  const counts = [];
  let successes = 0;
  for (let runs = 1; results[runs - 1] !== undefined; runs++) {
    successes += results[runs - 1];
    const [low, high] = successInterval(successes, runs);
    counts.push({ runs, successes, low, high });
  }
  return counts;
}

/** The line of a chart for the rate after each run, with its interval. */
export function seriesOfRates({ algorithm, counts }) {
  return {
    label: titleOf(algorithm),
    kind: kindOf(algorithm),
    points: counts.map(({ runs, successes }) => [runs, (100 * successes) / runs]),
    band: counts.map(({ runs, low, high }) => [runs, 100 * low, 100 * high]),
  };
}

/** For each pair of algorithms: since which run their intervals have been apart. tallies: { algorithm, counts }. */
export function compareTallies(tallies) {
  const pairs = tallies.flatMap((one, i) => tallies.slice(i + 1).map((other) => [one, other]));
  return pairs.map(comparePair).filter((sentence) => sentence).join(" ");
}

function comparePair([one, other]) {
  const runs = Math.min(one.counts.length, other.counts.length);
  if (runs === 0) return null;
  const areApart = (i) => one.counts[i].low > other.counts[i].high || other.counts[i].low > one.counts[i].high;
  let first = runs; // from which on they are apart
  while (first > 0 && areApart(first - 1)) first--;
  const pair = `${titleOf(one.algorithm)} and ${titleOf(other.algorithm)}`;
  return first < runs
    ? `${pair}: their intervals have been apart since run ${first + 1}.`
    : `${pair}: after ${runs} runs their intervals overlap, which does not show that they are equal.`;
}
