// The page that pools the runs of a class: lines in, and out come who is missing, what does not fit, and the intervals.

import { readAddress } from "./address.js";
import { ALGORITHMS, PARAMETERS } from "./algorithms.js";
import { LineChart } from "./chart.js";
import { outcomeOf } from "./class_lines.js";
import { keyOf, outcomeText, poolLines, readLines } from "./class_pool.js";
import { CodeCheck } from "./code_check.js";
import { experimentsOf, firstRunOf, seedOfRun } from "./course.js";
import { labelled, make, makeBlock, makeButton, makeControls, makeNumberCells, makeTableHead } from "./dom.js";
import { makeSwatch, titleOf } from "./labels.js";
import { makeLines } from "./maze_checks.js";
import { textOf } from "./maze_files.js";
import { isNamed } from "./named_mazes.js";
import { PageAddress } from "./page_address.js";
import { Problem } from "./problem.js";
import { defaultState } from "./state.js";
import { compareTallies, seriesOfRates, tally } from "./tally.js";
import { listText, percentage } from "./text.js";
import { makeClients } from "./worker_client.js";

const SAMPLE = 2; // runs of each seat that are made again
const POOL_HEAD = ["Algorithm", "Runs", "Successes", "Rate", "95 % interval", "By the paper's rate"];

/** Put the page of a class into an element, and the box for codes of challenges into another.
 *
 * makeWorker: gives a new worker that runs `serve` of worker.js
 * address: the window whose address may name the class, as in the link that the class follows
 * published: for "maze algorithm" the paper's [successes, runs] */
export function mountClass(element, codes, { makeWorker, address, published }) {
  const page = new ClassPage(makeWorker, published);
  const check = new CodeCheck(makeWorker, page.problem);
  element.replaceChildren(page.element);
  codes.replaceChildren(make("div", { class: "playground" }, check.element));
  const read = (text) => page.problem.attempt(() => page.expect(text));
  const pageAddress = new PageAddress(address, read);
  if (pageAddress.text) read(pageAddress.text);
}

class ClassPage {
  constructor(makeWorker, published) {
    this.makeWorker = makeWorker;
    this.published = published;
    this.wanted = null; // the class that the address names
    this.pool = null; // see `poolLines`
    this.remade = new Map(); // by digest and number, the outcomes of runs that were made again
    this.sample = SAMPLE;
    this.session = 0; // of the workers
    this.problem = new Problem();
    this.area = make("textarea", { class: "lines", rows: 8, spellcheck: "false", oninput: () => this.#read() });
    this.said = make("p", { role: "status" });
    this.missing = make("p");
    this.refused = make("ul", { class: "checks" });
    this.checked = make("p");
    this.more = makeButton(`Check ${SAMPLE} more of each seat`, () => {
      this.sample += SAMPLE;
      this.#check();
    });
    this.verdict = make("p", { class: "note" });
    this.chart = new LineChart("Success in %, with its 95 % interval", "runs of the class");
    this.body = make("tbody");
    this.results = makeBlock(
      this.missing,
      this.checked,
      makeControls(this.more),
      this.verdict,
      make("div", { class: "charts single" }, this.chart.element),
      make(
        "div",
        { class: "scroll", role: "region", "aria-label": "Runs of the class", tabindex: 0 },
        make(
          "table",
          {},
          make("caption", {}, "Runs of the class"),
          makeTableHead(POOL_HEAD, (i) => i > 0),
          this.body,
        ),
      ),
    );
    this.results.hidden = true;
    this.element = make(
      "div",
      { class: "playground" },
      this.problem.element,
      labelled("Lines of the class", this.area, { class: "field wide" }),
      makeControls(labelled("or files", this.#makeFileField())),
      this.said,
      this.refused,
      this.results,
    );
    this.#acceptDrops();
  }

  #makeFileField() {
    const file = make("input", { type: "file", multiple: true, accept: ".txt,text/plain" });
    file.addEventListener("change", async () => {
      await this.#add(file.files);
      file.value = "";
    });
    return file;
  }

  #acceptDrops() {
    const mark = (isOver) => (event) => {
      if (![...event.dataTransfer.types].includes("Files")) return; // a text goes where it is dropped
      event.preventDefault();
      this.area.classList.toggle("drop", isOver);
      if (event.type === "drop") this.#add(event.dataTransfer.files);
    };
    for (const [type, isOver] of [["dragover", true], ["dragleave", false], ["drop", false]]) {
      this.element.addEventListener(type, mark(isOver));
    }
  }

  /** Add the texts of files to the lines. */
  async #add(files) {
    const texts = await Promise.all([...files].map(async (file) => textOf(new Uint8Array(await file.arrayBuffer()))));
    this.area.value = [this.area.value, ...texts].map((text) => text.trim()).filter((text) => text).join("\n");
    this.#read();
  }

  /** Take only lines of the class that an address names. */
  expect(text) {
    const settings = { ...defaultState(), ...readAddress(text) }, { course } = settings;
    this.wanted = course && { course, settings, experiments: experimentsOf(course, settings), seats: new Map() };
    this.#read();
  }

  #read() {
    const pooled = poolLines(readLines(this.area.value), this.wanted && keyOf(this.wanted));
    this.pool = { ...this.wanted, ...pooled };
    this.#check();
  }

