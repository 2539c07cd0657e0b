// The tabs of the views, after the pattern of the WAI-ARIA practices: arrow keys move between them.

import { freshId, make } from "./dom.js";

const TABS = [
  { view: "watch", title: "Watch", summary: "Robots walk the maze, and the next generation is bred from the fittest." },
  { view: "drive", title: "Drive", summary: "One robot, by hand: its 16 weights, and where they lead it." },
  { view: "draw", title: "Draw", summary: "A maze of your own, for all the other tabs." },
  {
    view: "runs",
    title: "Many runs",
    summary: "How often does it work, and how many runs does it take to be sure?",
  },
  { view: "challenges", title: "Challenges", summary: "Questions to answer by what you do in the other tabs." },
];

export class Tabs {
  /** views: by name, each with its `element`. */
  constructor(store, views) {
    this.store = store;
    this.tabs = [];
    this.panels = [];
    for (const { view, title, summary } of TABS) {
      const id = freshId(view), onclick = () => store.set({ view });
      const tab = { type: "button", role: "tab", id: `${id}-tab`, "aria-controls": id, onclick };
      const panel = { role: "tabpanel", id, "aria-labelledby": `${id}-tab` };
      this.tabs.push(make("button", tab, title));
      this.panels.push(make("div", panel, make("p", { class: "about" }, summary), views[view].element));
    }
    const onkeydown = ({ key }) => this.#move(key);
    this.list = make("div", { role: "tablist", "aria-label": "Views", onkeydown }, ...this.tabs);
    this.show();
  }

  get #selected() {
    return TABS.findIndex(({ view }) => view === this.store.state.view);
  }

  /** Show the view of the state. */
  show() {
    this.tabs.forEach((tab, i) => {
      const isSelected = i === this.#selected;
      tab.setAttribute("aria-selected", String(isSelected));
      tab.tabIndex = isSelected ? 0 : -1;
      this.panels[i].hidden = !isSelected;
    });
  }

  #move(key) {
    const last = TABS.length - 1, now = this.#selected;
    const next = {
      ArrowRight: now === last ? 0 : now + 1,
      ArrowLeft: now === 0 ? last : now - 1,
      Home: 0,
      End: last,
    }[key];
    if (next === undefined) return;
    this.store.set({ view: TABS[next].view });
    this.tabs[next].focus();
  }
}
