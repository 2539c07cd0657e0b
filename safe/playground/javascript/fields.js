// Fields that show a part of the state and set it: algorithms, seed and parameters, which several views have.

import { nthSeed, readSeed, writeSeed } from "./address.js";
import { ALGORITHMS, checkedParameters, PARAMETERS, PROBABILITIES } from "./algorithms.js";
import { checkedInteger, MOST } from "./checks.js";
import { labelled, make } from "./dom.js";
import { isNamedAlgorithm, makeSwatch, titleOf } from "./labels.js";

const PARAMETER_TITLES = {
  objectives: "objective functions",
  tournament: "tournament size",
  crossover: "crossover probability",
  mutation: "mutation probability",
  k: "k, nearest neighbours",
  archive: "archive size",
  success_distance: "success within, cells",
};
const EVEN_PARAMETERS = ["population", "objectives", "elites"];

/** An input that shows a part of the state and sets it. If an entry is refused, the input shows the state again.
 *
 * name: of the part with which the input changes. read: gives the value to show. write: takes the number or the text
 * that was entered, and throws an InputError if it is wrong. */
export function makeStateInput(store, problem, attributes, { name, read, write }) {
  const input = make("input", attributes);
  const show = () => (input.value = read());
  const set = () => write(input.type === "number" ? input.valueAsNumber : input.value.trim());
  input.addEventListener("change", () => problem.attempt(set, show));
  store.listen((changed) => changed.includes(name) && show());
  show();
  return input;
}

/** A fieldset of the algorithms to choose from. */
export function makeAlgorithmChoice(store) {
  const choice = make("fieldset", { class: "chips" });
  const show = () => {
    const selected = store.state.algorithms;
    const options = [...Object.values(ALGORITHMS), ...selected.filter((algorithm) => !isNamedAlgorithm(algorithm))];
    const focused = choice.contains(document.activeElement) ? document.activeElement.value : null;
    choice.replaceChildren(
      make("legend", {}, "Algorithms"),
      ...options.map((algorithm) => makeAlgorithmBox(algorithm, selected.includes(algorithm), toggle)),
    );
    for (const box of choice.querySelectorAll("input")) if (box.value === focused) box.focus();
  };
  const toggle = (algorithm) => {
    const selected = store.state.algorithms;
    const others = selected.filter((other) => other !== algorithm);
    const algorithms = others.length < selected.length ? others : [...selected, algorithm];
    if (algorithms.length > 0) store.set({ algorithms, generation: 0 });
    else show(); // the last one stays selected
  };
  store.listen((names) => names.includes("algorithms") && show());
  show();
  return choice;
}

function makeAlgorithmBox(algorithm, isSelected, toggle) {
  const onchange = () => toggle(algorithm);
  const box = make("input", { type: "checkbox", value: algorithm.name, checked: isSelected, onchange });
  return make("label", {}, box, makeSwatch(algorithm), titleOf(algorithm));
}

/** The field of the seed. */
export function makeSeedField(store, problem) {
  const attributes = { type: "text", size: 8, spellcheck: "false", autocomplete: "off" };
  const input = makeStateInput(store, problem, attributes, {
    name: "seed",
    read: () => writeSeed(store.state.seed),
    write: (text) => store.set({ seed: readSeed(text), generation: 0 }),
  });
  return labelled("Seed", input);
}

/** The field of the number of an experiment's run, hidden if the seed is not that of such a run. */
export function makeRunField(store, problem) {
  const input = makeStateInput(store, problem, { type: "number", min: 0, max: 999999, step: 1 }, {
    name: "seed",
    read: () => String(store.state.seed.spawnKey.at(-1) ?? ""),
    write: (run) => store.set({ seed: nthSeed(store.state.seed, checkedInteger("run", run, 0, MOST)), generation: 0 }),
  });
  const field = labelled("Run", input);
  const show = () => (field.hidden = store.state.seed.spawnKey.length === 0);
  store.listen((names) => names.includes("seed") && show());
  show();
  return field;
}

/** Fields of all parameters, folded away. */
export function makeParameterFields(store, problem) {
  const fields = Object.keys(PARAMETERS).map((name) => makeParameterField(store, problem, name));
  return make("details", {}, make("summary", {}, "Parameters"), make("div", { class: "fields" }, ...fields));
}

function makeParameterField(store, problem, name) {
  const step = PROBABILITIES.includes(name) ? 0.05 : EVEN_PARAMETERS.includes(name) ? 2 : 1;
  const input = makeStateInput(store, problem, { type: "number", min: 0, step, name }, {
    name: "parameters",
    read: () => store.state.parameters[name] ?? PARAMETERS[name],
    write: (value) => {
      const { [name]: _, ...others } = store.state.parameters;
      const parameters = value === PARAMETERS[name] ? others : { ...others, [name]: value };
      checkedParameters(parameters);
      store.set({ parameters, generation: 0 });
    },
  });
  return labelled(PARAMETER_TITLES[name] ?? name, input);
}
