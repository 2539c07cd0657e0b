// Fields that show a part of the state and set it: algorithms, seed and parameters, which several views have.

import { nthSeed, readSeed, writeSeed } from "./address.js";
import {
  ALGORITHMS,
  baseOf,
  checkedParameters,
  CHOICES,
  hasChoice,
  optionsOf,
  PARAMETERS,
  PROBABILITIES,
  WEIGHABLE,
  withChoices,
} from "./algorithms.js";
import { checkedInteger, MOST } from "./checks.js";
import { labelled, make } from "./dom.js";
import { makeSwatch, titleOf, wordOf } from "./labels.js";
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
  patience: "generations until it is given up",
  rating: "what objective functions are bred for",
  scaling: "how components are weighed",
  judging: "who chooses parents",
  kind: "what objective functions are",
  pool: "from where parents are taken",
  components: "what they weigh",
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
  mutualism: "high scores of the best solution (mutualism)",
  competition: "low scores of the best solution (competition)",
  discovery: "new cells on the paths of those they choose",
  shuffled: "the same, but shuffled among them",
  patience: "nothing: a goal reached, or given up, is drawn anew",
  redrawn: "nothing: all are drawn anew each time",
  raw: "as they are (paper)",
  maximum: "as shares of the largest",
  rank: "as ranks from 0 to 1",
  "best score": "the best of all scores (paper)",
  "drawn judge": "one objective function, drawn each time",
  favourite: "one likewise: it takes the best of all",
  weights: "weights of components (paper)",
  goal: "goals: places in the maze to end at",
  mixed: "half weights, half goals",
  generation: "the generation (paper)",
  repertoire: "the latest robot of every cell reached",
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
    const common = Object.fromEntries(["scaling", "judging"].map((name) => [name, firstWith(store, name)[name]]));
    const named = Object.values(ALGORITHMS).map((base) =>
      selected.find((algorithm) => baseOf(algorithm) === base) ??
        (base.kind === "weights" ? withChoices(base, common) : base)
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

/** The first of the selected algorithms that has a choice; if none has it, the paper's. */
function firstWith(store, name) {
  return store.state.algorithms.find((algorithm) => hasChoice(algorithm, name)) ?? ALGORITHMS.safe;
}

/** Fields of all parameters and choices, folded away. Those that would change nothing are hidden. */
export function makeParameterFields(store, problem) {
  const fields = Object.fromEntries(
    Object.keys(PARAMETERS).map((name) => [name, makeParameterField(store, problem, name)]),
  );
  const { admission, admitted, threshold, patience, ...others } = fields;
  const show = () => {
    const { parameters, algorithms } = store.state;
    admitted.hidden = parameters.admission !== "random";
    threshold.hidden = parameters.admission !== "threshold";
    patience.hidden = !algorithms.some(({ rating }) => rating === "patience");
  };
  follow(store, "parameters", show);
  follow(store, "algorithms", show);
  const [kind, rating, scaling, judging, pool] = ["kind", "rating", "scaling", "judging", "pool"].map((name) =>
    makeChoiceField(store, problem, name)
  );
  const components = makeComponentsField(store, problem);
  const rules = [admission, admitted, threshold, kind, components, rating, patience, scaling, judging, pool];
  return make(
    "details",
    {},
    make("summary", {}, "Parameters"),
    make("div", { class: "fields" }, ...Object.values(others)),
    make("p", { class: "note" }, "What if? Choices beyond the paper:"),
    make("div", { class: "fields wide" }, ...rules),
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

/** The field of a choice that algorithms have: it sets that of all selected ones, and is hidden if none has it. */
function makeChoiceField(store, problem, name) {
  const select = makeStateSelect(store, problem, CHOICES[name], {
    name: "algorithms",
    read: () => firstWith(store, name)[name],
    write: (value) => setChoice(store, name, value),
  });
  const field = labelled(TITLES[name], select);
  const show = () => {
    const having = store.state.algorithms.filter((algorithm) => hasChoice(algorithm, name));
    const possible = having.flatMap((algorithm) => optionsOf(algorithm, name));
    for (const option of select.options) option.disabled = !possible.includes(option.value);
    field.hidden = having.length === 0;
  };
  follow(store, "algorithms", show);
  return field;
}

/** Boxes for the components that objective functions weigh, those of all selected algorithms that are drawn. */
function makeComponentsField(store, problem) {
  const boxes = WEIGHABLE.map((name) => {
    const onchange = () => problem.attempt(set, show);
    return make("input", { type: "checkbox", value: name, onchange });
  });
  const set = () => {
    setChoice(store, "components", boxes.filter(({ checked }) => checked).map(({ value }) => value));
  };
  const labels = boxes.map((box) => make("label", {}, box, wordOf(box.value)));
  const field = make("fieldset", {}, make("legend", {}, TITLES.components), ...labels);
  const show = () => {
    const { components } = firstWith(store, "components");
    for (const box of boxes) box.checked = components.includes(box.value);
    field.hidden = !store.state.algorithms.some((algorithm) => hasChoice(algorithm, "components"));
  };
  follow(store, "algorithms", show);
  return field;
}

function setChoice(store, name, value) {
  const algorithms = store.state.algorithms.map((algorithm) => withChoices(algorithm, { [name]: value }));
  store.set({ algorithms, generation: 0 });
}
