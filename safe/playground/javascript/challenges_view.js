// Challenges: the list of them, and what the reader has solved, which only this browser knows.

import { writeAddress } from "./address.js";
import { beginningOf, CHALLENGES, isSolved, writeCode } from "./challenges.js";
import { labelled, make, makeBlock, makeButton, makeControls, makeCopyField, remember, remembered } from "./dom.js";

const MEMORY = "safe: challenges solved";

export class ChallengesView {
  constructor({ store }) {
    this.store = store;
    this.solved = recalled(); // by the numbers of challenges, the addresses that solve them
    this.items = CHALLENGES.map((challenge, i) => makeItem(challenge, i + 1, () => this.#open(i + 1)));
    this.name = make("input", {
      type: "text",
      maxlength: 40,
      autocomplete: "off",
      oninput: () => this.#showProgress(),
    });
    this.code = makeCopyField("Code of what you have solved", "Copy the code");
    this.progress = make("p");
    this.banner = make("div", { class: "welcome", hidden: true }); // above all views, while a challenge is open
    this.bannerText = make("p");
    this.verdict = make("p", { role: "status" });
    this.back = makeButton("All challenges", () => store.set({ view: "challenges" }));
    const leave = makeButton("Leave this challenge", () => store.set({ challenge: null }));
    this.banner.append(this.bannerText, this.verdict, makeControls(this.back, leave));
    this.element = makeBlock(
      this.progress,
      make("ol", { class: "challenges" }, ...this.items.map(({ element }) => element)),
      make(
        "p",
        {},
        "To show what you have solved, write your name and send the code. It holds your solutions, so that your teacher can check them.",
      ),
      makeControls(labelled("Your name", this.name)),
      this.code.element,
    );
  }

  show(names) {
    const { state } = this.store, { challenge, view } = state;
    this.banner.hidden = challenge === null || view === "challenges";
    if (challenge === null) return this.#showProgress();
    const { title, question } = CHALLENGES[challenge - 1];
    this.bannerText.textContent = `${challenge}. ${title}. ${question}`;
    if (view !== "challenges") this.#check();
    this.#showProgress();
    if (view === "challenges" && names.includes("view")) this.items[challenge - 1].button.focus();
  }

  pause() {}

  destroy() {}

  #open(challenge) {
    this.store.set({ ...beginningOf(CHALLENGES[challenge - 1]), challenge });
    this.banner.scrollIntoView();
    this.back.focus();
  }

  /** Does the state solve the challenge that is open? */
  #check() {
    const { state } = this.store, { challenge, counted } = state;
    const isCounted = counted && Object.entries(counted.of).every(([name, value]) => state[name] === value);
    if (isSolved(CHALLENGES[challenge - 1], state, isCounted ? counted.outcomes : null)) {
      const view = CHALLENGES[challenge - 1].runs ? "runs" : state.view;
      this.solved[challenge] = writeAddress({ ...state, view, challenge: null });
      remember(MEMORY, JSON.stringify(this.solved));
    }
    const text = challenge in this.solved ? "✓ Solved." : "Not solved yet.";
    if (this.verdict.textContent !== text) this.verdict.textContent = text;
  }

  #showProgress() {
    const count = Object.keys(this.solved).length;
    this.progress.textContent = `Solved: ${count} of ${CHALLENGES.length}.`;
    this.items.forEach(({ mark }, i) => (mark.textContent = i + 1 in this.solved ? " ✓ solved" : ""));
    this.code.element.hidden = count === 0 || this.name.value.trim() === "";
    if (!this.code.element.hidden) this.code.show(writeCode(this.name.value.trim(), this.solved));
  }
}

function makeItem({ title, question, hint, runs }, number, onopen) {
  const mark = make("strong");
  const button = makeButton("Open", onopen, { "aria-label": `Open challenge ${number}: ${title}` });
  const proof = runs ? ` (${runs} runs of each algorithm, from seed 0 on.)` : "";
  const element = make(
    "li",
    {},
    make("strong", {}, title),
    mark,
    make("p", {}, question + proof),
    makeControls(button, make("details", {}, make("summary", {}, "Hint"), make("p", {}, hint))),
  );
  return { element, mark, button };
}

function recalled() {
  try {
    const solved = JSON.parse(remembered(MEMORY) ?? "{}");
    return Object.fromEntries(Object.entries(solved).filter(([number]) => CHALLENGES[number - 1]));
  } catch {
    return {};
  }
}
