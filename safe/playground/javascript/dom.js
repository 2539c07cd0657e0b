// Elements of a page. Texts become text and never markup.

const SVG = "http://www.w3.org/2000/svg";

/** An HTML element. An attribute that begins with `on` is a listener; null, undefined or false leaves it out. */
export function make(tag, attributes = {}, ...children) {
  return fill(document.createElement(tag), attributes, children);
}

/** An SVG element, likewise. */
export function makeSvg(tag, attributes = {}, ...children) {
  return fill(document.createElementNS(SVG, tag), attributes, children);
}

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) {
      node.setAttribute(name, value === true ? "" : value);
    }
  }
  node.append(...children);
  return node;
}

/** A block of elements. */
export function makeBlock(...children) {
  return make("div", {}, ...children);
}

/** A row of buttons and fields. */
export function makeControls(...children) {
  return make("div", { class: "controls" }, ...children);
}

/** A button. */
export function makeButton(text, onclick, attributes = {}) {
  return make("button", { type: "button", onclick, ...attributes }, text);
}

/** A field with its label before it. */
export function labelled(text, field, attributes = {}) {
  return make("label", { class: "field", ...attributes }, make("span", {}, text), field);
}

/** A text that nobody sees, and that screen readers announce when it changes. */
export function makeAnnouncement() {
  return make("p", { class: "unseen", role: "status" });
}

/** A choice among [value, text] pairs. */
export function makeSelect(options, onchange) {
  const select = make("select", {}, ...options.map(([value, text]) => make("option", { value }, text)));
  select.addEventListener("change", () => onchange(select.value));
  return select;
}

/** A group of radio buttons, under a title, for [value, text] pairs. */
export function makeRadios(title, options, selected, onchange) {
  const name = freshId(title);
  const labels = options.map(([value, text]) => {
    const listener = () => onchange(value);
    const radio = make("input", { type: "radio", name, value, checked: value === selected, onchange: listener });
    return make("label", {}, radio, text);
  });
  return make("fieldset", { class: "radios" }, make("legend", {}, title), ...labels);
}

/** The head of a table. isNumber: does the i-th column hold numbers? */
export function makeTableHead(titles, isNumber) {
  const cells = titles.map((title, i) => make("th", { scope: "col", class: isNumber(i) ? "number" : null }, title));
  return make("thead", {}, make("tr", {}, ...cells));
}

/** Cells of a table for numbers, still empty. */
export function makeNumberCells(count) {
  return Array.from({ length: count }, () => make("td", { class: "number" }));
}

/** What is seen in a maze, as [kind, text] pairs; for the kinds see playground.css. */
export function makeLegend(entries) {
  const items = entries.map(([kind, text]) =>
    make("li", {}, make("span", { class: `key ${kind}`, "aria-hidden": "true" }), text)
  );
  return make("ul", { class: "legend" }, ...items);
}

const MODULE_ID = Math.random().toString(36).slice(2); // each widget of a notebook loads this module again
let serial = 0;

/** An id that no other element has. */
export function freshId(name) {
  return `playground-${MODULE_ID}-${name}-${serial++}`;
}

/** Hand a text to the reader as a file. */
export function download(name, text) {
  const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** A text to copy, with a button that does. Returns { element, show(text) }. */
export function makeCopyField(title, button) {
  const area = make("textarea", { rows: 3, readonly: true, spellcheck: "false", "aria-label": title });
  const said = make("span", { role: "status" });
  const copy = () => {
    area.select();
    said.textContent = document.execCommand("copy") ? "Copied." : "Selected: copy it now."; // also without https
  };
  const show = (text) => {
    if (area.value === text) return;
    area.value = text;
    said.textContent = "";
  };
  return { element: makeBlock(area, makeControls(makeButton(button, copy), said)), show };
}

/** Does the reader ask for less motion? */
export function prefersLessMotion() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

/** What this browser was asked to remember under a name; null if it was not, or does not remember. */
export function remembered(name) {
  try {
    return localStorage.getItem(name);
  } catch {
    return null; // as in some frames, and if the reader forbids it
  }
}

/** Ask this browser to remember a text. */
export function remember(name, text) {
  try {
    localStorage.setItem(name, text);
  } catch {
    // then it lasts as long as the page
  }
}
