// The table of a controller: what its robot senses, and by which of the 16 weights.

import { make, makeNumberCells, makeTableHead } from "./dom.js";
import { SENSORS } from "./maze.js";

const CAPTION =
  "What the robot reads where it stands: dist is how far the next wall is; goal is the size of the maze on the sides " +
  "where the goal lies, and 0 on the others";
const WEIGHT_HEAD = [
  "Sensor",
  "Reading",
  "Weight in h (right if h ≥ 0, else left)",
  "Weight in v (down if v ≥ 0, else up)",
];
const SUMS = [
  { name: "h", forwards: "right", backwards: "left" },
  { name: "v", forwards: "down", backwards: "up" },
];
const SENSOR_TITLES = SENSORS.map((sensor) => sensor.replace("_", " "));
const CHANGES = { ArrowRight: 0.05, ArrowUp: 0.05, ArrowLeft: -0.05, ArrowDown: -0.05, PageUp: 0.25, PageDown: -0.25 };

export class WeightTable {
  /** onchange: called with the index of a weight and what it becomes. */
  constructor(onchange) {
    this.sliders = SUMS.flatMap(({ name }, s) =>
      SENSOR_TITLES.map((sensor, i) => {
        const index = s * SENSORS.length + i;
        return new WeightSlider(`p${index + 1}`, `${sensor} in ${name}`, (weight) => onchange(index, weight));
      })
    );
    this.readings = makeNumberCells(SENSORS.length);
    this.sums = makeNumberCells(SUMS.length);
    const lastRow = make("tr", { class: "sums" }, make("th", { scope: "row" }, "sum"), make("td"), ...this.sums);
    this.element = make(
      "table",
      { class: "weights" },
      make("caption", {}, CAPTION),
      makeTableHead(WEIGHT_HEAD, (i) => i === 1),
      make("tbody", {}, ...SENSOR_TITLES.map((title, i) => this.#makeRow(title, i)), lastRow),
    );
  }

  /** Sliders by the numbers of their weights, with their titles, to stand without the table. */
  alone(numbers) {
    return numbers.map((number) => this.sliders[number - 1].titled());
  }

  #makeRow(title, i) {
    const weights = [this.sliders[i], this.sliders[i + SENSORS.length]];
    const cells = weights.map(({ element }) => make("td", {}, element));
    return make("tr", {}, make("th", { scope: "row" }, title), this.readings[i], ...cells);
  }

  show(controller) {
    controller.forEach((weight, i) => this.sliders[i].show(weight));
  }

  /** Show what the robot senses, and where its controller makes it go. */
  showReadings(readings, controller) {
    readings.forEach((reading, i) => (this.readings[i].textContent = reading));
    SUMS.forEach(({ name, forwards, backwards }, s) => {
      const sum = readings.reduce((total, reading, i) => total + controller[s * SENSORS.length + i] * reading, 0);
      this.sums[s].textContent = `${name} = ${sum.toFixed(1)}: ${sum >= 0 ? forwards : backwards}`;
    });
  }
}

/** A slider for a weight, which moves in steps of 0.01 by mouse and in larger ones by keyboard. */
class WeightSlider {
  constructor(symbol, title, onchange) {
    this.title = `${symbol}: ${title}`;
    const change = (weight) => onchange(Math.round(Math.min(1, Math.max(-1, weight)) * 100) / 100);
    this.number = make("output");
    this.slider = make("input", {
      type: "range",
      min: -1,
      max: 1,
      step: "any",
      "aria-label": this.title,
      oninput: () => change(this.slider.valueAsNumber),
      onkeydown: (event) => {
        if (!Object.hasOwn(CHANGES, event.key)) return;
        event.preventDefault();
        change(this.slider.valueAsNumber + CHANGES[event.key]);
      },
    });
    this.element = make("label", { class: "weight" }, make("span", {}, symbol), this.slider, this.number);
  }

  /** Its element, with the title in full. */
  titled() {
    this.element.firstChild.textContent = this.title;
    return this.element;
  }

  show(weight) {
    this.slider.value = weight;
    this.number.value = weight.toFixed(2);
    this.slider.setAttribute("aria-valuetext", this.number.value);
  }
}
