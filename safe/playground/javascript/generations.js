// A run generation by generation, as the package has it for readers. The playground does without.

import { Evolution } from "./evolution.js";
import { listed } from "./novelty_archive.js";
import { WEIGHTS } from "./robot.js";
import { rowsOf } from "./rows.js";

/** One run, generation by generation; as safe.generations. Arguments are checked at once, not at the first step. */
export function generations(maze, algorithm, seed, parameters = {}) {
  return eachGeneration(new Evolution(maze, algorithm, seed, parameters));
}

function* eachGeneration(evolution) {
  while (!evolution.isOver) {
    evolution.advance();
    yield generationOf(evolution);
  }
}

/** The latest generation, as plain arrays; as safe.Generation. */
function generationOf(evolution) {
  const { isJudged, repertoire, algorithm: { rating, scaling } } = evolution;
  const own = (values, isThere = true) => (isThere ? Array.from(values) : null);
  return {
    ...evolution.result(),
    genomes: rowsOf(evolution.genomes, WEIGHTS),
    endpoints: rowsOf(evolution.endpoints, 2),
    distances: own(evolution.distances),
    components: evolution.components.map((values) => own(values)),
    scaled: scaling === "raw" ? null : evolution.scaled.map((values) => own(values)),
    novelty: own(evolution.components[evolution.novelty], evolution.isNoveltyWeighed),
    fitness: own(evolution.fitness, isJudged),
    objectives: rowsOf(evolution.objectives, evolution.genes),
    objectiveFitness: own(evolution.objectiveFitness, rating !== "none" && rating !== "redrawn"),
    winners: own(evolution.winners, isJudged),
    archive: listed(evolution.archive),
    objectiveArchive: listed(evolution.objectiveArchive),
    parents: own(evolution.parents),
    chosenBy: own(evolution.chosenBy),
    repertoire: repertoire && {
      genomes: rowsOf(repertoire.genomes.subarray(0, repertoire.size * WEIGHTS), WEIGHTS),
      endpoints: rowsOf(repertoire.cells.subarray(0, repertoire.size * 2), 2),
    },
  };
}
