// A maze on a canvas, and what goes on in it.

import { make } from "./dom.js";
import { MazePainter } from "./maze_painter.js";

const LARGEST_SIDE = 4096; // pixels of a canvas; with many more, browsers show none
const TALLEST = 85; // % of the window's height

/** A picture of a maze, painted again whenever what it shows, its size or the theme changes. */
export class MazeView {
  /** attributes: of the canvas. onpick: called with { row, column } of the cell that is clicked. */
  constructor(attributes, onpick = null) {
    this.canvas = make("canvas", { role: "img", ...attributes });
    this.element = make("div", { class: "maze" }, this.canvas);
    this.scene = null;
    this.frame = null;
    this.sizes = new ResizeObserver(() => this.#paintSoon());
    this.sizes.observe(this.canvas);
    this.themes = new MutationObserver(() => this.#paintSoon());
    for (const node of [document.documentElement, document.body]) this.themes.observe(node, { attributes: true });
    if (onpick) this.canvas.addEventListener("click", (event) => onpick(this.cellAt(event)));
  }

  destroy() {
    cancelAnimationFrame(this.frame);
    this.sizes.disconnect();
    this.themes.disconnect();
  }

  /** scene: see MazePainter. */
  show(scene) {
    this.scene = scene;
    const { height, width } = scene.maze;
    this.canvas.style.aspectRatio = `${width} / ${height}`;
    this.canvas.style.maxWidth = `min(100%, ${(TALLEST * width) / height}vh)`;
    this.#paintSoon();
  }

  /** The cell under a pointer, which lies outside the maze if the pointer is outside the canvas. */
  cellAt(event) {
    const box = this.canvas.getBoundingClientRect(), { height, width } = this.scene.maze;
    return {
      row: Math.floor(((event.clientY - box.top) / box.height) * height),
      column: Math.floor(((event.clientX - box.left) / box.width) * width),
    };
  }

  /** Paint with the next frame of the browser, once, however often this is called. */
  #paintSoon() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      if (this.scene && this.canvas.clientWidth > 0) this.#paint();
    });
  }

  #paint() {
    const { height, width } = this.scene.maze;
    const most = LARGEST_SIDE * Math.min(1, width / height);
    const pixels = Math.min(this.canvas.clientWidth * devicePixelRatio, most);
    const scale = pixels / width;
    this.canvas.width = Math.round(pixels);
    this.canvas.height = Math.round(scale * height);
    new MazePainter(this.canvas, scale).paint(this.scene);
  }
}
