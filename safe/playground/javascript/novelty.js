// Novelty: how far a point lies from the points seen so far, its nearest neighbours first (see safe/novelty.py).
//
// The novelty of a point is the sum of its distances to its k nearest neighbours, divided by k. The neighbours are all
// other points of the population, and all points of an archive. The points of a generation are scored in order, and
// each is offered to the archive right after its score is known. By the other rules of admission, to the archive of end
// points, points enter only after all are scored: "random" and "threshold" replace the oldest, the others the lowest.

import { Grid } from "./neighbours.js";
import { rowOf } from "./rows.js";

export const K = 15;
export const ARCHIVE_CAPACITY = 1000;
export const ADMISSIONS = ["lowest replaced", "random", "threshold", "after scoring", "distinct", "rescored"];
const MOST_ENTRIES = 4; // in a generation: if more enter, the threshold rises
const RISE = 1.2;
const MOST_IDLE = 2500; // evaluations without an entry: after them, the threshold falls
const FALL = 0.95;

/** Points with their scores, in a fixed number of places. */
export class Archive {
  constructor(capacity, dimensions) {
    this.dimensions = dimensions;
    this.capacity = capacity;
    this.points = new Float64Array(capacity * dimensions); // one point after the other
    this.scores = new Float64Array(capacity); // as they were on entry, unless they are computed again
    this.entry = new Float64Array(capacity); // 0 for the first point that ever entered
    this.size = 0;
    this.entered = 0; // points that ever entered
    this.lowest = -1; // the place of the lowest score, the oldest of equals, once all places are taken
  }

  /** A point enters if it scores above this: anything while there is room, then the lowest score. */
  get threshold() {
    if (this.size < this.capacity) return -1;
    return this.capacity > 0 ? this.scores[this.lowest] : Infinity;
  }

  /** The place for the next point that enters: a free one, or that of the lowest score. */
  get nextPlace() {
    return this.size < this.capacity ? this.size : this.lowest;
  }

  /** Where the oldest point is, or the next free place, if no point ever enters elsewhere: round and round. */
  get oldestPlace() {
    return this.entered % this.capacity;
  }

  /** Let the i-th of some points in, at a place. */
  put(place, points, i, score) {
    const { dimensions } = this;
    for (let axis = 0; axis < dimensions; axis++) {
      this.points[place * dimensions + axis] = points[i * dimensions + axis];
    }
    this.scores[place] = score;
    this.entry[place] = this.entered++;
    if (place === this.size) this.size++;
  }

  /** Let the i-th of some points in, at the next place. */
  enter(points, i, score) {
    this.put(this.nextPlace, points, i, score);
    this.#findLowest();
  }

  /** Compute all scores again, from places. */
  rescore(scoreAt) {
    for (let place = 0; place < this.size; place++) this.scores[place] = scoreAt(place);
    this.#findLowest();
  }

  #findLowest() {
    const { scores, entry } = this;
    if (this.size < this.capacity) return;
    let lowest = 0;
    for (let j = 1; j < this.size; j++) {
      if (scores[j] < scores[lowest] || (scores[j] === scores[lowest] && entry[j] < entry[lowest])) lowest = j;
    }
    this.lowest = lowest;
  }

  /** Become equal to another archive of the same capacity and dimensions. */
  copyFrom(other) {
    this.points.set(other.points.subarray(0, other.size * other.dimensions));
    this.scores.set(other.scores.subarray(0, other.size));
    this.entry.set(other.entry.subarray(0, other.size));
    this.size = other.size;
    this.entered = other.entered;
    this.lowest = other.lowest;
  }
}

// There are two ways to find the nearest neighbours, and both are exact.
//
// End points are cells of a maze, so taxicab distances are whole numbers and many points share a cell. `scoreCells`
// counts the points in every cell, and adds the counts up ring by ring around a point until it has k neighbours. If
// these lie beyond the rings, as in a large and empty maze, it measures the distance to every point.
//
// `scorePoints` serves any points, and searches a grid for the neighbours of each (see neighbours.js).

const RINGS = 24; // of cells around a point that are searched

