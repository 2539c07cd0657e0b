// What one can do with a maze besides drawing it: begin an empty one, save it, and load one.

import { checkedInteger } from "./checks.js";
import { download, labelled, make, makeButton, makeControls } from "./dom.js";
import { drawingOf, LONGEST_SIDE, makeMaze } from "./maze.js";
import { listOf, parseMaze, textOf } from "./maze_files.js";

/** Fields for an empty maze. onmaze: called with it. */
export function makeEmptyMazeForm(problem, onmaze) {
  const [rows, columns] = ["Rows", "Columns"].map(() =>
    make("input", { type: "number", min: 2, max: LONGEST_SIDE, value: 40 })
  );
  const empty = () => onmaze(emptyMaze(rows.valueAsNumber, columns.valueAsNumber));
  return makeControls(
    labelled("Rows", rows),
    labelled("Columns", columns),
    makeButton("Empty maze", () => problem.attempt(empty)),
  );
}

function emptyMaze(height, width) {
  checkedInteger("rows", height, 2, LONGEST_SIDE);
  checkedInteger("columns", width, 2, LONGEST_SIDE);
  return makeMaze(new Uint8Array(height * width), height, width, [0, 0], [height - 1, width - 1]);
}

/** Buttons that save the draft that `getDraft` gives, or put its drawing into a text area. */
export function makeSaveButtons(getDraft, textArea) {
  return makeControls(
    makeButton("Save as drawing", () => download("maze.txt", drawingOf(getDraft()))),
    makeButton("Save as maze file", () => download("maze.maze", listOf(getDraft()))),
    makeButton("Show as drawing below", () => (textArea.value = drawingOf(getDraft()))),
  );
}

export function makeTextArea() {
  return make("textarea", { rows: 6, spellcheck: "false", placeholder: "#####\n#S.G#\n#####" });
}

/** Fields that load a maze from a file, or from a text area. onmaze: called with it. */
export function makeLoadFields(problem, textArea, onmaze) {
  const load = (text) => problem.attempt(() => onmaze(parseMaze(text)));
  const file = make("input", { type: "file", accept: ".maze,.txt,text/plain" });
  file.addEventListener("change", async () => {
    if (file.files.length === 1) load(textOf(new Uint8Array(await file.files[0].arrayBuffer())));
    file.value = "";
  });
  return [
    labelled("A file", file, { class: "field wide" }),
    labelled("or its text", textArea, { class: "field wide" }),
    makeButton("Load this text", () => load(textArea.value)),
  ];
}
