// What all parts of a playground share: the state, and who listens to its changes.

export const SETTINGS = ["maze", "algorithms", "seed", "parameters"]; // the parts of a state that make a run

/** state: { view, maze, algorithms, seed, parameters, generation, runs, controller, course, challenge, counted,
 * result }; see state.js. */
export class Store {
  constructor(state) {
    this.state = state;
    this.listeners = [];
  }

  /** Call `listener(names of what changed, source)` after every change. */
  listen(listener) {
    this.listeners.push(listener);
  }

  /** Change parts of the state. `source` tells listeners who changed them: "page", or "outside". */
  set(changes, source = "page") {
    Object.assign(this.state, changes);
    for (const listener of this.listeners) listener(Object.keys(changes), source);
  }
}
