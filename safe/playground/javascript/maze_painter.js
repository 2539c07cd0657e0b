// The picture of a maze: its cells, and upon them what goes on there.

import { make } from "./dom.js";

// Radii: so many cells, but at least and at most so many pixels.
const DOT = [0.4, 1.6, 6];
const ROBOT = [0.45, 4.5, 10];
const RING = [0.6, 6, 14];
const STAR = [0.85, 10, 24];

export class MazePainter {
  /** scale: pixels of the canvas for a cell. */
  constructor(canvas, scale) {
    this.canvas = canvas;
    this.scale = scale;
    this.context = canvas.getContext("2d");
    this.style = getComputedStyle(canvas);
    [this.dot, this.body, this.ring, this.star] = [DOT, ROBOT, RING, STAR].map(([cells, least, most]) =>
      Math.min(Math.max(cells * scale, least * devicePixelRatio), most * devicePixelRatio)
    );
    this.context.lineJoin = this.context.lineCap = "round";
    this.context.imageSmoothingEnabled = false;
  }

  /** scene: { maze, archive, ends, colour of the ends, places, trail, paths: [{ cells, colour }], robot, rays, links,
   * favourites, marked, cursor }, all optional but the maze. Cells are [row, column]; rays, links and favourites are
   * pairs of cells. */
  paint({
    maze,
    archive = [],
    ends = [],
    colour,
    places = [],
    trail = [],
    paths = [],
    robot,
    rays = [],
    links = [],
    favourites = [],
    marked,
    cursor,
  }) {
    this.#paintCells(maze);
    this.#paintArchive(archive);
    this.#paintLines(trail, paths);
    this.#paintEnds(ends, colour);
    this.#paintPlaces(places, favourites);
    this.context.strokeStyle = this.#colourOf("mark");
    for (const pair of [...links, ...rays]) this.#line(pair, this.dot / 2);
    this.#paintStartAndGoal(maze);
    if (robot) this.#paintRobot(robot);
    this.context.strokeStyle = this.#colourOf("mark");
    if (marked) this.#ringAround(marked, 1.2 * this.ring);
    if (cursor) this.#paintCursor(cursor);
  }

  #paintCells(maze) {
    const picture = pictureOf(maze, this.#colourOf("open"), this.#colourOf("wall"));
    this.context.drawImage(picture, 0, 0, this.canvas.width, this.canvas.height);
  }

  #paintArchive(archive) {
    this.context.fillStyle = this.#colourOf("archive");
    for (const [cell] of counted(archive)) this.#disc(cell, 0.8 * this.dot);
  }

  #paintLines(trail, paths) {
    this.context.strokeStyle = this.#colourOf("trail");
    this.#line(trail, this.dot, [2 * this.dot, 2 * this.dot]);
    for (const { cells, colour = "path" } of paths) {
      this.context.strokeStyle = this.#colourOf("open"); // a rim, to be seen against a wall
      this.#line(cells, 2 * this.dot);
      this.context.strokeStyle = this.#colourOf(colour);
      this.#line(cells, this.dot);
    }
  }

  #paintEnds(ends, colour) {
    this.context.fillStyle = this.#colourOf(colour);
    this.context.globalAlpha = 0.75;
    for (const [cell, count] of counted(ends)) this.#disc(cell, this.dot * Math.min(1 + 0.3 * Math.sqrt(count), 3.5));
    this.context.globalAlpha = 1;
  }

  #paintPlaces(places, favourites) {
    this.context.strokeStyle = this.#colourOf("place");
    this.context.globalAlpha = 0.6;
    for (const pair of favourites) this.#line(pair, this.dot / 2);
    this.context.globalAlpha = 1;
    for (const [cell] of counted(places)) this.#cross(cell, 1.3 * this.dot);
  }

  #paintStartAndGoal({ start, goal }) {
    this.context.strokeStyle = this.#colourOf("start");
    this.#ringAround(start, this.ring);
    this.context.strokeStyle = this.#colourOf("open");
    this.context.fillStyle = this.#colourOf("goal");
    this.#star(goal);
  }

  #paintRobot(robot) {
    this.context.fillStyle = this.#colourOf("robot");
    this.#disc(robot, this.body);
  }

  #paintCursor(cursor) {
    const [x, y] = this.#centre(cursor), half = Math.max(this.scale / 2, 3 * devicePixelRatio);
    this.context.lineWidth = 2 * devicePixelRatio;
    this.context.strokeRect(x - half, y - half, 2 * half, 2 * half);
  }

  /** A colour by its name in playground.css. */
  #colourOf(name) {
    return this.style.getPropertyValue(`--${name}`);
  }

  #centre([row, column]) {
    return [(column + 0.5) * this.scale, (row + 0.5) * this.scale];
  }

  #circle(cell, radius) {
    this.context.beginPath();
    this.context.arc(...this.#centre(cell), radius, 0, 2 * Math.PI);
  }

  #disc(cell, radius) {
    this.#circle(cell, radius);
    this.context.fill();
  }

  #ringAround(cell, radius) {
    this.context.lineWidth = 0.3 * this.ring;
    this.#circle(cell, radius);
    this.context.stroke();
  }

  #line(cells, width, dash = []) {
    this.context.lineWidth = width;
    this.context.setLineDash(dash);
    this.context.beginPath();
    for (const cell of cells) this.context.lineTo(...this.#centre(cell));
    this.context.stroke();
    this.context.setLineDash([]);
  }

  #cross(cell, reach) {
    const [x, y] = this.#centre(cell);
    this.context.lineWidth = 0.6 * this.dot;
    this.context.beginPath();
    for (const side of [-reach, reach]) {
      this.context.moveTo(x - side, y - reach);
      this.context.lineTo(x + side, y + reach);
    }
    this.context.stroke();
  }

  #star(cell) {
    const [x, y] = this.#centre(cell);
    this.context.beginPath();
    for (let corner = 0; corner < 10; corner++) {
      const angle = (corner * Math.PI) / 5, reach = corner % 2 ? 0.45 * this.star : this.star;
      this.context.lineTo(x + reach * Math.sin(angle), y - reach * Math.cos(angle));
    }
    this.context.closePath();
    this.context.lineWidth = devicePixelRatio;
    this.context.fill();
    this.context.stroke();
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
