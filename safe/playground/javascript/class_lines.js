// The outcomes of a seat's runs as a line of text (see safe/playground/lines.py):
//
//     SAFE-class-RULES;address of the class;seat;outcomes;checksum;
//
// An outcome is + and the generation of the success, or - and how many cells the best robot was from the goal. Commas
// separate algorithms. The checksum is the beginning of the SHA-256 of all before it.

import { writeAddress } from "./address.js";
import { RULES } from "./evolution.js";
import { sha256 } from "./sha256.js";

export const LINE_HEAD = "SAFE-class-";

/** What a run has come to, in short: { success, number }, the generation of the success, or the distance at the end. */
export function outcomeOf({ success, generation, distance }) {
  return { success, number: success ? generation : distance };
}

/** The line of a seat. settings: { maze, algorithms, seed, parameters, runs }; outcomes: a list for each algorithm. */
export function writeLine(course, settings, outcomes) {
  const lists = outcomes.map((list) => list.map(({ success, number }) => `${success ? "+" : "-"}${number}`).join(""));
  const text = `${LINE_HEAD}${RULES};${writeAddress({ ...settings, course, view: "runs" })};${course.seat};${lists};`;
  return `${text}${checksumOf(text)};`;
}

/** The checksum of a text. */
export function checksumOf(text) {
  return sha256(text).slice(0, 8);
}