/** How many points are in each cell of a maze (none), with a margin of RINGS around it that never holds any. */
export class Occupancy {
  constructor(height, width) {
    this.width = width + 2 * RINGS;
    this.counts = new Int32Array((height + 2 * RINGS) * this.width);
  }

  /** The place in `counts` of the i-th of some cells. */
  place(cells, i) {
    return (RINGS + cells[2 * i]) * this.width + RINGS + cells[2 * i + 1];
  }

  /** Let the i-th of some cells into an archive, if it is full in place of the oldest. */
  replaceOldest(archive, cells, i, score) {
    this.#exchange(archive, archive.oldestPlace, cells, i);
    archive.put(archive.oldestPlace, cells, i, score);
  }

  /** The same in place of the lowest score. */
  replaceLowest(archive, cells, i, score) {
    this.#exchange(archive, archive.nextPlace, cells, i);
    archive.enter(cells, i, score);
  }

  #exchange(archive, place, cells, i) {
    if (place < archive.size) this.counts[this.place(archive.points, place)]--;
    this.counts[this.place(cells, i)]++;
  }

  /** The summed distances from a place to the `wanted` nearest other points; -1 if not all are within the rings. */
  sumOverRings(place, wanted) {
    const { counts, width } = this;
    let found = counts[place] - 1; // without the point itself
    let total = 0;
    for (let radius = 1; radius <= RINGS && found < wanted; radius++) {
      let top = place - radius * width, right = place + radius, bottom = place + radius * width, left = place - radius;
      let onRing = 0;
      for (let step = 0; step < radius; step++) { // along the four sides of the ring at once
        onRing += counts[top] + counts[right] + counts[bottom] + counts[left];
        top += width + 1;
        right += width - 1;
        bottom -= width + 1;
        left -= width - 1;
      }
      total += radius * Math.min(onRing, wanted - found);
      found += onRing;
    }
    return found >= wanted ? total : -1;
  }
}

/** Score cells by taxicab distance, in order. By the paper's rule each is offered to the archive, by others none is.
 *
 * `occupancy` counts the archive's points. */
export function scoreCells(cells, archive, occupancy, k, admission, scores) {
  const n = scores.length, { counts } = occupancy;
  const scoreOf = (points, i) => {
    const wanted = Math.min(k, n - 1 + archive.size);
    const total = occupancy.sumOverRings(occupancy.place(points, i), wanted);
    return (total >= 0 ? total : sumOverAll(points, i, cells, n, archive, wanted)) / k;
  };
  for (let i = 0; i < n; i++) counts[occupancy.place(cells, i)]++;
  for (let i = 0; i < n; i++) {
    scores[i] = scoreOf(cells, i);
    if (admission === "lowest replaced" && scores[i] > archive.threshold) {
      occupancy.replaceLowest(archive, cells, i, scores[i]);
    }
  }
  if (admission === "rescored") archive.rescore((place) => scoreOf(archive.points, place));
  for (let i = 0; i < n; i++) counts[occupancy.place(cells, i)]--;
}

/** Admit so many cells, drawn with replacement, to the archive. */
export function admitDrawn(cells, archive, occupancy, admitted, rng, scores) {
  if (archive.capacity === 0) return;
  for (let draw = 0; draw < admitted; draw++) {
    const i = Math.floor(rng.random() * scores.length);
    occupancy.replaceOldest(archive, cells, i, scores[i]);
  }
}

/** Admit all cells above a threshold to the archive, and adapt it.
 *
 * threshold: { value, idle }; idle are the evaluations since the last entry or fall. */
export function admitAbove(cells, archive, occupancy, threshold, scores) {
  if (archive.capacity === 0) return;
  let entered = 0;
  for (let i = 0; i < scores.length; i++) {
    if (scores[i] > threshold.value) {
      occupancy.replaceOldest(archive, cells, i, scores[i]);
      entered++;
    }
  }
  threshold.idle = entered > 0 ? 0 : threshold.idle + scores.length;
  if (entered > MOST_ENTRIES) threshold.value *= RISE;
  else if (threshold.idle >= MOST_IDLE) {
    threshold.value *= FALL;
    threshold.idle = 0;
  }
}

