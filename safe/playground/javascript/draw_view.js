// Draw: a maze of the reader's own.

import { labelled, make, makeBlock, makeButton, makeControls, makeRadios } from "./dom.js";
import { makeMaze } from "./maze.js";
import { describeError, describeMaze, makeLines } from "./maze_checks.js";
import { MazeEditor } from "./maze_editor.js";
import { makeEmptyMazeForm, makeLoadFields, makeSaveButtons, makeTextArea } from "./maze_forms.js";
import { recognised } from "./named_mazes.js";

const TOOLS = [
  ["wall", "Wall"],
  ["open", "Erase"],
  ["start", "Start"],
  ["goal", "Goal"],
];

export class DrawView {
  constructor({ store, problem }) {
    this.store = store;
    this.editor = new MazeEditor(() => this.#adoptDraft());
    this.lastDrawn = null; // the last maze that was drawn here
    this.undoButton = makeButton("Undo", () => this.editor.undo());
    this.redoButton = makeButton("Redo", () => this.editor.redo());
    this.checks = make("ul", { class: "checks" });
    const textArea = makeTextArea();
    const onmaze = (maze) => {
      this.editor.replaceDraft(maze);
      this.editor.adopt();
    };
    this.element = make(
      "div",
      { class: "columns" },
      makeBlock(this.#makeToolBar(), this.editor.element, this.editor.announcement),
      makeBlock(
        make("h2", {}, "This maze"),
        this.checks,
        make("h2", {}, "A new one"),
        makeEmptyMazeForm(problem, onmaze),
        make("h2", {}, "Save"),
        makeSaveButtons(() => this.editor.draft, textArea),
        make("h2", {}, "Load"),
        ...makeLoadFields(problem, textArea, onmaze),
      ),
    );
  }

  #makeToolBar() {
    const { editor } = this;
    const onchange = () => (editor.brush = Math.min(9, Math.max(1, brush.valueAsNumber || 1)));
    const brush = make("input", { type: "number", min: 1, max: 9, value: editor.brush, onchange });
    return makeControls(
      makeRadios("Tool", TOOLS, editor.tool, (tool) => (editor.tool = tool)),
      labelled("Brush, in cells", brush),
      this.undoButton,
      this.redoButton,
    );
  }

  show(names) {
    const { maze, view } = this.store.state;
    if (names.includes("maze") && maze !== this.lastDrawn) this.isStale = true;
    if (view !== "draw") return;
    if (this.isStale) {
      this.isStale = false;
      this.editor.replaceDraft(maze);
      this.#checkDraft();
      this.editor.draw();
    } else if (names.includes("view")) this.editor.draw();
  }

  pause() {
    this.editor.finishStroke();
  }

  destroy() {
    this.editor.destroy();
  }

  /** If the draft is a maze, all views go on with it. */
  #adoptDraft() {
    if (this.#checkDraft()) this.store.set({ maze: this.lastDrawn, generation: 0 });
  }

  /** Say what there is to say of the draft. Is it a maze? */
  #checkDraft() {
    const { draft: { walls, height, width, start, goal }, history } = this.editor;
    this.undoButton.disabled = history.past.length === 0;
    this.redoButton.disabled = history.future.length === 0;
    try {
      this.lastDrawn = recognised(makeMaze(walls, height, width, start, goal, "drawn"));
    } catch (error) {
      this.checks.replaceChildren(...makeLines(describeError(error)));
      return false;
    }
    this.checks.replaceChildren(...makeLines(describeMaze(this.lastDrawn)));
    return true;
  }
}
