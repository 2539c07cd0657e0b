// Numbers as the page writes them.

/** A whole number as it is, any other to three digits. */
export function shortNumber(value) {
  return Number.isInteger(value) ? `${value}` : `${Number(value.toPrecision(3))}`;
}

/** A share in per cent, by default with a decimal if it is small. */
export function percentage(share, decimals = share > 0 && share < 0.1 ? 1 : 0) {
  return (100 * share).toFixed(decimals);
}

/** So many cells, in words. */
export function cellsText(count) {
  return `${count} cell${count === 1 ? "" : "s"}`;
}

/** Texts in one, as a list in a sentence. */
export function listText(texts) {
  return [texts.slice(0, -1).join(", "), texts.at(-1)].filter((text) => text).join(" and ");
}
