// Draw: a maze of one's own, with mouse, touch or keyboard.

import { known } from "./address.js";
import { checkedInteger } from "./checks.js";
import { download, labelled, make, makeButton, makeRadios } from "./dom.js";
import { distanceBetween, drawingOf, listOf, LONGEST_SIDE, makeMaze, parseMaze, waysToGoal } from "./maze.js";
import { MazeView } from "./mazeview.js";

const TOOLS = [
  ["wall", "Wall"],
  ["open", "Erase"],
  ["start", "Start"],
  ["goal", "Goal"],
];
const REMEMBERED = 200; // strokes that can be undone
const MOVES = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

export class DrawView {
  constructor(store, { complain }) {
    this.store = store;
    this.complain = complain;
    this.tool = "wall";
    this.brush = 1;
    this.cursor = null;
    this.pointer = null; // which draws
    this.last = null; // the cell that the stroke has come to
    this.past = [];
    this.future = [];
    this.draft = null; // { height, width, walls, start, goal }, which need not be a maze yet
    this.view = new MazeView({
      class: "editor",
      role: "application",
      tabindex: 0,
      "aria-label": "Maze editor: arrow keys move, with Shift by ten cells; space or Enter uses the tool",
    });
    const { canvas } = this.view;
    canvas.addEventListener("pointerdown", (event) => this.#press(event));
    canvas.addEventListener(
      "pointermove",
      (event) => event.pointerId === this.pointer && this.#drag(this.view.cellAt(event)),
    );
    for (const end of ["pointerup", "pointercancel"]) {
      canvas.addEventListener(end, (event) => event.pointerId === this.pointer && this.#finish());
    }
    canvas.addEventListener("keydown", (event) => this.#key(event));
    canvas.addEventListener("blur", () => this.#moveCursor(null));
    this.undoButton = makeButton("Undo", () => this.#undo(this.past, this.future));
    this.redoButton = makeButton("Redo", () => this.#undo(this.future, this.past));
    this.checks = make("ul", { class: "checks" });
    this.said = make("p", { class: "note", role: "status" });
    this.text = make("textarea", { rows: 6, spellcheck: "false", placeholder: "#####\n#S.G#\n#####" });
    const file = make("input", { type: "file", accept: ".maze,.txt,text/plain" });
    file.addEventListener("change", async () => {
      if (file.files.length === 1) {
        this.#import(await file.files[0].text());
      }
      file.value = "";
    });
    const rows = make("input", { type: "number", min: 2, max: LONGEST_SIDE, value: 40 });
    const columns = make("input", { type: "number", min: 2, max: LONGEST_SIDE, value: 40 });
    const brush = make("input", { type: "number", min: 1, max: 9, value: 1 });
    brush.addEventListener("change", () => (this.brush = Math.min(9, Math.max(1, brush.valueAsNumber || 1))));
    this.element = make(
      "div",
      { class: "columns" },
      make(
        "div",
        {},
        make(
          "div",
          { class: "controls" },
          makeRadios("Tool", TOOLS, this.tool, (tool) => (this.tool = tool)),
          labelled("Brush, in cells", brush),
          this.undoButton,
          this.redoButton,
        ),
        this.view.element,
        this.said,
      ),
      make(
        "div",
        {},
        make("h2", {}, "This maze"),
        this.checks,
        make("h2", {}, "A new one"),
        make(
          "div",
          { class: "controls" },
          labelled("Rows", rows),
          labelled("Columns", columns),
          makeButton("Empty maze", () => this.complain(() => this.#empty(rows.valueAsNumber, columns.valueAsNumber))),
        ),
        make("h2", {}, "Save"),
        make(
          "div",
          { class: "controls" },
          makeButton("Save as drawing", () => this.#save("txt", drawingOf)),
          makeButton("Save as maze file", () => this.#save("maze", listOf)),
          makeButton("Show as drawing below", () => (this.text.value = drawingOf(this.draft))),
        ),
        make("h2", {}, "Load"),
        labelled("A file", file, { class: "field wide" }),
        labelled("or its text", this.text, { class: "field wide" }),
        makeButton("Load this text", () => this.#import(this.text.value)),
      ),
    );
  }

  show(names) {
    const { maze, view } = this.store.state;
    if (names.includes("maze") && maze !== this.own) {
      if (this.draft) this.#remember(); // what was drawn can be brought back
      this.draft = copyOf(maze);
      this.#check();
      this.#draw();
    }
    if (view === "draw" && names.includes("view")) this.#draw();
  }

  pause() {
    this.#finish();
  }

  destroy() {
    this.view.destroy();
  }

  #remember() {
    this.past.push(copyOf(this.draft));
    if (this.past.length > REMEMBERED) this.past.shift();
    this.future = [];
  }

  #undo(from, to) {
    if (from.length === 0 || this.last) return;
    to.push(this.draft);
    this.draft = from.pop();
    this.#adopt();
  }

  /** The draft may have changed: check it, and where it is a maze let all others know. */
  #adopt() {
    if (this.past.length > 0 && drawingOf(this.past.at(-1)) === drawingOf(this.draft)) {
      this.past.pop();
      return;
    }
    const isMaze = this.#check();
    if (isMaze) this.store.set({ maze: this.own, generation: 0 });
    this.#draw();
  }

  /** Tell what there is to tell of the draft. Is it a maze? */
  #check() {
    const { height, width, walls, start, goal } = this.draft;
    const tell = (...lines) =>
      this.checks.replaceChildren(...lines.map(([kind, text]) => make("li", { class: kind }, text)));
    this.undoButton.disabled = this.past.length === 0;
    this.redoButton.disabled = this.future.length === 0;
    try {
      this.own = known(makeMaze(walls, height, width, start, goal, "drawn"));
    } catch (error) {
      tell(
        ["bad", `Not a maze yet: ${error.message}.`],
        ["plain", "The other views keep to the last one that was a maze."],
      );
      return false;
    }
    const ways = waysToGoal(this.own);
    const way = ways[start[0] * width + start[1]],
      distance = distanceBetween(start, goal);
    tell(
      ["good", "The goal can be reached."],
      [
        "plain",
        `From the start it is ${distance} cells away in rows and columns, and ${way} on the shortest way: ` +
          `${(way / distance).toFixed(1)} times as far.`,
      ],
      ["plain", deception(this.own, ways)],
    );
    return true;
  }

  #draw() {
    this.view.show({ maze: this.draft, cursor: this.cursor });
  }

  #press(event) {
    if (event.button !== 0 || this.last) return;
    event.preventDefault();
    this.view.canvas.focus();
    this.view.canvas.setPointerCapture(event.pointerId);
    this.cursor = null;
    this.#remember();
    this.pointer = event.pointerId;
    this.last = this.view.cellAt(event);
    this.#apply(this.last);
    this.#draw();
  }

  #drag(cell) {
    const { row, column } = this.last;
    const steps = Math.max(Math.abs(cell.row - row), Math.abs(cell.column - column));
    for (let i = 1; i <= steps; i++) {
      this.#apply({
        row: Math.round(row + ((cell.row - row) * i) / steps),
        column: Math.round(column + ((cell.column - column) * i) / steps),
      });
    }
    this.last = cell;
    this.#draw();
  }

  #finish() {
    if (!this.last) return;
    this.last = this.pointer = null;
    this.#adopt();
  }

  /** Use the tool on a cell. */
  #apply({ row, column }) {
    const { height, width, walls, start, goal } = this.draft;
    const isEnd = (r, c) => [start, goal].some((end) => end[0] === r && end[1] === c);
    if (this.tool === "start" || this.tool === "goal") {
      if (isEnd(row, column) || row < 0 || row >= height || column < 0 || column >= width) return;
      walls[row * width + column] = 0;
      this.draft[this.tool] = [row, column];
    } else {
      const first = Math.floor((this.brush - 1) / 2);
      for (let r = row - first; r < row - first + this.brush; r++) {
        for (let c = column - first; c < column - first + this.brush; c++) {
          const isInside = r >= 0 && r < height && c >= 0 && c < width;
          if (isInside && !isEnd(r, c)) walls[r * width + c] = this.tool === "wall" ? 1 : 0;
        }
      }
    }
  }

