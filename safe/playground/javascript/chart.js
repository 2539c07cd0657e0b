// Charts as SVG: lines over a number, and the square of objective functions.

import { make, makeSvg } from "./dom.js";
import { shortNumber } from "./text.js";

const WIDTH = 250;
const HEIGHT = 170;
const LEFT = 36;
const BOTTOM = 32;
const TOP = 10;
const RIGHT = 10;
const MOST_POINTS = 400; // of a line or a square that are drawn

/** Lines over a number, such as that of the generation. */
export class LineChart {
  constructor(title, across) {
    this.title = title;
    this.across = across;
    this.drawing = makeSvg("svg", { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, role: "img", "aria-label": title });
    this.element = make("figure", { class: "chart" }, make("figcaption", {}, title), this.drawing);
  }

  /** series: a list of { label, kind, points: [[x, y]], band: [[x, low, high]] }; for kinds see `kindOf`.
   *
   * top and last: where the scales end, unless the points go beyond. */
  show(series, top = 0, last = 1) {
    const points = series.flatMap(({ points: all, band = [] }) => all.concat(band.map(([x, , high]) => [x, high])));
    const lastX = points.reduce((largest, [x]) => Math.max(largest, x), last);
    const topY = rounded(points.reduce((largest, [, y]) => Math.max(largest, y), top) || 1);
    const toX = (x) => LEFT + (x / lastX) * (WIDTH - LEFT - RIGHT);
    const toY = (y) => HEIGHT - BOTTOM - (y / topY) * (HEIGHT - BOTTOM - TOP);
    const corners = (pairs) => pairs.map(([x, y]) => `${toX(x).toFixed(1)},${toY(y).toFixed(1)}`).join(" ");
    this.drawing.setAttribute("aria-label", `${this.title}: ${series.map(summary).join("; ") || "nothing yet"}`);
    this.drawing.replaceChildren(
      ...makeAxes(HEIGHT, this.across, [0, lastX], [0, topY]),
      makeText(LEFT - 5, toY(topY / 2) + 4, shortNumber(topY / 2), "end"),
      ...series.flatMap(({ kind, points: all, band = [] }) => [
        makeSvg("polygon", {
          class: `band ${kind}`,
          points: corners([...band.map(([x, low]) => [x, low]), ...band.map(([x, , high]) => [x, high]).reverse()]),
        }),
        makeSvg("polyline", { class: `line ${kind}`, points: corners(thinned(all)) }),
      ]),
    );
  }
}

/** The square of objective functions [a, b], with those highlighted that gave solutions their fitness. */
export class ObjectiveSquare {
  constructor() {
    this.drawing = makeSvg("svg", { viewBox: "0 0 250 250", role: "img" });
    const legend = make("small", {}, "large: those that gave robots their fitness");
    const caption = make("figcaption", {}, "Objective functions", legend);
    this.element = make("figure", { class: "chart square" }, caption, this.drawing);
  }

  /** groups: for each algorithm { label, kind, axes, objectives: [[a, b, ...]], winners, marked }; `axes` are what a and b
   * weigh, `winners` the indices of those that gave the solutions their fitness, `marked` that of one to mark, or null. */
  show(groups) {
    const coefficients = groups.flatMap(({ objectives }) => objectives.flatMap((genes) => genes.slice(0, 2)));
    const top = coefficients.reduce((largest, value) => Math.max(largest, value), 1);
    const low = coefficients.reduce((smallest, value) => Math.min(smallest, value), 0);
    const toX = (a) => LEFT + ((a - low) / (top - low)) * (WIDTH - LEFT - RIGHT);
    const toY = (b) => WIDTH - BOTTOM - ((b - low) / (top - low)) * (WIDTH - BOTTOM - TOP);
    const dot = ([a, b = 0], r, kind) => makeSvg("circle", { cx: toX(a), cy: toY(b), r, class: kind });
    const summaries = [], judges = [], winning = [], marks = [];
    for (const { label, kind, objectives, winners, marked } of groups) {
      const wins = new Map();
      for (const j of winners) wins.set(j, (wins.get(j) ?? 0) + 1);
      for (const objective of thinned(objectives)) judges.push(dot(objective, 2.2, "judge"));
      for (const [j, count] of wins) {
        winning.push(dot(objectives[j], 3.5 + Math.min(6, Math.sqrt(count) / 3), `winner ${kind}`));
      }
      if (marked !== null) marks.push(dot(objectives[marked], 11, "marked"));
      summaries.push(`${label}: ${objectives.length}, of which ${wins.size} gave solutions their fitness`);
    }
    this.drawing.setAttribute(
      "aria-label",
      `Objective functions by their coefficients a and b. ${summaries.join("; ")}`,
    );
    const [across, up] = ["a", "b"].map((letter, i) => {
      const titles = new Set(groups.map(({ axes }) => axes[i] ?? "nothing"));
      return `${letter}: ${titles.size > 0 ? [...titles].join(" or ") : ["closeness", "novelty"][i]}`;
    });
    this.drawing.replaceChildren(
      ...makeAxes(WIDTH, across, [low, top], [low, top]),
      makeSvg("text", { x: 14, y: 110, "text-anchor": "middle", transform: "rotate(-90 14 110)" }, up),
      ...judges,
      ...winning,
      ...marks,
    );
  }
}

/** Two axes: what the lower one counts, and where both begin and end. */
function makeAxes(height, across, [firstX, lastX], [lowY, topY]) {
  const bottom = height - BOTTOM, right = WIDTH - RIGHT;
  return [
    makeSvg("path", { class: "axis", d: `M${LEFT},${TOP}V${bottom}H${right}` }),
    makeText(LEFT - 5, TOP + 8, shortNumber(topY), "end"),
    makeText(LEFT - 5, bottom, shortNumber(lowY), "end"),
    makeText(LEFT, bottom + 14, shortNumber(firstX), "middle"),
    makeText(right, bottom + 14, shortNumber(lastX), "end"),
    makeText((LEFT + right) / 2, height - 4, across, "middle"),
  ];
}

/** At most MOST_POINTS of the values, evenly spread, the last among them. */
function thinned(values) {
  const step = Math.ceil(values.length / MOST_POINTS);
  return step <= 1 ? values : values.filter((_, i) => i % step === 0 || i === values.length - 1);
}

function makeText(x, y, content, anchor) {
  return makeSvg("text", { x, y, "text-anchor": anchor }, content);
}

/** A round number, at least as large. */
function rounded(value) {
  const unit = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 4, 5, 10].map((step) => step * unit).find((step) => step >= value * 0.9999);
}

function summary({ label, points }) {
  if (points.length === 0) return `${label}: nothing yet`;
  const [x, y] = points.at(-1);
  return `${label}: ${shortNumber(y)} at ${shortNumber(x)}`;
}
