// The playground: SAFE to see and to play with, in a page of the book or in a notebook.
//
// engine.js and what it exports are the science, as in the package. worker.js runs it beside the page, which asks it by
// way of worker_client.js. The page has a state (state.js, kept in store.js), which is also in its address (address.js,
// page_address.js), and a view for each tab (tabs.js): watch_view.js, drive_view.js, draw_view.js, runs_view.js and challenges_view.js. The
// parts of a view are files, too. course.js and class_lines.js let a class share runs, which class_page.js pools.
// figure.js shows one view in a chapter. bundle.py makes one script of all modules, and says how they may import and
// export.

import { readAddress } from "./address.js";
import { ChallengesView } from "./challenges_view.js";
import { labelled, make } from "./dom.js";
import { DrawView } from "./draw_view.js";
import { DriveView } from "./drive_view.js";
import { makeMazeChoice } from "./maze_choice.js";
import { PageAddress } from "./page_address.js";
import { Problem } from "./problem.js";
import { RunsView } from "./runs_view.js";
import { defaultState, fromOutside, openingState, toOutside } from "./state.js";
import { SETTINGS, Store } from "./store.js";
import { Tabs } from "./tabs.js";
import { WatchView } from "./watch_view.js";

const WELCOME =
  "200 robots start at the ring and walk 300 steps each. A green dot is where one of them ended, a faint one where " +
  "an earlier one did. The star is the goal: a robot that ends within 2 cells of it is a success. The fittest breed " +
  "the next generation, and soon one will succeed: press Play.";

/** Put a playground into an element.
 *
 * state: any of { maze: a drawing, controller: 16 numbers, seed: a text, result: a run's, or null }
 * makeWorker: gives a new worker that runs `serve` of worker.js
 * onChange: called with those of the same that were changed in the page
 * address: the window whose address holds the state, or null
 *
 * Returns { update(changes), destroy() }; `update` changes the same from outside, and throws an InputError if one of
 * them is wrong. */
export function mount(element, { state = {}, makeWorker, onChange = () => {}, address = null }) {
  const store = new Store({ ...defaultState(), ...fromOutside(state) });
  const problem = new Problem();
  const welcome = make("p", { class: "welcome", hidden: true }, WELCOME);
  const pageAddress = address && new PageAddress(address, (text) =>
    problem.attempt(() => {
      store.set({ ...defaultState(), ...readAddress(text), result: null }, "outside");
      root.scrollIntoView();
    }));
  if (pageAddress?.text === "") {
    Object.assign(store.state, openingState());
    welcome.hidden = false;
  } else if (pageAddress) problem.attempt(() => Object.assign(store.state, readAddress(pageAddress.text)));

  const views = makeViews({ store, problem, makeWorker, page: address });
  const tabs = new Tabs(store, views);
  const head = make("div", { class: "head" }, tabs.list, labelled("Maze", makeMazeChoice(store)));
  const root = make(
    "div",
    { class: "playground" },
    head,
    problem.element,
    welcome,
    views.challenges.banner,
    ...tabs.panels,
  );

  store.listen((names, source) => {
    if (names.includes("view")) {
      for (const [name, view] of Object.entries(views)) if (name !== store.state.view) view.pause();
      tabs.show();
    }
    if (names.some((name) => SETTINGS.includes(name))) {
      problem.clear();
      welcome.hidden = true;
    }
    for (const view of Object.values(views)) view.show(names);
    if (source !== "page") return;
    const changes = toOutside(store.state, names);
    if (Object.keys(changes).length > 0) onChange(changes);
    pageAddress?.write(store.state);
  });

  element.replaceChildren(root);
  for (const view of Object.values(views)) view.show(Object.keys(store.state));
  return {
    update: (changes) => store.set(fromOutside(changes), "outside"),
    destroy() {
      pageAddress?.destroy();
      for (const view of Object.values(views)) view.destroy();
      root.remove();
    },
  };
}

/** The views by name. Each has an `element`, `show(names of what has changed)`, `pause()` and `destroy()`. */
function makeViews(shared) {
  return {
    watch: new WatchView(shared),
    drive: new DriveView(shared),
    draw: new DrawView(shared),
    runs: new RunsView(shared),
    challenges: new ChallengesView(shared),
  };
}
