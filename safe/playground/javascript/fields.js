// Fields that show a part of the state and set it: algorithms, seed and parameters, which several views have.

import { nthSeed, readSeed, writeSeed } from "./address.js";
import {
  ALGORITHMS,
  baseOf,
  checkedParameters,
  CHOICES,
  hasChoice,
  PARAMETERS,
  PROBABILITIES,
  withChoices,
} from "./algorithms.js";
import { checkedInteger, MOST } from "./checks.js";
import { labelled, make } from "./dom.js";
import { makeSwatch, titleOf } from "./labels.js";
import { ADMISSIONS } from "./novelty.js";

const TITLES = {
  objectives: "objective functions",
  tournament: "tournament size",
  crossover: "crossover probability",
  mutation: "mutation probability",
  k: "k, nearest neighbours",
  archive: "archive size",
  success_distance: "success within, cells",
  admission: "what enters the archive",
  admitted: "how many, in each generation",
  threshold: "the threshold, at first",
  rating: "what objective functions are bred for",
  scaling: "how closeness and novelty are weighed",
  judging: "who chooses parents",
};
const OPTIONS = { // by the names that they have in the package
  "lowest replaced": "the most novel (paper)",
  random: "some, drawn at random",
  threshold: "all with novelty above a threshold",
  "after scoring": "the most novel, after all are scored",
  distinct: "the most novel, at most one a cell",
  rescored: "the most novel, by scores computed again",
  none: "nothing: they stay as drawn",
  "genotypic novelty": "being different (paper)",
  pearson: "scores that grow near the goal (Pearson)",
  spearman: "ranks that grow near the goal (Spearman)",
  raw: "as they are (paper)",
  maximum: "as shares of the largest",
  rank: "as ranks from 0 to 1",
  "best score": "the best of all scores (paper)",
  "drawn judge": "one objective function, drawn each time",
};
const EVEN_PARAMETERS = ["population", "objectives", "elites"];

/** An input that shows a part of the state and sets it. If an entry is refused, the input shows the state again.
 *
 * name: of the part with which the input changes. read: gives the value to show. write: takes the number or the text
 * that was entered, and throws an InputError if it is wrong. */
export function makeStateInput(store, problem, attributes, part) {
  return linked(make("input", attributes), store, problem, part);
}

/** A choice among options, likewise. */
function makeStateSelect(store, problem, options, part) {
  const titled = options.map((value) => make("option", { value }, OPTIONS[value]));
  return linked(make("select", {}, ...titled), store, problem, part);
}

function linked(input, store, problem, { name, read, write }) {
  const show = () => (input.value = read());
  const set = () => write(input.type === "number" ? input.valueAsNumber : input.value.trim());
  input.addEventListener("change", () => problem.attempt(set, show));
  follow(store, name, show);
  return input;
}

/** Show a part of the state, now and whenever it changes. */
function follow(store, name, show) {
  store.listen((names) => names.includes(name) && show());
  show();
}

/** A fieldset of the algorithms to choose from. */
export function makeAlgorithmChoice(store) {
  const choice = make("fieldset", { class: "chips" });
  const show = () => {
    const selected = store.state.algorithms;
    // the others are offered with the choices of the selected ones, to be compared with them
    const { scaling, judging } = selected.find((algorithm) => hasChoice(algorithm, "scaling")) ?? ALGORITHMS.safe;
    const named = Object.values(ALGORITHMS).map((base) =>
      selected.find((algorithm) => baseOf(algorithm) === base) ?? withChoices(base, { scaling, judging })
    );
    const options = new Set([...named, ...selected]);
    const focused = choice.contains(document.activeElement) ? document.activeElement.value : null;
    choice.replaceChildren(
      make("legend", {}, "Algorithms"),
      ...Array.from(options, (algorithm) => makeAlgorithmBox(algorithm, selected.includes(algorithm), toggle)),
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
  follow(store, "algorithms", show);
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
  follow(store, "seed", () => (field.hidden = store.state.seed.spawnKey.length === 0));
  return field;
}

/** Fields of all parameters and choices, folded away. */
export function makeParameterFields(store, problem) {
  const fields = Object.keys(PARAMETERS).map((name) => makeParameterField(store, problem, name));
  const [admission, admitted, threshold] = fields.splice(-3);
  follow(store, "parameters", () => {
    const chosen = store.state.parameters.admission;
    admitted.hidden = chosen !== "random";
    threshold.hidden = chosen !== "threshold";
  });
  const choices = Object.keys(CHOICES).map((name) => makeChoiceField(store, problem, name));
  return make(
    "details",
    {},
    make("summary", {}, "Parameters"),
    make("div", { class: "fields" }, ...fields),
    make("p", { class: "note" }, "What if? Choices beyond the paper:"),
    make("div", { class: "fields wide" }, admission, admitted, threshold, ...choices),
  );
}

function makeParameterField(store, problem, name) {
  const part = {
    name: "parameters",
    read: () => store.state.parameters[name] ?? PARAMETERS[name],
    write: (value) => {
      const { [name]: _, ...others } = store.state.parameters;
      const parameters = value === PARAMETERS[name] ? others : { ...others, [name]: value };
      checkedParameters(parameters);
      store.set({ parameters, generation: 0 });
    },
  };
  const step = PROBABILITIES.includes(name) ? 0.05 : EVEN_PARAMETERS.includes(name) ? 2 : 1;
  const input = name === "admission"
    ? makeStateSelect(store, problem, ADMISSIONS, part)
    : makeStateInput(store, problem, { type: "number", min: 0, step, name }, part);
  return labelled(TITLES[name] ?? name, input);
}

/** The field of a choice that algorithms have: it sets that of all selected ones, and is disabled if none has it. */
function makeChoiceField(store, problem, name) {
  const first = () => store.state.algorithms.find((algorithm) => hasChoice(algorithm, name));
  const select = makeStateSelect(store, problem, CHOICES[name], {
    name: "algorithms",
    read: () => (first() ?? ALGORITHMS.safe)[name],
    write: (value) => {
      const algorithms = store.state.algorithms.map((algorithm) => withChoices(algorithm, { [name]: value }));
      store.set({ algorithms, generation: 0 });
    },
  });
  follow(store, "algorithms", () => (select.disabled = !first()));
  return labelled(TITLES[name], select);
}
