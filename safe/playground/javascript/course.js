// A class that shares the runs of an experiment: seat s makes so many runs, and none that another seat makes.
//
// The runs are those of the package's safe.Experiment, one for each algorithm. (`class` means something else in
// JavaScript.)

import { checkedInteger, InputError, MOST, shown } from "./checks.js";
import { digestOf } from "./digest.js";

const LONGEST_NAME = 40; // characters
export const MOST_SEATS = 1000;
const MOST_SEEDS = 2n ** 128n; // of an experiment

/** A class { name, seats, seat }, checked; `seat` is null until it is known. */
export function checkedCourse({ name, seats = 30, seat = null }) {
  if (typeof name !== "string" || name.trim() === "" || [...name].length > LONGEST_NAME) {
    throw new InputError(`class must have a name of 1 to ${LONGEST_NAME} characters; got ${shown(name)}`);
  }
  checkedInteger("seats", seats, 1, MOST_SEATS);
  if (seat !== null) checkedInteger("seat", seat, 1, seats);
  return { name, seats, seat };
}

/** The experiments of a class: for each algorithm { algorithm, digest }. Throws an InputError if they cannot be shared. */
export function experimentsOf({ seats }, { maze, algorithms, seed: { entropy, spawnKey }, parameters, runs }) {
  if (entropy.length > 1 || spawnKey.length > 0 || entropy[0] >= MOST_SEEDS) {
    throw new InputError("seed must be an integer below 2**128 for a class, which shares the runs of an experiment");
  }
  checkedInteger("seats times runs", seats * runs, 1, MOST);
  return algorithms.map((algorithm) => ({ algorithm, digest: digestOf(maze, algorithm, entropy[0], parameters) }));
}

/** The number of the first run of a seat. */
export function firstRunOf(seat, runs) {
  return (seat - 1) * runs;
}

/** The seed of a run of an experiment. */
export function seedOfRun(digest, number) {
  return { entropy: [BigInt(`0x${digest}`)], spawnKey: [BigInt(number)] };
}
