// The table of many runs: for each algorithm, how many succeeded.

import { make, makeButton, makeNumberCells, makeTableHead } from "./dom.js";
import { makeSwatch, titleOf } from "./labels.js";
import { percentage } from "./text.js";

const OUTCOME_HEAD = ["Algorithm", "Runs", "Successes", "Rate", "95 % interval", "Watch"];

export class OutcomeTable {
  /** onwatch: called with an algorithm, and whether a run that succeeded or one that failed is to be watched. */
  constructor(onwatch) {
    this.onwatch = onwatch;
    this.rows = [];
    this.body = make("tbody");
    this.element = make(
      "div",
      { class: "scroll", role: "region", "aria-label": "Runs so far", tabindex: 0 },
      make(
        "table",
        { class: "outcomes" },
        make("caption", {}, "Runs so far"),
        makeTableHead(OUTCOME_HEAD, (i) => i > 0 && i < OUTCOME_HEAD.length - 1),
        this.body,
      ),
    );
  }

  /** Begin a row for each algorithm. Rows stay while their texts change, so that no button is lost under the finger. */
  begin(algorithms) {
    this.rows = algorithms.map((algorithm) => new OutcomeRow(algorithm, this.onwatch));
    this.body.replaceChildren(...this.rows.map(({ element }) => element));
  }

  /** tallies: for each row { results, counts }; see tally.js. */
  show(tallies) {
    this.rows.forEach((row, i) => row.show(tallies[i]));
  }
}

class OutcomeRow {
  constructor(algorithm, onwatch) {
    const title = titleOf(algorithm);
    this.cells = makeNumberCells(4);
    this.buttons = [["a success", true], ["a failure", false]].map(([text, success]) => {
      const label = { "aria-label": `Watch ${text} of ${title}` };
      return { success, button: makeButton(text, () => onwatch(algorithm, success), label) };
    });
    const head = make("th", { scope: "row" }, makeSwatch(algorithm), title);
    const watch = make("td", {}, ...this.buttons.map(({ button }) => button));
    this.element = make("tr", {}, head, ...this.cells, watch);
  }

  show({ results, counts }) {
    const { runs = 0, successes = 0, low = 0, high = 1 } = counts.at(-1) ?? {};
    const rate = runs > 0 ? `${percentage(successes / runs)} %` : "–";
    const texts = [runs, successes, rate, `${percentage(low)} to ${percentage(high)} %`];
    texts.forEach((text, i) => (this.cells[i].textContent = text));
    for (const { button, success } of this.buttons) button.disabled = !results.includes(success);
  }
}
