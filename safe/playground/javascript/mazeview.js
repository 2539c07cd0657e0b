// A maze on a canvas, and what goes on in it.

import { make } from "./dom.js";

// Radii: so many cells, but at least and at most so many pixels.
const DOT = [0.4, 1.6, 6];
const ROBOT = [0.45, 4.5, 10];
const RING = [0.6, 6, 14];
const STAR = [0.85, 10, 24];
const LARGEST_SIDE = 4096; // pixels of a canvas; with many more, browsers show none
const TALLEST = 85; // % of the window's height

/** A picture of a maze. `show` takes what is to be seen, and draws it anew whenever its size or the theme changes. */
export class MazeView {
  /** attributes: of the canvas. onpick: called with { row, column } of the cell that is clicked. */
  constructor(attributes, onpick = null) {
    this.canvas = make("canvas", { role: "img", ...attributes });
    this.element = make("div", { class: "maze" }, this.canvas);
    this.scene = null;
    this.frame = null;
    this.observer = new ResizeObserver(() => this.draw());
    this.observer.observe(this.canvas);
    this.themes = new MutationObserver(() => this.draw());
    for (const node of [document.documentElement, document.body]) this.themes.observe(node, { attributes: true });
    if (onpick) this.canvas.addEventListener("click", (event) => onpick(this.cellAt(event)));
  }

  destroy() {
    cancelAnimationFrame(this.frame);
    this.observer.disconnect();
    this.themes.disconnect();
  }

  /** scene: { maze, archive, ends, colour, trail, paths, robot, rays, links, marked, cursor }, all but maze optional. */
  show(scene) {
    this.scene = scene;
    const { height, width } = scene.maze;
    this.canvas.style.aspectRatio = `${width} / ${height}`;
    this.canvas.style.maxWidth = `min(100%, ${(TALLEST * width) / height}vh)`;
    this.draw();
  }

  /** Draw with the next frame of the browser, however often one asks for it. */
  draw() {
    this.frame ??= requestAnimationFrame(() => {
      this.frame = null;
      this.#paint();
    });
  }

  /** The cell under a pointer; outside the canvas one that the maze does not have. */
  cellAt(event) {
    const box = this.canvas.getBoundingClientRect(), { height, width } = this.scene.maze;
    return {
      row: Math.floor(((event.clientY - box.top) / box.height) * height),
      column: Math.floor(((event.clientX - box.left) / box.width) * width),
    };
  }

  #paint() {
    if (!this.scene || this.canvas.clientWidth === 0) return;
    const { maze, archive, ends, colour, trail, paths = [], robot, rays = [], links = [], marked, cursor } = this.scene;
    const style = getComputedStyle(this.canvas);
    const colourOf = (name) => style.getPropertyValue(`--${name}`);
    const most = LARGEST_SIDE * Math.min(1, maze.width / maze.height);
    const pixels = Math.min(this.canvas.clientWidth * devicePixelRatio, most);
    const scale = pixels / maze.width;
    this.canvas.width = Math.round(pixels);
    this.canvas.height = Math.round(scale * maze.height);
    const context = this.canvas.getContext("2d");
    const [dot, body, ring, star] = [DOT, ROBOT, RING, STAR].map(([cells, least, most]) =>
      Math.min(Math.max(cells * scale, least * devicePixelRatio), most * devicePixelRatio),
    );
    const centre = ([row, column]) => [(column + 0.5) * scale, (row + 0.5) * scale];
    const circle = (cell, radius, filled = true) => {
      context.beginPath();
      context.arc(...centre(cell), radius, 0, 2 * Math.PI);
      if (filled) context.fill();
      else context.stroke();
    };
    const line = (cells, width, dash = []) => {
      context.lineWidth = width;
      context.setLineDash(dash);
      context.beginPath();
      for (const cell of cells) context.lineTo(...centre(cell));
      context.stroke();
      context.setLineDash([]);
    };

    context.lineJoin = context.lineCap = "round";
    context.imageSmoothingEnabled = false;
    context.drawImage(pictureOf(maze, colourOf("open"), colourOf("wall")), 0, 0, this.canvas.width, this.canvas.height);
    context.fillStyle = colourOf("archive");
    for (const [cell] of counted(archive ?? [])) circle(cell, 0.8 * dot);
    context.strokeStyle = colourOf("trail");
    if (trail) line(trail, dot, [2 * dot, 2 * dot]);
    for (const { cells, colour: own = "path" } of paths) {
      context.strokeStyle = colourOf("open"); // a rim, to be seen against a wall
      line(cells, 2 * dot);
      context.strokeStyle = colourOf(own);
      line(cells, dot);
    }
    context.fillStyle = colourOf(colour ?? "ends");
    context.globalAlpha = 0.75;
    for (const [cell, count] of counted(ends ?? [])) circle(cell, dot * Math.min(1 + 0.3 * Math.sqrt(count), 3.5));
    context.globalAlpha = 1;
    context.strokeStyle = colourOf("mark");
    for (const [from, to] of [...links, ...rays]) line([from, to], dot / 2);

    context.strokeStyle = context.fillStyle = colourOf("start");
    context.lineWidth = 0.3 * ring;
    circle(maze.start, ring, false);
    this.#star(context, centre(maze.goal), star, colourOf("goal"), colourOf("open"));
    if (robot) {
      context.fillStyle = colourOf("robot");
      circle(robot, body);
    }
    context.strokeStyle = colourOf("mark");
    context.lineWidth = 0.3 * ring;
    if (marked) circle(marked, 1.2 * ring, false);
    if (cursor) {
      const [x, y] = centre(cursor), half = Math.max(scale / 2, 3 * devicePixelRatio);
      context.lineWidth = 2 * devicePixelRatio;
      context.strokeRect(x - half, y - half, 2 * half, 2 * half);
    }
  }

  #star(context, [x, y], radius, fill, edge) {
    context.beginPath();
    for (let corner = 0; corner < 10; corner++) {
      const angle = (corner * Math.PI) / 5, reach = corner % 2 ? 0.45 * radius : radius;
      context.lineTo(x + reach * Math.sin(angle), y - reach * Math.cos(angle));
    }
    context.closePath();
    context.lineWidth = devicePixelRatio;
    context.strokeStyle = edge;
    context.fillStyle = fill;
    context.fill();
    context.stroke();
  }
}

/** The cells of a maze, a pixel each. Colours are #rrggbb. */
function pictureOf({ walls, height, width }, open, wall) {
  const picture = make("canvas", { width, height }), context = picture.getContext("2d");
  const image = context.createImageData(width, height);
  const [openPixel, wallPixel] = [open, wall].map((colour) => {
    const [red, green, blue] = colour.trim().match(/[0-9a-f]{2}/gi).map((part) => parseInt(part, 16));
    return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
  });
  const pixels = new Uint32Array(image.data.buffer);
  walls.forEach((isWall, cell) => (pixels[cell] = isWall ? wallPixel : openPixel));
  context.putImageData(image, 0, 0);
  return picture;
}

/** Cells, each once, with how often it occurs. */
function counted(cells) {
  const counts = new Map();
  for (const [row, column] of cells) {
    const key = row * 4096 + column;
    counts.set(key, (counts.get(key) ?? 0) + 1);
  }
  return Array.from(counts, ([key, count]) => [[Math.floor(key / 4096), key % 4096], count]);
}
