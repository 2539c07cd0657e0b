// The inspector: one robot of the generation, and how it came by its novelty and fitness.

import { labelled, make, makeButton, makeControls, makeSelect, makeTableHead } from "./dom.js";
import { titleOf, wordOf } from "./labels.js";
import { cellsText, listText, percentage, shortNumber } from "./text.js";

const MOST_SUMMANDS = 30; // of a novelty that are written out
const STANDING_HEAD = ["Measure", "This robot", "Largest", "Place"];

export class Inspector {
  /** onselect: called with the index of a panel and the number of a robot. ondrive: with a controller. */
  constructor({ onselect, ondrive }) {
    this.onselect = onselect;
    this.ondrive = ondrive;
    this.subject = null; // a selection, or panels of which no robot is selected
    const number = make("input", { type: "number", disabled: true }); // until there are robots
    this.element = make("section", { class: "inspector", "aria-label": "One robot" });
    this.element.append(...makeHead(), makeControls(labelled("Robot", number)));
  }

  /** selection: { panel, individual, inspection } of the robot to describe, or null. */
  show(panels, selection) {
    const subject = selection ?? panels;
    if (subject === this.subject) return; // so that nobody is interrupted
    this.subject = subject;
    const { activeElement } = document;
    const focusedTag = this.element.contains(activeElement) ? activeElement.tagName.toLowerCase() : null;
    this.element.replaceChildren(
      ...makeHead(),
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
    const { ends } = panel.latest;
    const { endpoint: [row, column], distance, novelty, fitness, controller } = inspection;
    const place = `Robot ${individual} ended at row ${row}, column ${column}, ${cellsText(distance)} from the goal.`;
    const judgement = fitness !== null ? fitnessText(inspection) : nobodyText(panel.latest);
    const shares = sharesOf(inspection);
    return [
      make("p", { class: "explanation" }, place),
      ...(novelty !== null ? [make("p", { class: "explanation newness" }, noveltyText(inspection))] : []),
      make("p", { class: "explanation judgement" }, judgement),
      ...(shares.length > 0 ? [makeSharesBar(shares)] : []),
      ...(fitness !== null ? [make("p", { class: "judges" }, judgeText(inspection, panel))] : []),
      makeStandings(inspection.standings, ends.length),
      makeButton("Drive this robot", () => this.ondrive(controller)),
    ];
  }
}

function makeHead() {
  const note = "Click where one ended, or give its number in the generation, counted from 0.";
  return [make("h2", {}, "One robot"), make("p", { class: "note" }, note)];
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
  const { fitness, winner, goal, terms } = inspection;
  const given = `Fitness ${shortNumber(fitness)}, by objective function ${winner}`;
  if (goal) return `${given}, a goal: the place (${goal.row}, ${goal.column}), ${cellsText(goal.distance)} away.`;
  const coefficients = terms.map(({ coefficient }, c) => `${"abcd"[c]} = ${shortNumber(coefficient)}`);
  const shares = sharesOf(inspection);
  const parts = terms.map(({ name, value }, c) => {
    const share = shares.length > 0 ? ` (${percentage(shares[c].share, 1)} %)` : "";
    return `${shortNumber(value)} for ${wordOf(name)}${share}`;
  });
  return `${given} with ${listText(coefficients)}: ${listText(parts)}.`;
}

/** Why a robot has no fitness. */
function nobodyText({ reached }) {
  return "Nobody judges it: " +
    (reached === null
      ? "in random search there is nothing to select by."
      : `parents are drawn from the latest robots of the ${reached} cells reached so far.`);
}

/** Who decides: how much hangs on the objective function behind the fitness, and who selects parents. */
function judgeText({ winner, wins }, { algorithm: { judging, kind }, latest: { ends, weights, goals, reached } }) {
  const robots = ends.length, judges = weights.length + goals.length;
  const given = `Objective function ${winner} gives ${wins === robots ? "all" : `${wins} of the`} ${robots} fitnesses`;
  const isDrawn = judging === "drawn judge";
  if (judging === "best score" || (isDrawn && judges === 1)) return `${given}, by which tournaments choose parents.`;
  const how = isDrawn ? "each tournament draws its judge from" : "each is the favourite of one, drawn from";
  const pool = reached === null ? "" : `${kind === "mixed" ? "; goals choose" : ","} among the latest robots of the ` +
    `${reached} cells reached so far`;
  return `${given}. But parents are not chosen by fitness: ${how} all ${judges} objective functions${pool}.`;
}

/** What shares of a fitness are for what: { title, share }; none if there are no shares, or only one can be. */
function sharesOf({ fitness, terms }) {
  if (!(fitness > 0) || terms.length < 2 || terms.some(({ value }) => value < 0)) return [];
  return terms.map(({ name, value }) => ({ title: wordOf(name), share: value / fitness }));
}

function makeSharesBar(shares) {
  const text = listText(shares.map(({ title, share }) => `${percentage(share, 1)} % ${title}`));
  return make(
    "div",
    { class: "shares", role: "img", "aria-label": `Its fitness: ${text}` },
    ...shares.map(({ title, share }) => make("span", { style: `flex-grow: ${share}` }, share > 0.1 ? title : "")),
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