/** Offer cells to the archive, after all are scored; with `areDistinct`, none that it holds already. */
export function admitAfterScoring(cells, archive, occupancy, areDistinct, scores) {
  for (let i = 0; i < scores.length; i++) {
    const isHeld = areDistinct && occupancy.counts[occupancy.place(cells, i)] > 0;
    if (scores[i] > archive.threshold && !isHeld) occupancy.replaceLowest(archive, cells, i, scores[i]);
  }
}

/** The same sum as of `sumOverRings`, for the i-th of some points: how many others are at each distance? */
function sumOverAll(points, i, cells, n, archive, wanted) {
  const atDistance = [-1]; // without the point itself
  const count = (others, size) => {
    for (let j = 0; j < size; j++) {
      const distance = Math.abs(others[2 * j] - points[2 * i]) + Math.abs(others[2 * j + 1] - points[2 * i + 1]);
      atDistance[distance] = (atDistance[distance] ?? 0) + 1;
    }
  };
  count(cells, n);
  count(archive.points, archive.size);
  let found = 0, total = 0;
  for (let distance = 0; found < wanted; distance++) {
    const taken = Math.min(atDistance[distance] ?? 0, wanted - found);
    total += distance * taken;
    found += taken;
  }
  return total;
}

/** Score the first `count` points of a generation, in order, offering each to the archive. */
export function scorePoints(points, archive, k, taxicab, scores, count = scores.length) {
  const n = scores.length, { dimensions } = archive;
  // population and archive, axis by axis; points on a line get a second coordinate
  const most = n + Math.min(archive.capacity, archive.size + n);
  const axes = Array.from({ length: Math.max(dimensions, 2) }, () => new Float64Array(most));
  for (let axis = 0; axis < dimensions; axis++) {
    for (let j = 0; j < n; j++) axes[axis][j] = points[j * dimensions + axis];
    for (let j = 0; j < archive.size; j++) axes[axis][n + j] = archive.points[j * dimensions + axis];
  }
  const nearest = new Float64Array(Math.min(k + 1, most));
  const grid = n > 0 ? new Grid(axes, n, n + archive.size) : null;
  for (let i = 0; i < count; i++) {
    // the point finds itself, too, at a distance of 0, which adds nothing to the sum
    const wanted = Math.min(k, n - 1 + archive.size) + 1;
    grid.nearestDistances(i, wanted, taxicab, nearest);
    let total = 0;
    for (let j = 0; j < wanted; j++) total += taxicab ? nearest[j] : Math.sqrt(nearest[j]);
    scores[i] = total / k;
    if (scores[i] > archive.threshold) {
      const place = n + archive.nextPlace;
      if (archive.nextPlace < archive.size) grid.remove(place);
      for (let axis = 0; axis < dimensions; axis++) axes[axis][place] = points[i * dimensions + axis];
      grid.add(place);
      archive.enter(points, i, scores[i]);
    }
  }
}

/** The k nearest neighbours that the i-th of n points had when it was scored, the nearest first.
 *
 * archive: as it was before the generation, to which so many points had been offered by then.
 * Returns { point, distance, from }; `from` is "population" or "archive". */
export function neighboursOf(points, n, i, archive, offered, k, taxicab) {
  const met = new Archive(archive.capacity, archive.dimensions);
  met.copyFrom(archive);
  scorePoints(points, met, k, taxicab, new Float64Array(n), offered);
  const point = rowOf(points, i, archive.dimensions);
  const neighbours = [];
  const measure = (others, size, from, isItself) => {
    for (let j = 0; j < size; j++) {
      if (isItself(j)) continue;
      const other = rowOf(others, j, archive.dimensions);
      const differences = other.map((value, axis) => Math.abs(value - point[axis]));
      const distance = taxicab ? differences.reduce((a, b) => a + b) : Math.hypot(...differences);
      neighbours.push({ point: other, distance, from });
    }
  };
  measure(points, n, "population", (j) => j === i);
  measure(met.points, met.size, "archive", () => false);
  return neighbours.sort((a, b) => a.distance - b.distance).slice(0, k);
}
