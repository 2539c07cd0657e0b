// The playground as a widget of Jupyter (see safe/playground.py): what is changed on the page goes to the kernel, and
// what the kernel sets is shown. Of several views of one widget each shows what is changed in another.

import { mount } from "./playground.js";

export const SHARED = ["maze", "controller", "seed", "result"]; // the traits of safe.Playground

/** Show a widget's model in an element. Returns a function that ends this. */
export function renderWidget(model, element, makeWorker) {
  let isTelling = false; // the kernel what this view shows already
  const view = mount(element, {
    state: Object.fromEntries(SHARED.map((key) => [key, structuredClone(model.get(key))])),
    makeWorker,
    onChange(changes) {
      isTelling = true;
      try {
        for (const [key, value] of Object.entries(changes)) model.set(key, structuredClone(value));
      } finally {
        isTelling = false;
      }
      model.save_changes();
    },
  });
  const keep = (event) => event.stopPropagation(); // keys mean something else to a notebook: d d deletes a cell
  element.addEventListener("keydown", keep);
  const listeners = SHARED.map((key) => [
    `change:${key}`,
    () => {
      if (!isTelling) view.update({ [key]: structuredClone(model.get(key)) });
    },
  ]);
  for (const [event, listener] of listeners) model.on(event, listener);
  return () => {
    for (const [event, listener] of listeners) model.off(event, listener);
    element.removeEventListener("keydown", keep);
    view.destroy();
  };
}