  #key(event) {
    const { height, width } = this.draft;
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z") {
      event.preventDefault();
      if (event.shiftKey) this.#undo(this.future, this.past);
      else this.#undo(this.past, this.future);
      return;
    }
    const [row, column] = this.cursor ?? this.draft.start;
    if (Object.hasOwn(MOVES, event.key)) {
      const [down, right] = MOVES[event.key].map((step) => step * (event.shiftKey ? 10 : 1));
      this.#moveCursor([
        Math.min(Math.max(row + down, 0), height - 1),
        Math.min(Math.max(column + right, 0), width - 1),
      ]);
    } else if (event.key === " " || event.key === "Enter") {
      this.#remember();
      this.#apply({ row, column });
      this.#adopt();
      this.#moveCursor([row, column]);
    } else return;
    event.preventDefault();
    this.said.textContent = `Row ${this.cursor[0]}, column ${this.cursor[1]}: ${this.#nameOf(this.cursor)}.`;
  }

  /** What is in a cell. */
  #nameOf([row, column]) {
    const { walls, width, start, goal } = this.draft;
    const isAt = (end) => end[0] === row && end[1] === column;
    return isAt(start) ? "start" : isAt(goal) ? "goal" : walls[row * width + column] ? "wall" : "open";
  }

  #moveCursor(cursor) {
    this.cursor = cursor;
    if (this.draft) this.#draw();
  }

  #import(text) {
    this.complain(() => this.#replace(parseMaze(text)));
  }

  #empty(height, width) {
    checkedInteger("rows", height, 2, LONGEST_SIDE);
    checkedInteger("columns", width, 2, LONGEST_SIDE);
    this.#replace(makeMaze(new Uint8Array(height * width), height, width, [0, 0], [height - 1, width - 1]));
  }

  /** Go on with another maze; what was drawn before can be brought back. */
  #replace(maze) {
    this.#remember();
    this.draft = copyOf(maze);
    this.#adopt();
  }

  #save(ending, write) {
    download(`maze.${ending}`, write(this.draft));
  }
}

/** The same maze, to be changed. */
function copyOf({ height, width, walls, start, goal }) {
  return { height, width, walls: walls.slice(), start: [...start], goal: [...goal] };
}

/** In how many cells closeness to the goal misleads, in words. */
function deception({ walls, height, width, goal }, ways) {
  let reachable = 0,
    misled = 0;
  for (let cell = 0; cell < ways.length; cell++) {
    if (ways[cell] <= 0) continue;
    reachable++;
    const column = cell % width,
      row = Math.floor(cell / width);
    const beside = [
      [row, column - 1],
      [row, column + 1],
      [row - 1, column],
      [row + 1, column],
    ];
    const isNearer = ([r, c]) => distanceBetween([r, c], goal) < distanceBetween([row, column], goal);
    const isOnTheWay = ([r, c]) =>
      r >= 0 && r < height && c >= 0 && c < width && !walls[r * width + c] && ways[r * width + c] < ways[cell];
    if (!beside.some((next) => isOnTheWay(next) && isNearer(next))) misled++;
  }
  const percent = ((100 * misled) / reachable).toFixed(0);
  return (
    `How deceptive: in ${percent} % of the cells that lead to the goal, every shortest way begins with a step away from ` +
    "the goal."
  );
}
