// The playground: SAFE to see and to play with, in a page of the book or in a notebook.

import {
  isNamed,
  known,
  namedMaze,
  readAddress,
  readController,
  readSeed,
  writeAddress,
  writeSeed,
} from "./address.js";
import { ALGORITHMS } from "./algorithms.js";
import { freshId, labelled, make, makeSelect } from "./dom.js";
import { DrawView } from "./draw.js";
import { DriveView } from "./drive.js";
import { drawingOf, parseMaze } from "./maze.js";
import { MAZES } from "./mazes.js";
import { PRESETS } from "./presets.js";
import { RunsView } from "./runs.js";
import { SETTINGS, Store } from "./store.js";
import { WatchView } from "./watch.js";

const TABS = [
  ["watch", "Watch", "Robots walk the maze, and the next generation is bred from the fittest."],
  ["drive", "Drive", "One robot, by hand: its 16 weights, and where they lead it."],
  ["draw", "Draw", "A maze of your own, for all the other tabs."],
  ["runs", "Many runs", "How often does it work, and how many runs does it take to be sure?"],
];
const WELCOME =
  "200 robots start at the ring and walk 300 steps each. A green dot is where one of them ended, a faint one where an " +
  "earlier one did. The star is the goal: a robot that ends within 2 cells of it is a success. The fittest breed the " +
  "next generation, and soon one will succeed: press Play.";
const WRITING = 250; // milliseconds after the last change until it is in the address

/** What a first visit opens on: a run about to succeed. */
function opening() {
  return { algorithms: [ALGORITHMS.safe], seed: readSeed("3"), generation: 40 };
}

/** The state where nothing is said of it. */
function usual() {
  return {
    view: "watch",
    maze: namedMaze("maze1"),
    algorithms: [ALGORITHMS.safe],
    seed: readSeed("0"),
    parameters: {},
    generation: 0,
    runs: 50,
    controller: PRESETS[0].controller,
    result: null,
  };
}

/** Put a playground into an element.
 *
 * state: any of { maze: a drawing, controller: 16 numbers, seed: a text, result: a run's, or null }
 * makeWorker: gives a new worker that runs `serve` of worker.js
 * onChange: called with those of the same that were changed in the page
 * address: the window whose address holds the state; null where none does
 *
 * Gives { update(changes), destroy() }; `update` changes the same from outside, and throws an InputError at what is
 * wrong. */
export function mount(element, { state = {}, makeWorker, onChange = () => {}, address = null }) {
  const problem = make("p", { class: "problem", role: "alert", hidden: true });
  const report = (error) => {
    problem.textContent = error.message;
    problem.hidden = false;
    problem.scrollIntoView({ block: "nearest" });
  };
  /** Do something that may fail for what was put in; then say so, and restore what is shown. */
  const complain = (action, restore = () => {}) => {
    try {
      problem.hidden = true;
      action();
    } catch (error) {
      report(error);
      restore();
    }
  };

  const store = new Store({ ...usual(), ...fromOutside(state) });
  const welcome = make("p", { class: "welcome", hidden: true }, WELCOME);
  const addressed = () => {
    const text = address?.location.hash.slice(1) ?? "";
    return document.getElementById(text) ? "" : text; // a place on the page is no state
  };
  if (address && addressed() === "") {
    Object.assign(store.state, opening());
    welcome.hidden = false;
  } else complain(() => Object.assign(store.state, readAddress(addressed())));

  const given = { complain, report, makeWorker, onresult: (result) => store.set({ result }) };
  const views = {
    watch: new WatchView(store, given),
    drive: new DriveView(store, given),
    draw: new DrawView(store, given),
    runs: new RunsView(store, given),
  };
  const mazes = makeMazeChoice(store);
  const { tabs, panels, showTab } = makeTabs(store, views);
  const root = make(
    "div",
    { class: "playground" },
    make("div", { class: "head" }, tabs, labelled("Maze", mazes)),
    problem,
    welcome,
    ...panels,
  );

  let timer = null;
  const write = () => {
    timer = null;
    try {
      address.history.replaceState(null, "", `#${writeAddress(store.state)}`);
    } catch {
      timer = setTimeout(write, 10 * WRITING); // some browsers allow only so many in a while
    }
  };
  const read = () => {
    if (addressed() === "") return;
    complain(() => {
      store.set({ ...usual(), ...readAddress(addressed()), result: null }, "outside");
      root.scrollIntoView();
    });
  };
  /** A link to where one is already is no change of the address, and still to be followed. */
  const follow = ({ target }) => {
    const link = target.closest?.('a[href^="#"]');
    if (link?.hash === address.location.hash) read();
  };
  store.listen((names, source) => {
    if (names.includes("view")) {
      for (const [name, view] of Object.entries(views)) if (name !== store.state.view) view.pause();
      showTab();
    }
    if (names.some((name) => SETTINGS.includes(name))) {
      problem.hidden = true;
      welcome.hidden = true;
    }
    for (const view of Object.values(views)) view.show(names);
    if (source !== "page") return;
    const changes = toOutside(store.state, names);
    if (Object.keys(changes).length > 0) onChange(changes);
    if (address) {
      clearTimeout(timer);
      timer = setTimeout(write, WRITING);
    }
  });
  address?.addEventListener("hashchange", read);
  address?.addEventListener("click", follow);

  element.replaceChildren(root);
  showTab();
  for (const view of Object.values(views)) view.show(Object.keys(store.state));
  return {
    update: (changes) => store.set(fromOutside(changes), "outside"),
    destroy() {
      clearTimeout(timer);
      address?.removeEventListener("hashchange", read);
      address?.removeEventListener("click", follow);
      for (const view of Object.values(views)) view.destroy();
      root.remove();
    },
  };
}

