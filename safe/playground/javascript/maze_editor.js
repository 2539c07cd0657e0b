// The canvas on which a maze is drawn, with mouse, touch or keyboard.

import { make } from "./dom.js";
import { applyTool, contentOf, copyOf, DraftHistory } from "./draft.js";
import { MazeView } from "./maze_view.js";

const MOVES = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };
const LONG_MOVE = 10; // cells, with Shift

export class MazeEditor {
  /** onchange: called when the draft has changed, but not in the middle of a stroke. */
  constructor(onchange) {
    this.onchange = onchange;
    this.tool = "wall";
    this.brush = 1; // cells a side
    this.draft = null;
    this.history = new DraftHistory();
    this.cursor = null; // the cell of the keyboard
    this.pointer = null; // the pointer that draws
    this.strokeEnd = null; // the cell that its stroke has come to
    this.announcement = make("p", { class: "note", role: "status" });
    this.view = new MazeView({
      class: "editor",
      role: "application",
      tabindex: 0,
      "aria-label": "Maze editor: arrow keys move, with Shift by ten cells; space or Enter uses the tool",
      onpointerdown: (event) => this.#press(event),
      onpointermove: (event) => event.pointerId === this.pointer && this.#drag(this.view.cellAt(event)),
      onpointerup: (event) => event.pointerId === this.pointer && this.finishStroke(),
      onpointercancel: (event) => event.pointerId === this.pointer && this.finishStroke(),
      onkeydown: (event) => this.#onKey(event),
      onblur: () => this.#moveCursor(null),
    });
    this.element = this.view.element;
  }

  destroy() {
    this.view.destroy();
  }

  draw() {
    this.view.show({ maze: this.draft, cursor: this.cursor });
  }

  /** Go on with another maze; what was drawn before can be brought back. */
  replaceDraft(maze) {
    if (this.draft) this.history.remember(this.draft);
    this.draft = copyOf(maze);
  }

  undo() {
    this.#exchangeDraft("undo");
  }

  redo() {
    this.#exchangeDraft("redo");
  }

  #exchangeDraft(direction) {
    const draft = this.strokeEnd ? null : this.history[direction](this.draft);
    if (draft === null) return;
    this.draft = draft;
    this.adopt();
  }

  /** The draft may have changed: if so, say it. */
  adopt() {
    if (this.history.forgetIfUnchanged(this.draft)) return;
    this.onchange();
    this.draw();
  }

  #press(event) {
    if (event.button !== 0 || this.strokeEnd) return;
    event.preventDefault();
    this.view.canvas.focus();
    this.view.canvas.setPointerCapture(event.pointerId);
    this.cursor = null;
    this.history.remember(this.draft);
    this.pointer = event.pointerId;
    this.strokeEnd = this.view.cellAt(event);
    this.#apply(this.strokeEnd);
    this.draw();
  }

  /** Use the tool on all cells on the way to this one. */
  #drag(cell) {
    const { row, column } = this.strokeEnd;
    const down = cell.row - row, right = cell.column - column;
    const steps = Math.max(Math.abs(down), Math.abs(right));
    for (let i = 1; i <= steps; i++) {
      this.#apply({ row: Math.round(row + (down * i) / steps), column: Math.round(column + (right * i) / steps) });
    }
    this.strokeEnd = cell;
    this.draw();
  }

  finishStroke() {
    if (!this.strokeEnd) return;
    this.strokeEnd = this.pointer = null;
    this.adopt();
  }

  #apply(cell) {
    applyTool(this.draft, this.tool, this.brush, cell);
  }

  #onKey(event) {
    const { height, width, start } = this.draft;
    const [row, column] = this.cursor ?? start;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z") {
      if (event.shiftKey) this.redo();
      else this.undo();
    } else if (Object.hasOwn(MOVES, event.key)) {
      const [down, right] = MOVES[event.key].map((step) => step * (event.shiftKey ? LONG_MOVE : 1));
      this.#moveCursor([
        Math.min(Math.max(row + down, 0), height - 1),
        Math.min(Math.max(column + right, 0), width - 1),
      ]);
      this.#announceCursor();
    } else if (event.key === " " || event.key === "Enter") {
      this.history.remember(this.draft);
      this.#apply({ row, column });
      this.adopt();
      this.#moveCursor([row, column]);
      this.#announceCursor();
    } else return;
    event.preventDefault();
  }

  #moveCursor(cursor) {
    this.cursor = cursor;
    if (this.draft) this.draw();
  }

  #announceCursor() {
    const [row, column] = this.cursor;
    this.announcement.textContent = `Row ${row}, column ${column}: ${contentOf(this.draft, this.cursor)}.`;
  }
}
