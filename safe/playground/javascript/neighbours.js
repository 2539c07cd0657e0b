// The nearest neighbours of points, found in a grid (see safe/neighbours.py).

const PER_CELL = 3; // points in a cell, on average
const ASPECT = 2; // of a cell, its height to its width: a search begins few rows
const SLACK = 1.35; // a first search expects this many times the neighbours wanted, so that it rarely finds too few
const NEARLY_NOTHING = 1e-150; // an extent below which points count as one

/** Members, known by their numbers, in the cells of a grid over their first two coordinates. */
export class Grid {
  /** axes: of each coordinate, those of all members, at least two. The grid covers the first n of them; members outside
   * belong to the outermost cells. The first `size` are in it at once. */
  constructor(axes, n, size) {
    const most = axes[0].length;
    this.axes = axes;
    this.rows = new Intervals(axes[0].subarray(0, n), 1 + Math.floor(Math.sqrt(size / PER_CELL / ASPECT)));
    this.columns = new Intervals(axes[1].subarray(0, n), 1 + Math.floor(Math.sqrt(size / PER_CELL * ASPECT)));
    this.mostNewcomers = 1 + Math.floor(Math.sqrt(most));
    this.sorted = axes.map(() => new Float64Array(most + this.mostNewcomers)); // cell by cell, then newcomers
    this.ends = new Int32Array(this.rows.count * this.columns.count + 2); // a 0, then the end of each cell in `sorted`
    this.cells = new Int32Array(most);
    this.places = new Int32Array(most); // of each member in `sorted`
    this.share = 1 / size;
    this.#sort(size);
  }

  #sort(size) {
    const { axes, rows, columns, sorted, ends, cells, places } = this;
    ends.fill(0);
    for (let j = 0; j < size; j++) {
      cells[j] = rows.at(axes[0][j]) * columns.count + columns.at(axes[1][j]);
      ends[cells[j] + 2]++;
    }
    for (let cell = 2; cell < ends.length; cell++) ends[cell] += ends[cell - 1];
    for (let j = 0; j < size; j++) places[j] = ends[cells[j] + 1]++;
    for (let axis = 0; axis < axes.length; axis++) {
      for (let j = 0; j < size; j++) sorted[axis][places[j]] = axes[axis][j];
    }
    this.size = size; // with newcomers
    this.inCells = size;
    this.highest = size; // above all members' numbers
  }

  add(j) {
    this.highest = Math.max(this.highest, j + 1);
    for (let axis = 0; axis < this.axes.length; axis++) this.sorted[axis][this.size] = this.axes[axis][j];
    this.places[j] = this.size++;
    if (this.size - this.inCells === this.mostNewcomers) this.#sort(this.highest);
  }

  /** Remove a member, whose number the next that is added gets. */
  remove(j) {
    this.sorted[0][this.places[j]] = NaN; // near to nothing
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
    const { axes, sorted, rows, columns, ends } = this;
    const xs = sorted[0], ys = sorted[1], x = axes[0][i], y = axes[1][i];
    const dimensions = axes.length, width = columns.count, last = wanted - 1;
    for (let reach = this.#evenReach(wanted);;) {
      const margin = reach * (1 + 1e-9); // the borders of cells are rounded, and no cell may be missed
      const top = rows.at(x - margin), bottom = rows.at(x + margin);
      const left = columns.at(y - margin), right = columns.at(y + margin);
      const isAll = (bottom - top + 1) * (right - left + 1) === rows.count * width;
      let farthest = isAll ? Infinity : taxicab ? reach : reach * reach; // that is still of interest
      let found = 0;
      for (let row = top - 1; row <= bottom; row++) { // first the newcomers, then row by row
        const start = row < top ? this.inCells : ends[row * width + left];
        const end = row < top ? this.size : ends[row * width + right + 1];
        for (let j = start; j < end; j++) {
          const dx = xs[j] - x, dy = ys[j] - y;
          let distance = taxicab ? Math.abs(dx) + Math.abs(dy) : dx * dx + dy * dy;
          for (let axis = 2; axis < dimensions; axis++) {
            const difference = sorted[axis][j] - axes[axis][i];
            distance += taxicab ? Math.abs(difference) : difference * difference;
          }
          if (!(distance <= farthest)) continue; // also if it is NaN
          let place = found < last ? found : last;
          for (; place > 0 && nearest[place - 1] > distance; place--) nearest[place] = nearest[place - 1];
          nearest[place] = distance;
          found++;
          if (found >= wanted) farthest = nearest[last];
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
