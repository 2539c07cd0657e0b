// The charts of watched runs: how they have gone, and their objective functions.

import { LineChart, ObjectiveSquare } from "./chart.js";
import { make } from "./dom.js";
import { kindOf, titleOf, wordOf } from "./labels.js";

export class WatchCharts {
  constructor() {
    this.square = new ObjectiveSquare();
    // by what they show of a generation; see worker.js
    this.lines = {
      distance: new LineChart("Best distance, in cells", "generation"),
      novelty: new LineChart("Mean novelty", "generation"),
      archive: new LineChart("Points in the archive", "generation"),
    };
    const charts = [this.square, ...Object.values(this.lines)];
    this.element = make("div", { class: "charts" }, ...charts.map(({ element }) => element));
  }

  /** Show the runs of some panels, and mark the objective function that judged the selected robot (see Inspector). */
  show(panels, selection) {
    for (const [key, chart] of Object.entries(this.lines)) {
      chart.show(panels.map((panel) => seriesOf(panel, key)).filter(({ points }) => points.length > 0));
    }
    const weighing = panels.filter(({ latest }) => latest.weights.length > 0); // goals are on the maze
    this.square.element.hidden = weighing.length === 0 && panels.some(({ latest }) => latest.goals.length > 0);
    this.square.show(weighing.map((panel) => {
      const { weights, winners } = panel.latest, isWeight = (j) => j < weights.length;
      const winner = panel === selection?.panel ? selection.inspection.winner : null;
      return {
        ...looksOf(panel),
        axes: panel.algorithm.components.slice(0, 2).map(wordOf),
        objectives: weights,
        winners: winners.filter(isWeight),
        marked: winner !== null && isWeight(winner) ? winner : null,
      };
    }));
  }
}

function seriesOf(panel, key) {
  const lines = panel.history.filter((line) => line[key] !== null);
  return { ...looksOf(panel), points: lines.map((line) => [line.generation, line[key]]) };
}

function looksOf({ algorithm }) {
  return { label: titleOf(algorithm), kind: kindOf(algorithm) };
}
