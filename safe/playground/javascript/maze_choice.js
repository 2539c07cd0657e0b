// The choice among the mazes that the playground brings along, and the reader's own.

import { makeSelect } from "./dom.js";
import { isNamed, MAZES, namedMaze } from "./named_mazes.js";

const DRAWN = "drawn"; // stands for a maze that is not one of MAZES

export function makeMazeChoice(store) {
  const options = [...Object.keys(MAZES).map((name) => [name, name]), [DRAWN, "one of your own"]];
  const choice = makeSelect(options, (name) => {
    if (name !== DRAWN) return store.set({ maze: namedMaze(name), generation: 0 });
    store.set({ view: "draw" });
    show(); // the maze stays until another is drawn
  });
  const show = () => (choice.value = isNamed(store.state.maze) ? store.state.maze.name : DRAWN);
  store.listen((names) => names.includes("maze") && show());
  show();
  return choice;
}
