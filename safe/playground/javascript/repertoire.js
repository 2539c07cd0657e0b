// The repertoire: of every cell where any robot has ended so far, the latest that did (see safe/repertoire.py).

import { distanceTo } from "./judges.js";

export class Repertoire {
  /** weights: of a controller. */
  constructor({ height, width }, weights) {
    this.height = height;
    this.width = width;
    this.weights = weights;
    this.slots = new Int32Array(height * width).fill(-1); // by the number of a cell
    this.size = 0;
    // by slot, in the order in which cells were reached; they grow as need be
    this.genomes = new Float64Array(64 * weights);
    this.cells = new Float64Array(64 * 2); // row and column
  }

  /** Take a generation in, solution by solution. */
  update(genomes, endpoints) {
    const { weights } = this;
    for (let i = 0; 2 * i < endpoints.length; i++) {
      const cell = endpoints[2 * i] * this.width + endpoints[2 * i + 1];
      if (this.slots[cell] < 0) this.#open(cell, endpoints.subarray(2 * i, 2 * i + 2));
      this.genomes.set(genomes.subarray(i * weights, (i + 1) * weights), this.slots[cell] * weights);
    }
  }

  #open(cell, position) {
    if (2 * this.size === this.cells.length) {
      this.genomes = doubled(this.genomes);
      this.cells = doubled(this.cells);
    }
    this.cells.set(position, 2 * this.size);
    this.slots[cell] = this.size++;
  }

  /** The slot of the cell nearest to a place, the first reached of equals. */
  nearestTo(place) {
    // rings of cells around the place, as long as they hold fewer cells than the repertoire
    for (let radius = 0; 2 * radius * radius < this.size; radius++) {
      const slot = this.#firstOnRing(place, radius);
      if (slot < this.size) return slot;
    }
    let nearest = 0, least = Infinity;
    for (let slot = 0; slot < this.size; slot++) {
      const distance = distanceTo(place, this.cells, slot);
      if (distance < least) {
        nearest = slot;
        least = distance;
      }
    }
    return nearest;
  }

  /** The first slot of the cells at a distance from a place; the size if there is none. */
  #firstOnRing({ row, column }, radius) {
    let first = this.size;
    const look = (r, c) => {
      if (r < 0 || r >= this.height || c < 0 || c >= this.width) return;
      const slot = this.slots[r * this.width + c];
      if (slot >= 0 && slot < first) first = slot;
    };
    for (let across = -radius; across <= radius; across++) {
      const along = radius - Math.abs(across);
      look(row + across, column - along);
      look(row + across, column + along);
    }
    return first;
  }
}

function doubled(values) {
  const larger = new Float64Array(2 * values.length);
  larger.set(values);
  return larger;
}
