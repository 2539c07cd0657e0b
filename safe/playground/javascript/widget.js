// The playground as a widget of Jupyter (see safe/playground/widget.py). What the reader changes goes to the kernel,
// and what the kernel sets is shown. A widget may be shown several times, and then shows the same everywhere.

import { mount } from "./playground.js";

const TRAITS = ["maze", "controller", "seed", "result"]; // of safe.Playground

/** Show a widget's model in an element. Returns a function that ends this. */
export function renderWidget(model, element, makeWorker) {
  let isOwnChange = false; // which this view shows already
  const view = mount(element, {
    state: Object.fromEntries(TRAITS.map((trait) => [trait, structuredClone(model.get(trait))])),
    makeWorker,
    onChange(changes) {
      isOwnChange = true;
      try {
        for (const [trait, value] of Object.entries(changes)) model.set(trait, structuredClone(value));
      } finally {
        isOwnChange = false;
      }
      model.save_changes();
    },
  });
  const listeners = TRAITS.map((trait) => [`change:${trait}`, () => {
    if (!isOwnChange) view.update({ [trait]: structuredClone(model.get(trait)) });
  }]);
  for (const [event, listener] of listeners) model.on(event, listener);
  const keepKeys = (event) => event.stopPropagation(); // they mean something else to a notebook: d d deletes a cell
  element.addEventListener("keydown", keepKeys);
  return () => {
    for (const [event, listener] of listeners) model.off(event, listener);
    element.removeEventListener("keydown", keepKeys);
    view.destroy();
  };
}
