// A figure of a chapter: one view of the playground, with few controls. It runs while it is seen.

import { readAddress, writeAddress } from "./address.js";
import { make, makeRadios, prefersLessMotion } from "./dom.js";
import { DriveView } from "./drive_view.js";
import { Problem } from "./problem.js";
import { RunsView } from "./runs_view.js";
import { defaultState } from "./state.js";
import { Store } from "./store.js";
import { WatchView } from "./watch_view.js";

const VIEW_OF = { watch: WatchView, drive: DriveView, runs: RunsView };
const ENOUGH = 0.5; // of a figure that is seen, for it to run

/** Put a figure into an element.
 *
 * address: of the state to begin with, which names the view: watch, drive or runs
 * parts: what is shown of the view beside its maze; see playground.css. With "play" it plays as soon as it is seen
 * weights: in the view drive, the numbers of the weights whose sliders take the place of the table, counted from 1
 * robot: in the view watch, the number of the robot that is selected at first and after a choice, or null
 * choices: { title, options: [address, text] pairs }, or null; these addresses hold what differs from `address`
 * href: of the page that holds the whole playground
 * makeWorker: gives a new worker that runs `serve` of worker.js */
export function mountFigure(element, { address, parts, weights = [], robot = null, choices = null, href, makeWorker }) {
  const stateAt = (other = "") => ({ ...defaultState(), ...readAddress(address), ...readAddress(other) });
  const first = choices?.options[0][0];
  const store = new Store(stateAt(first));
  const problem = new Problem();
  const view = new VIEW_OF[store.state.view]({ store, problem, makeWorker, weights });
  const moves = { watch: !prefersLessMotion(), runs: true }; // runs are counted, and nothing moves
  const playsAlone = parts.includes("play") && moves[store.state.view];

  const link = make("a", { class: "opener" }, "Open in the playground");
  const setLink = () => (link.href = `${href}#${writeAddress({ ...store.state, ...view.reached })}`);
  for (const event of ["pointerenter", "focus"]) link.addEventListener(event, setLink);
  const selectFirst = () => {
    if (robot !== null) view.select(0, () => robot);
  };
  const choose = (other) => {
    store.set(stateAt(other));
    selectFirst();
    if (playsAlone) view.play();
  };
  const radios = choices ? [makeRadios(choices.title, choices.options, first, choose)] : [];
  const root = make(
    "div",
    { class: ["playground", "figure", store.state.view, ...parts].join(" ") },
    ...radios,
    problem.element,
    view.element,
    link,
  );
  store.listen((names) => {
    view.show(names);
    setLink();
  });

  element.append(root);
  element.classList.add("mounted");
  view.show(Object.keys(store.state));
  selectFirst();
  setLink();

  let isToPlay = playsAlone; // as soon as it is seen
  new IntersectionObserver((entries) => {
    if (entries.at(-1).intersectionRatio >= ENOUGH) {
      if (isToPlay) view.play();
      isToPlay = false;
    } else if (view.isPlaying) {
      view.pause();
      isToPlay = true;
    }
  }, { threshold: ENOUGH }).observe(root);
}