/** Parts of the state as those outside give them. A result is shown by driving its controller. */
function fromOutside({ maze, controller, seed, result }) {
  const changes = {};
  if (maze !== undefined) changes.maze = known(parseMaze(maze, "drawn"));
  if (seed !== undefined) changes.seed = readSeed(seed);
  if (result !== undefined) changes.result = result;
  if (result) changes.controller = readController(result.controller);
  if (controller !== undefined) changes.controller = readController(controller);
  if (maze !== undefined || seed !== undefined) changes.generation = 0;
  return changes;
}

/** Those parts of the state that those outside know, as they know them. */
function toOutside(state, names) {
  const shown = {
    maze: () => drawingOf(state.maze),
    controller: () => state.controller,
    seed: () => writeSeed(state.seed),
    result: () => state.result,
  };
  return Object.fromEntries(names.filter((name) => name in shown).map((name) => [name, shown[name]()]));
}

function makeMazeChoice(store) {
  const names = Object.keys(MAZES);
  const choice = makeSelect([...names.map((name) => [name, name]), ["drawn", "one of your own"]], (name) => {
    if (name !== "drawn") return store.set({ maze: namedMaze(name), generation: 0 });
    store.set({ view: "draw" });
    show();
  });
  const show = () => (choice.value = isNamed(store.state.maze) ? store.state.maze.name : "drawn");
  store.listen((changed) => changed.includes("maze") && show());
  show();
  return choice;
}

/** Tabs after the pattern of the WAI-ARIA practices: arrow keys move between them. */
function makeTabs(store, views) {
  const ids = Object.fromEntries(TABS.map(([view]) => [view, freshId(view)]));
  const buttons = TABS.map(([view, title]) =>
    make(
      "button",
      {
        type: "button",
        role: "tab",
        id: `${ids[view]}-tab`,
        "aria-controls": ids[view],
        onclick: () => store.set({ view }),
      },
      title,
    ),
  );
  const tabs = make("div", { role: "tablist", "aria-label": "Views" }, ...buttons);
  tabs.addEventListener("keydown", ({ key }) => {
    const now = TABS.findIndex(([view]) => view === store.state.view);
    const next = { ArrowRight: now + 1, ArrowLeft: now - 1, Home: 0, End: TABS.length - 1 }[key];
    if (next === undefined) return;
    const index = (next + TABS.length) % TABS.length;
    store.set({ view: TABS[index][0] });
    buttons[index].focus();
  });
  const panels = TABS.map(([view, , about]) =>
    make(
      "div",
      { role: "tabpanel", id: ids[view], "aria-labelledby": `${ids[view]}-tab` },
      make("p", { class: "about" }, about),
      views[view].element,
    ),
  );
  const showTab = () => {
    TABS.forEach(([view], i) => {
      const isShown = view === store.state.view;
      buttons[i].setAttribute("aria-selected", String(isShown));
      buttons[i].tabIndex = isShown ? 0 : -1;
      panels[i].hidden = !isShown;
    });
  };
  return { tabs, panels, showTab };
}
