// Fields that several views show: which algorithms, which seed, which parameters.

import { nthSeed, readSeed, writeSeed } from "./address.js";
import { ALGORITHMS, checkedParameters, PARAMETERS, PROBABILITIES } from "./algorithms.js";
import { checkedInteger, MOST } from "./checks.js";
import { labelled, make, makeSvg } from "./dom.js";

const TITLES = {
  standard: "Standard EA",
  novelty: "Novelty search",
  safe: "SAFE",
  fixed: "Fixed weights",
  random: "Random search",
};

const ABOUT = {
  standard: "rewards closeness to the goal",
  novelty: "rewards ending where none has ended before",
  safe: "evolves what to reward as well",
  fixed: "rewards closeness and novelty, half and half",
  random: "rewards nothing: new robots, drawn by chance",
};
const PARAMETER_TITLES = {
  objectives: "objective functions",
  tournament: "tournament size",
  crossover: "crossover probability",
  mutation: "mutation probability",
  k: "k, nearest neighbours",
  archive: "archive size",
  success_distance: "success within, cells",
};

/** What an algorithm is called. */
export function titleOf(algorithm) {
  return isKnown(algorithm) ? TITLES[algorithm.name] : algorithm.name;
}

/** What an algorithm does, in a few words. */
export function aboutOf(algorithm) {
  return isKnown(algorithm) ? ABOUT[algorithm.name] : "judged by other objective functions";
}

/** The looks of an algorithm's dots and lines, as playground.css knows them. */
export function kindOf(algorithm) {
  return isKnown(algorithm) ? algorithm.name : "other";
}

/** Is this one of ALGORITHMS, and not another by the same name? */
function isKnown(algorithm) {
  return ALGORITHMS[algorithm.name] === algorithm;
}

/** A sample of the line by which charts show an algorithm. */
export function makeSwatch(algorithm) {
  const line = makeSvg("polyline", { class: `line ${kindOf(algorithm)}`, points: "0,4 27,4" });
  return makeSvg("svg", { class: "swatch", viewBox: "0 0 27 8", "aria-hidden": "true" }, line);
}

/** A fieldset of the algorithms to choose from, kept in step with the store. */
export function makeAlgorithmChoice(store) {
  const choice = make("fieldset", { class: "chips" });
  const show = () => {
    const chosen = store.state.algorithms;
    const all = [...Object.values(ALGORITHMS), ...chosen.filter((algorithm) => !isKnown(algorithm))];
    const focused = choice.contains(document.activeElement) ? document.activeElement.value : null;
    choice.replaceChildren(
      make("legend", {}, "Algorithms"),
      ...all.map((algorithm) => {
        const isChosen = chosen.includes(algorithm);
        const onchange = () => {
          const rest = isChosen ? chosen.filter((other) => other !== algorithm) : [...chosen, algorithm];
          if (rest.length > 0) store.set({ algorithms: rest, generation: 0 });
          else show(); // one remains
        };
        const box = make("input", { type: "checkbox", value: algorithm.name, checked: isChosen, onchange });
        return make("label", {}, box, makeSwatch(algorithm), titleOf(algorithm));
      }),
    );
    for (const box of choice.querySelectorAll("input")) if (box.value === focused) box.focus();
  };
  store.listen((names) => names.includes("algorithms") && show());
  show();
  return choice;
}

/** Fields of the seed and, of a run of an experiment, of its number. */
export function makeSeedFields(store, complain) {
  const seed = make("input", { type: "text", size: 8, spellcheck: "false", autocomplete: "off" });
  const run = make("input", { type: "number", min: 0, max: 999999, step: 1 });
  const runField = labelled("Run", run);
  const show = () => {
    const { spawnKey } = store.state.seed;
    seed.value = writeSeed(store.state.seed);
    runField.hidden = spawnKey.length === 0;
    run.value = spawnKey.length > 0 ? String(spawnKey.at(-1)) : "";
  };
  const change = (read) => () => complain(() => store.set({ seed: read(), generation: 0 }), show);
  seed.addEventListener(
    "change",
    change(() => readSeed(seed.value.trim())),
  );
  run.addEventListener(
    "change",
    change(() => nthSeed(store.state.seed, checkedInteger("run", run.valueAsNumber, 0, MOST))),
  );
  store.listen((names) => names.includes("seed") && show());
  show();
  return { seed: labelled("Seed", seed), run: runField };
}

/** Fields of all parameters, folded away. */
export function makeParameterFields(store, complain) {
  const fields = Object.entries(PARAMETERS).map(([name, usual]) => {
    const step = PROBABILITIES.includes(name) ? 0.05 : ["population", "objectives", "elites"].includes(name) ? 2 : 1;
    const field = make("input", { type: "number", min: 0, step, name });
    const show = () => (field.value = store.state.parameters[name] ?? usual);
    field.addEventListener("change", () =>
      complain(() => {
        const { [name]: before, ...others } = store.state.parameters;
        const parameters = field.valueAsNumber === usual ? others : { ...others, [name]: field.valueAsNumber };
        checkedParameters(parameters);
        store.set({ parameters, generation: 0 });
      }, show),
    );
    store.listen((names) => names.includes("parameters") && show());
    show();
    return labelled(PARAMETER_TITLES[name] ?? name, field);
  });
  return make("details", {}, make("summary", {}, "Parameters"), make("div", { class: "fields" }, ...fields));
}

/** A number to three digits, or as it is where it is whole. */
export function number3(value) {
  return Number.isInteger(value) ? `${value}` : `${Number(value.toPrecision(3))}`;
}
