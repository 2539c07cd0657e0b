// Lines of a class read, and pooled (see class_lines.js, and safe/playground/lines.py).
//
// A line may be broken anywhere, as programs for mail do.

import { readAddress } from "./address.js";
import { checkedParameters } from "./algorithms.js";
import { checkedInteger, InputError } from "./checks.js";
import { checksumOf, LINE_HEAD } from "./class_lines.js";
import { checkedCourse, experimentsOf, firstRunOf } from "./course.js";
import { RULES } from "./evolution.js";

const PARTS = 5; // of a line, each with a semicolon behind it
const BREAKS = /[\s>\u00ad\u200b\ufeff]/g; // what mail and chat put into a line, also at the beginning of a quoted one
const LOST = /class=/; // outside of a line: the rest of one whose head is damaged

/** All lines in a text, in order: { at, course, settings, experiments, outcomes }, where `at` is the number of the line
 * of the text in which it begins; or { at, reason } if it is refused. Other text is skipped. */
export function readLines(text) {
  const found = [];
  let at = 1;
  for (const piece of text.split(new RegExp(`(?=${LINE_HEAD})`))) {
    const parts = piece.startsWith(LINE_HEAD) ? piece.split(";").slice(0, PARTS) : [];
    const isWhole = parts.length === PARTS && piece.split(";").length > PARTS;
    const length = isWhole ? parts.join(";").length + 1 : 0;
    if (isWhole) found.push({ at, ...attempted(parts.map((part) => part.replace(BREAKS, ""))) });
    else if (parts.length > 0) found.push({ at, reason: "is cut off before its end" });
    const rest = parts.length > 0 && !isWhole ? [] : piece.slice(length).split("\n");
    const before = piece.slice(0, length).split("\n").length - 1;
    rest.forEach((line, i) => {
      if (LOST.test(line)) found.push({ at: at + before + i, reason: "is damaged at its beginning" });
    });
    at += piece.split("\n").length - 1;
  }
  return found;
}

function attempted(parts) {
  try {
    return readLine(parts);
  } catch (error) {
    return { reason: error.message };
  }
}

function readLine([head, address, seat, lists, checksum]) {
  if (checksumOf(`${[head, address, seat, lists].join(";")};`) !== checksum) {
    throw new InputError("is damaged: its checksum does not fit");
  }
  if (head !== `${LINE_HEAD}${RULES}`) {
    throw new InputError(`follows the rules of another version: ${head.slice(LINE_HEAD.length)} instead of ${RULES}`);
  }
  const { course, ...settings } = { parameters: {}, ...readAddress(address) };
  if (!course || settings.view !== "runs") throw new InputError("names no class");
  const seated = checkedCourse({ ...course, seat: /^[0-9]{1,4}$/.test(seat) ? Number(seat) : NaN });
  const outcomes = lists.split(",").map((list) => (list.match(/[+-][^+-]*/g) ?? []).map(readOutcome));
  const { algorithms, runs } = settings;
  if (outcomes.length !== algorithms.length || outcomes.some((list) => list.length !== runs)) {
    throw new InputError(`must hold ${runs} outcomes of each of ${algorithms.length} algorithms`);
  }
  checkOutcomes(outcomes, checkedParameters(settings.parameters));
  return { course: seated, settings, experiments: experimentsOf(seated, settings), outcomes };
}

function readOutcome(text) {
  if (!/^[+-][0-9]{1,7}$/.test(text)) throw new InputError(`has an outcome that is none: ${text}`);
  return { success: text[0] === "+", number: Number(text.slice(1)) };
}

function checkOutcomes(outcomes, { generations, success_distance: reach }) {
  for (const { success, number } of outcomes.flat()) {
    if (success) checkedInteger("the generation of a success", number, 0, generations - 1);
    else checkedInteger("the distance at the end of a failure", number, reach + 1);
  }
}

/** What the lines of a class come to.
 *
 * lines: as `readLines` gives them. key: of the class (see `keyOf`), or null for that of most lines.
 * Returns { course, settings, experiments, seats: the lines that count, by seat, repeated: [line], refused:
 * [{ at, reason }] }; without a line that counts, and without a key, the first three are undefined. */
export function poolLines(lines, key = null) {
  const refused = lines.filter(({ reason }) => reason), whole = lines.filter(({ reason }) => !reason);
  const keys = whole.map(keyOf);
  const chosen = key ?? mostFrequent(keys);
  const first = whole[keys.indexOf(chosen)];
  const seats = new Map(), repeated = [];
  for (const [i, line] of whole.entries()) {
    const { at, course: { name, seat } } = line;
    if (keys[i] !== chosen) {
      const isOther = first && first.course.name !== name;
      refused.push({ at, reason: isOther ? `is of the class ${name}` : "is of a class with other settings" });
    } else if (!seats.has(seat)) seats.set(seat, line);
    else {
      const reason = difference(seats.get(seat), line);
      if (!reason) repeated.push(line);
      else {
        refused.push({ at, reason });
        seats.get(seat).isDoubted = true;
      }
    }
  }
  for (const [seat, { at, isDoubted }] of seats) {
    if (!isDoubted) continue;
    seats.delete(seat);
    refused.push({ at, reason: `disagrees with another line of seat ${seat}` });
  }
  refused.sort((one, other) => one.at - other.at);
  return { ...first, seats: new Map([...seats].sort(([one], [other]) => one - other)), repeated, refused };
}

/** What tells classes apart: { course, settings, experiments } of the same class have the same key. */
export function keyOf({ course: { name, seats }, settings: { runs }, experiments }) {
  return JSON.stringify([name, seats, runs, experiments.map(({ digest }) => digest)]);
}

function mostFrequent(keys) {
  const counts = new Map();
  for (const key of keys) counts.set(key, (counts.get(key) ?? 0) + 1);
  return [...counts].reduce((best, one) => (one[1] > best[1] ? one : best), [null, 0])[0];
}

/** The first outcome in which a line differs from another one of the same seat; null if there is none. */
function difference(one, other) {
  for (const [a, list] of other.outcomes.entries()) {
    for (const [i, outcome] of list.entries()) {
      const known = one.outcomes[a][i];
      if (known.success === outcome.success && known.number === outcome.number) continue;
      const run = firstRunOf(other.course.seat, list.length) + i;
      return `disagrees with line ${one.at} about run ${run} of ${other.experiments[a].algorithm.name}: ` +
        `${outcomeText(outcome)} here, ${outcomeText(known)} there`;
    }
  }
  return null;
}

/** An outcome in words. */
export function outcomeText({ success, number }) {
  return success ? `success in generation ${number}` : `failure ${number} cells from the goal`;
}
