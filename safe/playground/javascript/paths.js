// The paths of robots: which cells have been stood on, and how often (see safe/paths.py).

/** How many paths of a run have each cell of a maze. */
export class Visits {
  constructor(maze, population) {
    this.counts = new Int32Array(maze.height * maze.width);
    this.paths = Array(population); // of the generation, the cells of each robot in the order of its path
    this.found = new Int32Array(population); // cells of each path that no path before it has
  }

  /** Count the path of the i-th robot, the cells that are the first so many of a trail. */
  add(i, trail, length) {
    const path = trail.slice(0, length);
    let found = 0;
    for (const cell of path) {
      if (this.counts[cell] === 0) found++;
      this.counts[cell]++;
    }
    this.paths[i] = path;
    this.found[i] = found;
  }

  /** How rare the cells of each path are. */
  rarities(values) {
    for (let i = 0; i < values.length; i++) {
      let sum = 0;
      for (const cell of this.paths[i]) sum += 1 / Math.sqrt(this.counts[cell]);
      values[i] = sum;
    }
  }
}
