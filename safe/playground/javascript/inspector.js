// The inspector: one robot of the generation, and how it came by its novelty and fitness.

import { labelled, make, makeButton, makeControls, makeSelect, makeTableHead } from "./dom.js";
import { titleOf } from "./labels.js";
import { cellsText, percentage, shortNumber } from "./text.js";

const MOST_SUMMANDS = 30; // of a novelty that are written out
const STANDING_HEAD = ["Measure", "This robot", "Largest", "Place"];

export class Inspector {
  /** onselect: called with the index of a panel and the number of a robot. ondrive: with a controller. */
  constructor({ onselect, ondrive }) {
    this.onselect = onselect;
    this.ondrive = ondrive;
    this.subject = null; // a selection, or panels of which no robot is selected
    this.element = make("section", { class: "inspector", "aria-label": "One robot" });
  }

  /** selection: { panel, individual, inspection } of the robot to describe, or null. */
  show(panels, selection) {
    const subject = selection ?? panels;
    if (subject === this.subject) return; // so that nobody is interrupted
    this.subject = subject;
    const { activeElement } = document;
    const focusedTag = this.element.contains(activeElement) ? activeElement.tagName.toLowerCase() : null;
    this.element.replaceChildren(
      make("h2", {}, "One robot"),
      make("p", { class: "note" }, "Click where one ended, or give its number in the generation, counted from 0."),
      this.#makeForm(panels, selection),
      ...(selection ? this.#describe(selection) : []),
    );
    if (focusedTag) this.element.querySelector(focusedTag)?.focus();
  }

  #makeForm(panels, selection) {
    const last = panels[0].latest.ends.length - 1;
    const value = selection?.individual ?? "";
    const onchange = () =>
      this.onselect(Number(run.value), Math.min(last, Math.max(0, Math.round(number.valueAsNumber || 0))));
    const number = make("input", { type: "number", min: 0, max: last, step: 1, value, onchange });
    const run = makeSelect(panels.map(({ algorithm }, i) => [i, titleOf(algorithm)]), onchange);
    if (selection) run.value = panels.indexOf(selection.panel);
    return makeControls(labelled("Robot", number), ...(panels.length > 1 ? [labelled("of", run)] : []));
  }

  #describe({ panel, individual, inspection }) {
    const { ends, objectives } = panel.latest;
    const { endpoint: [row, column], distance, novelty, fitness, controller } = inspection;
    const lines = [`Robot ${individual} ended at row ${row}, column ${column}, ${cellsText(distance)} from the goal.`];
    if (novelty !== null) lines.push(noveltyText(inspection));
    if (fitness !== null) lines.push(fitnessText(inspection));
    else lines.push("Nobody judges it: in random search there is nothing to select by.");
    const share = goalShareOf(inspection);
    return [
      ...lines.map((line) => make("p", { class: "explanation" }, line)),
      ...(share === null ? [] : [makeSharesBar(share)]),
      ...(fitness === null ? [] : [make("p", {}, judgeText(inspection, ends.length, objectives.length))]),
      makeStandings(inspection.standings, ends.length),
      makeButton("Drive this robot", () => this.ondrive(controller)),
    ];
  }
}

function noveltyText({ novelty, neighbours, k }) {
  const fromPopulation = neighbours.filter(({ from }) => from === "population").length;
  const distances = neighbours.map(({ distance }) => distance);
  const sum = distances.reduce((total, distance) => total + distance, 0);
  const summands = distances.slice(0, MOST_SUMMANDS).join(" + ") + (distances.length > MOST_SUMMANDS ? " + …" : "");
  return (
    `Novelty ${shortNumber(novelty)}: its nearest neighbours, ${fromPopulation} of its own generation and ` +
    `${neighbours.length - fromPopulation} of the archive, are at distances that add up to ${sum} (${summands}); ` +
    `that over k = ${k}.`
  );
}

function fitnessText(inspection) {
  const { fitness, winner, coefficients: [a, b], fromGoal, fromNovelty } = inspection;
  const share = goalShareOf(inspection);
  const [goal, novelty] = share === null ? ["", ""] : [share, 1 - share].map((part) => ` (${percentage(part, 1)} %)`);
  return (
    `Fitness ${shortNumber(fitness)}, by objective function ${winner} with a = ${shortNumber(a)} and ` +
    `b = ${shortNumber(b)}: ${shortNumber(fromGoal)} for being near the goal${goal} and ` +
    `${shortNumber(fromNovelty)} for novelty${novelty}.`
  );
}

/** Who decides: how much hangs on the objective function behind the fitness, and who selects parents. */
function judgeText({ winner, wins, areJudgesDrawn }, robots, judges) {
  const given = `Objective function ${winner} gives ${wins === robots ? "all" : `${wins} of the`} ${robots} fitnesses`;
  return areJudgesDrawn && judges > 1
    ? `${given}. But parents are not chosen by fitness: each tournament draws its judge from all ${judges} ` +
      "objective functions."
    : `${given}, by which tournaments choose parents.`;
}

/** Which share of a fitness is for being near the goal, the rest being for novelty.
 *
 * null if there are no shares: without a fitness, or with negative coefficients. */
function goalShareOf({ fitness, fromGoal, fromNovelty }) {
  return fitness > 0 && Math.min(fromGoal, fromNovelty) >= 0 ? fromGoal / fitness : null;
}

function makeSharesBar(share) {
  const rest = 1 - share;
  const text = `Of its fitness, ${percentage(share, 1)} % is goal and ${percentage(rest, 1)} % novelty`;
  return make(
    "div",
    { class: "shares", role: "img", "aria-label": text },
    make("span", { class: "goal", style: `flex-grow: ${share}` }, share > 0.1 ? "goal" : ""),
    make("span", { class: "novelty", style: `flex-grow: ${rest}` }, share < 0.9 ? "novelty" : ""),
  );
}

/** A robot beside the others of its generation, measure by measure; see worker.js. */
function makeStandings(standings, robots) {
  const rows = standings.map(({ measure, value, largest, place }) => {
    const share = largest > 0 ? Math.max(0, value) / largest : 0;
    return make(
      "tr",
      {},
      make("th", { scope: "row" }, measure),
      make("td", { class: "number bar", style: `--share: ${share}` }, shortNumber(value)),
      ...[shortNumber(largest), place].map((number) => make("td", { class: "number" }, number)),
    );
  });
  return make(
    "table",
    { class: "standings" },
    make("caption", {}, `Among the ${robots} robots of the generation (place 1 is the best, and equals share a place)`),
    makeTableHead(STANDING_HEAD, (i) => i > 0),
    make("tbody", {}, ...rows),
  );
}
