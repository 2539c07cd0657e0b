// A maze that is being drawn: { height, width, walls, start, goal }. It need not be a maze yet, as long as the goal is
// cut off.

import { drawingOf } from "./maze.js";

const MOST_REMEMBERED = 200; // changes that can be undone

/** The cells of a maze, to be changed. */
export function copyOf({ height, width, walls, start, goal }) {
  return { height, width, walls: walls.slice(), start: [...start], goal: [...goal] };
}

/** What is in a cell, in a word. */
export function contentOf({ walls, width, start, goal }, [row, column]) {
  const isAt = (end) => end[0] === row && end[1] === column;
  return isAt(start) ? "start" : isAt(goal) ? "goal" : walls[row * width + column] ? "wall" : "open";
}

/** Apply a tool to a draft: "wall" and "open" to all cells under the brush, "start" and "goal" to this cell alone. */
export function applyTool(draft, tool, brush, { row, column }) {
  const { height, width, walls } = draft;
  const isFree = (r, c) =>
    r >= 0 && r < height && c >= 0 && c < width && !["start", "goal"].includes(contentOf(draft, [r, c]));
  if (tool === "start" || tool === "goal") {
    if (!isFree(row, column)) return;
    walls[row * width + column] = 0;
    draft[tool] = [row, column];
    return;
  }
  const top = row - Math.floor((brush - 1) / 2), left = column - Math.floor((brush - 1) / 2);
  for (let r = top; r < top + brush; r++) {
    for (let c = left; c < left + brush; c++) if (isFree(r, c)) walls[r * width + c] = tool === "wall" ? 1 : 0;
  }
}

/** Drafts as they were before each change, and as they were before each change was undone. */
export class DraftHistory {
  constructor() {
    this.past = [];
    this.future = [];
  }

  /** Keep a draft that is about to change. */
  remember(draft) {
    this.past.push(copyOf(draft));
    if (this.past.length > MOST_REMEMBERED) this.past.shift();
    this.future = [];
  }

  /** Forget what was remembered last, if the draft has not changed since. Has it not? */
  forgetIfUnchanged(draft) {
    const isUnchanged = this.past.length > 0 && drawingOf(this.past.at(-1)) === drawingOf(draft);
    if (isUnchanged) this.past.pop();
    return isUnchanged;
  }

  /** The draft before the last change, or null. */
  undo(draft) {
    return exchange(draft, this.past, this.future);
  }

  /** The draft before the last change was undone, or null. */
  redo(draft) {
    return exchange(draft, this.future, this.past);
  }
}

function exchange(draft, from, to) {
  if (from.length === 0) return null;
  to.push(draft);
  return from.pop();
}