  /** The runs of a seat's line: { experiment, number, outcome, key }. */
  #runsOf({ course: { seat }, settings: { runs }, outcomes }) {
    return this.pool.experiments.flatMap((experiment, a) =>
      outcomes[a].map((outcome, i) => {
        const number = firstRunOf(seat, runs) + i;
        return { experiment, number, outcome, key: `${experiment.digest}/${number}` };
      })
    );
  }

  /** Make as many runs of each seat again as the sample asks for, drawn at random. */
  async #check() {
    const session = ++this.session;
    for (const client of this.clients ?? []) client.close();
    const queue = [...this.pool.seats.values()].flatMap((line) => {
      const [left, done] = [false, true].map((isDone) =>
        this.#runsOf(line).filter(({ key }) => this.remade.has(key) === isDone)
      );
      return drawn(left, this.sample - done.length);
    });
    this.#draw(queue.length);
    this.clients = makeClients(this.makeWorker, queue.length);
    try {
      await Promise.all(this.clients.map((client) => this.#work(client, queue, session)));
    } catch (error) {
      if (session === this.session) this.problem.report(error);
    }
    if (session === this.session) { for (const client of this.clients) client.close(); }
  }

  async #work(client, queue, session) {
    const { maze, parameters = {} } = this.pool.settings;
    while (queue.length > 0) {
      const { experiment: { algorithm, digest }, number, key } = queue.shift();
      const result = await client.ask("evolve", { maze, algorithm, seed: seedOfRun(digest, number), parameters });
      if (session !== this.session) return;
      this.remade.set(key, outcomeOf(result));
      this.#draw(queue.length);
    }
  }

  /** The run of a line that came out otherwise when it was made again; undefined if none did. */
  #falseRun(line) {
    return this.#runsOf(line).find(({ key, outcome: { success, number } }) => {
      const again = this.remade.get(key);
      return again && (again.success !== success || again.number !== number);
    });
  }

  #draw(waiting) {
    const { pool } = this, { course, experiments } = pool;
    const lines = [...pool.seats.values()];
    const refused = pool.refused.map(({ at, reason }) => [at, `Line ${at} ${reason}.`]);
    const counted = lines.filter((line) => {
      const wrong = this.#falseRun(line);
      if (wrong) {
        const { key, number, outcome, experiment: { algorithm } } = wrong;
        const [here, again] = [outcome, this.remade.get(key)].map(outcomeText);
        refused.push([
          line.at,
          `Line ${line.at}, of seat ${line.course.seat}, is not what the algorithm makes: it says of run ${number} of ` +
          `${algorithm.name}: ${here}; made again: ${again}.`,
        ]);
      }
      return !wrong;
    });
    refused.sort(([one], [other]) => one - other);
    this.refused.replaceChildren(...makeLines(refused.map(([, text]) => ["bad", text])));
    this.said.textContent = saidOf(pool, counted.length, this.area.value.trim() !== "");
    this.results.hidden = !course;
    if (!course) return;
    this.missing.textContent = missingText(course, counted);
    this.#drawChecked(lines, waiting);
    const tallies = experiments.map(({ algorithm }, a) => ({
      algorithm,
      counts: tally(counted.flatMap(({ outcomes }) => outcomes[a].map(({ success }) => success))),
    }));
    this.chart.show(tallies.map(seriesOfRates), 100, course.seats * pool.settings.runs);
    this.verdict.textContent = compareTallies(tallies);
    this.body.replaceChildren(...tallies.map((one) => this.#makeRow(one)));
  }

  #drawChecked(lines, waiting) {
    const runs = lines.flatMap((line) => this.#runsOf(line));
    const checked = runs.filter(({ key }) => this.remade.has(key)).length;
    this.checked.textContent = `Made again in this page, drawn at random: ${checked} of ${runs.length} runs` +
      (waiting > 0 ? `; ${waiting} more are waiting.` : ".");
    this.more.disabled = checked === runs.length;
  }

  #makeRow({ algorithm, counts }) {
    const { runs = 0, successes = 0, low = 0, high = 1 } = counts.at(-1) ?? {};
    const rate = runs > 0 ? `${percentage(successes / runs)} %` : "–";
    const texts = [
      runs,
      successes,
      rate,
      `${percentage(low)} to ${percentage(high)} %`,
      this.#expectation(algorithm, runs),
    ];
    const cells = makeNumberCells(texts.length);
    texts.forEach((text, i) => (cells[i].textContent = text));
    return make("tr", {}, make("th", { scope: "row" }, makeSwatch(algorithm), titleOf(algorithm)), ...cells);
  }

  /** How many successes the paper's rate would give, if this is an experiment of the paper. */
  #expectation(algorithm, runs) {
    const { maze, parameters } = this.pool.settings;
    const isPapers = isNamed(maze) && ALGORITHMS[algorithm.name] === algorithm &&
      Object.entries(parameters).every(([name, value]) => PARAMETERS[name] === value);
    const counts = isPapers ? this.published[`${maze.name} ${algorithm.name}`] : null;
    if (!counts) return "–";
    const [successes, all] = counts;
    return `${Math.round((runs * successes) / all)} (${successes} of ${all})`;
  }
}

/** So many of the values, at random. */
function drawn(values, count) {
  const left = [...values], chosen = [];
  while (chosen.length < count && left.length > 0) {
    chosen.push(...left.splice(Math.floor(Math.random() * left.length), 1));
  }
  return chosen;
}

function saidOf({ course, repeated, refused }, counted, isSomething) {
  if (!isSomething) return course ? "No lines yet." : "";
  const parts = [`${counted} counted`];
  if (repeated.length > 0) parts.push(`${repeated.length} given again`);
  if (refused.length > 0) parts.push(`${refused.length} refused`);
  if (counted + repeated.length + refused.length === 0) return "There is no line of a class in this text.";
  return `Lines: ${parts.join(", ")}.`;
}

function missingText({ name, seats }, counted) {
  const there = new Set(counted.map(({ course: { seat } }) => seat));
  const missing = Array.from({ length: seats }, (_, i) => i + 1).filter((seat) => !there.has(seat));
  return `Class ${name}: ${there.size} of ${seats} seats.` +
    (missing.length > 0 ? ` Missing: ${listText(missing.map(String))}.` : " Nobody is missing.");
}
