// Checks of what users pass in, in the words of the package (see safe/checks.py). A check that fails is an InputError
// that names the argument, what it must be, and what it was.

export const MOST = 1000000; // of anything that is counted or stored
export const LARGEST = 1e100; // of any number in an array: squares of such, and sums of those, are finite

/** An argument is wrong; the message says which and why, in one line. */
export class InputError extends Error {}

/** The value as an error message shows it: in one line, cut if it is long. */
export function shown(value) {
  let text;
  if (typeof value === "string") {
    const quote = value.includes("'") && !value.includes('"') ? '"' : "'";
    const escaped = value.replace(/\\|(?! )[\p{C}\p{Z}]/gu, escapedCharacter).replaceAll(quote, "\\" + quote);
    text = quote + escaped + quote;
  } else if (value === undefined || value === null) text = "None";
  else if (Array.isArray(value)) text = `[${value.map(shown).join(", ")}]`;
  else if (typeof value === "object") text = `a value of type ${value.constructor?.name ?? "Object"}`;
  else text = String(value);
  const characters = [...text];
  return characters.length <= 80 ? text : characters.slice(0, 77).join("") + "...";
}

/** An array as Python writes a tuple. */
export function shownTuple(values) {
  return `(${values.map(shown).join(", ")}${values.length === 1 ? "," : ""})`;
}

/** A backslash, or a character that does not print, as Python writes it in a text. */
function escapedCharacter(character) {
  const short = { "\\": "\\\\", "\n": "\\n", "\r": "\\r", "\t": "\\t" }[character];
  const code = character.codePointAt(0);
  const [letter, digits] = code < 0x100 ? ["x", 2] : code < 0x10000 ? ["u", 4] : ["U", 8];
  return short ?? `\\${letter}${code.toString(16).padStart(digits, "0")}`;
}

/** `value`, which must be an integer in low..high, both included. */
export function checkedInteger(name, value, low, high = Infinity) {
  if (!Number.isInteger(value) || value < low || value > high) {
    const allowed = high === Infinity ? `of at least ${low}` : `from ${low} to ${high}`;
    throw new InputError(`${name} must be an integer ${allowed}; got ${shown(value)}`);
  }
  return value;
}

/** `value`, which must be a number in [low, high]. */
export function checkedNumber(name, value, low, high) {
  if (typeof value !== "number" || !(value >= low && value <= high)) {
    throw new InputError(`${name} must be a number from ${low} to ${high}; got ${shown(value)}`);
  }
  return value;
}

/** `value`, which must be one of the strings in `allowed`. */
export function checkedChoice(name, value, allowed) {
  if (typeof value !== "string" || !allowed.includes(value)) {
    throw new InputError(`${name} must be one of ${allowed.map(shown).join(", ")}; got ${shown(value)}`);
  }
  return value;
}

/** `value`, which must be an array of at least one of the strings in `allowed`, each at most once. */
export function checkedChoices(name, value, allowed) {
  const isChosen = Array.isArray(value) && value.length > 0 && new Set(value).size === value.length &&
    value.every((one) => allowed.includes(one));
  if (isChosen) return value;
  throw new InputError(
    `${name} must be some of ${allowed.map(shown).join(", ")}, each at most once; got ${shown(value)}`,
  );
}

/** Rows of numbers as one Float64Array, row after row; each row must have `columns` finite numbers in [low, high]. */
export function checkedRows(name, rows, columns, low = -LARGEST, high = LARGEST) {
  const isTable = Array.isArray(rows) && rows.every(isRow);
  if (!isTable) throw new InputError(`${name} must be an array of numbers; got ${shown(rows)}`);
  const odd = rows.find((row) => row.length !== columns);
  if (odd) {
    const isEven = rows.every((row) => row.length === odd.length);
    const shape = isEven ? `(${rows.length}, ${odd.length})` : "rows of different lengths";
    throw new InputError(`${name} must have the shape (any, ${columns}); got shape ${shape}`);
  }
  rows.forEach((row, i) => checkRange(name, row, low, high, (column) => `(${i}, ${column})`));
  return Float64Array.from(rows.flatMap((row) => [...row]));
}

/** One such row. */
export function checkedRow(name, row, columns, low = -LARGEST, high = LARGEST) {
  if (!isRow(row)) throw new InputError(`${name} must be an array of numbers; got ${shown(row)}`);
  if (row.length !== columns) {
    throw new InputError(`${name} must have the shape (${columns}); got shape (${row.length},)`);
  }
  checkRange(name, row, low, high, (column) => `(${column},)`);
  return Float64Array.from(row);
}

function isRow(row) {
  return (Array.isArray(row) || ArrayBuffer.isView(row)) && row.every((number) => typeof number === "number");
}

function checkRange(name, row, low, high, indexOf) {
  const wrong = row.findIndex((number) => !(Number.isFinite(number) && number >= low && number <= high));
  if (wrong >= 0) {
    throw new InputError(
      `${name} must be finite and in [${low}, ${high}]; got ${row[wrong]} at index ${indexOf(wrong)}`,
    );
  }
}
