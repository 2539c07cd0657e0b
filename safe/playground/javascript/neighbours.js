// The nearest neighbours of points, found in a grid (see safe/neighbours.py).

const PER_CELL = 4; // points in a cell, on average
const SLACK = 1.35; // a first search expects this many times the neighbours wanted, so that it rarely finds too few
const NEARLY_NOTHING = 1e-150; // an extent below which points count as one

/** Members, known by their numbers, in the cells of a grid over their first two coordinates. */
export class Grid {
  /** axes: of each coordinate, those of all members, at least two. The grid covers the first n of them; members outside
   * belong to the outermost cells. The first `size` are in it at once. */
  constructor(axes, n, size) {
    const cells = 1 + Math.floor(Math.sqrt(size / PER_CELL)); // in a row or column
    this.axes = axes;
    this.rows = new Intervals(axes[0].subarray(0, n), cells);
    this.columns = new Intervals(axes[1].subarray(0, n), cells);
    this.heads = new Int32Array(this.rows.count * this.columns.count).fill(-1); // the first member of each cell
    this.next = new Int32Array(axes[0].length); // behind each member in its cell, or -1
    for (let j = 0; j < size; j++) this.add(j);
    this.share = 1 / size;
  }

  #cellOf(j) {
    return this.rows.at(this.axes[0][j]) * this.columns.count + this.columns.at(this.axes[1][j]);
  }

  add(j) {
    const cell = this.#cellOf(j);
    this.next[j] = this.heads[cell];
    this.heads[cell] = j;
  }

  remove(j) {
    const { heads, next } = this, cell = this.#cellOf(j);
    let before = -1;
    for (let other = heads[cell]; other !== j; other = next[other]) before = other;
    if (before < 0) heads[cell] = next[j];
    else next[before] = next[j];
  }

  /** The distance within which so many members, and some more, would lie if all were spread evenly. */
  #evenReach(wanted) {
    const { length: height } = this.rows, { length: width } = this.columns, share = SLACK * wanted * this.share;
    // in the plane the area of a circle; on a line its length
    return Math.max(Math.sqrt(share * height * width / Math.PI), share * Math.max(height, width) / 2);
  }

  /** Put the `wanted` smallest distances between the i-th and all members, in order, into `nearest`.
   *
   * Euclidean distances stay squared: the order is the same. */
  nearestDistances(i, wanted, taxicab, nearest) {
    const { axes, rows, columns, heads, next } = this;
    const xs = axes[0], ys = axes[1], x = xs[i], y = ys[i], dimensions = axes.length, width = columns.count;
    const last = wanted - 1;
    for (let reach = this.#evenReach(wanted);;) {
      const margin = reach * (1 + 1e-9); // the borders of cells are rounded, and no cell may be missed
      const top = rows.at(x - margin), bottom = rows.at(x + margin);
      const left = columns.at(y - margin), right = columns.at(y + margin);
      const isAll = (bottom - top + 1) * (right - left + 1) === heads.length;
      let farthest = isAll ? Infinity : taxicab ? reach : reach * reach; // that is still of interest
      let found = 0;
      for (let row = top; row <= bottom; row++) {
        for (let cell = row * width + left; cell <= row * width + right; cell++) {
          for (let j = heads[cell]; j >= 0; j = next[j]) {
            const dx = xs[j] - x, dy = ys[j] - y;
            let distance = taxicab ? Math.abs(dx) + Math.abs(dy) : dx * dx + dy * dy;
            for (let axis = 2; axis < dimensions; axis++) {
              const difference = axes[axis][j] - axes[axis][i];
              distance += taxicab ? Math.abs(difference) : difference * difference;
            }
            if (distance > farthest) continue;
            let place = found < last ? found : last;
            for (; place > 0 && nearest[place - 1] > distance; place--) nearest[place] = nearest[place - 1];
            nearest[place] = distance;
            found++;
            if (found >= wanted) farthest = nearest[last];
          }
        }
      }
      if (isAll || found >= wanted) return;
      reach *= Math.max(1.25, Math.sqrt(wanted / (found + 1)));
    }
  }
}

/** One axis of a grid: equal intervals over the range of some values. */
class Intervals {
  constructor(values, count) {
    let low = Infinity, high = -Infinity;
    for (const value of values) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    const isExtended = high - low > NEARLY_NOTHING;
    this.low = low;
    this.length = isExtended ? high - low : 0;
    this.count = isExtended ? count : 1;
    this.scale = isExtended ? count / this.length : 0;
  }

  /** The number of the interval that holds a value, or that is nearest to it. */
  at(value) {
    return Math.floor(Math.min(Math.max((value - this.low) * this.scale, 0), this.count - 1));
  }
}
