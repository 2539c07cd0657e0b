// What the editor says of a draft: whether it is a maze, and how far and how deceptive the way to its goal is.

import { make } from "./dom.js";
import { distanceBetween, waysToGoal } from "./maze.js";
import { percentage } from "./text.js";

/** Lines on a maze, as [kind, text] pairs; for the kinds see playground.css. */
export function describeMaze(maze) {
  const { width, start, goal } = maze;
  const ways = waysToGoal(maze);
  const way = ways[start[0] * width + start[1]], distance = distanceBetween(start, goal);
  return [
    ["good", "The goal can be reached."],
    [
      "plain",
      `From the start it is ${distance} cells away in rows and columns, and ${way} on the shortest way: ` +
      `${(way / distance).toFixed(1)} times as far.`,
    ],
    [
      "plain",
      `How deceptive: in ${percentage(misleadingShare(maze, ways), 0)} % of the cells that lead to the goal, every ` +
      "shortest way begins with a step away from the goal.",
    ],
  ];
}

/** Lines on a draft that is not a maze, likewise. */
export function describeError(error) {
  return [
    ["bad", `Not a maze yet: ${error.message}.`],
    ["plain", "The other views keep to the last one that was a maze."],
  ];
}

/** A list of such lines. */
export function makeLines(lines) {
  return lines.map(([kind, text]) => make("li", { class: kind }, text));
}

/** The share of cells, among those that lead to the goal, in which closeness to it misleads. */
function misleadingShare(maze, ways) {
  const cells = [...ways.keys()].filter((cell) => ways[cell] > 0);
  return cells.filter((cell) => misleads(maze, ways, cell)).length / cells.length;
}

/** Does every shortest way from a cell to the goal begin with a step that increases the distance to it? */
function misleads({ height, width, goal }, ways, cell) {
  const row = Math.floor(cell / width), column = cell % width;
  const beside = [[row, column - 1], [row, column + 1], [row - 1, column], [row + 1, column]];
  const isInside = ([r, c]) => r >= 0 && r < height && c >= 0 && c < width;
  const isOnTheWay = ([r, c]) => ways[r * width + c] === ways[cell] - 1;
  const isNearer = (other) => distanceBetween(other, goal) < distanceBetween([row, column], goal);
  return !beside.some((other) => isInside(other) && isOnTheWay(other) && isNearer(other));
}
