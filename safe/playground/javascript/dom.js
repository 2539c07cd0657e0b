// Elements of a page. Texts become text and never markup.

const SVG = "http://www.w3.org/2000/svg";

/** An HTML element. Attributes that begin with `on` are listeners; null, undefined and false leave one away. */
export function make(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

/** An SVG element, likewise. */
export function makeSvg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined && value !== false)
      node.setAttribute(name, value === true ? "" : value);
  }
  node.append(...children.filter((child) => child !== null));
  return node;
}

/** A button. */
export function makeButton(text, onclick, attributes = {}) {
  return make("button", { type: "button", onclick, ...attributes }, text);
}

/** A field with its label before it. */
export function labelled(text, field, attributes = {}) {
  return make("label", { class: "field", ...attributes }, make("span", {}, text), field);
}

/** A choice among [value, text] pairs. */
export function makeSelect(options, onchange) {
  const select = make("select", {}, ...options.map(([value, text]) => make("option", { value }, text)));
  select.addEventListener("change", () => onchange(select.value));
  return select;
}

/** A row of choices of which one is taken: radio buttons for [value, text] pairs, in a group with a name. */
export function makeRadios(name, options, chosen, onchange) {
  const group = freshId(name);
  return make(
    "fieldset",
    { class: "radios" },
    make("legend", {}, name),
    ...options.map(([value, text]) =>
      make(
        "label",
        {},
        make("input", {
          type: "radio",
          name: group,
          value,
          checked: value === chosen,
          onchange: () => onchange(value),
        }),
        text,
      ),
    ),
  );
}

const OWN = Math.random().toString(36).slice(2); // each widget of a notebook loads this module anew
let serial = 0;

/** What is seen in a maze, as [kind, text] pairs; for kinds see playground.css. */
export function makeLegend(entries) {
  const items = entries.map(([kind, text]) =>
    make("li", {}, make("span", { class: `key ${kind}`, "aria-hidden": "true" }), text),
  );
  return make("ul", { class: "legend" }, ...items);
}

/** An id that no other element has. */
export function freshId(name) {
  return `playground-${OWN}-${name}-${serial++}`;
}

/** Hand a text to the reader as a file. */
export function download(name, text) {
  const link = make("a", { href: URL.createObjectURL(new Blob([text], { type: "text/plain" })), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** Does the reader ask for less motion? */
export function prefersLessMotion() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}
