// A class in the view of many runs: its link, the choice of a seat, and the line of a seat whose runs are over.

import { writeAddress } from "./address.js";
import { outcomeOf, writeLine } from "./class_lines.js";
import { checkedCourse, experimentsOf, firstRunOf, MOST_SEATS } from "./course.js";
import {
  download,
  labelled,
  make,
  makeBlock,
  makeButton,
  makeControls,
  makeCopyField,
  remember,
  remembered,
} from "./dom.js";
import { titleOf } from "./labels.js";
import { listText } from "./text.js";

export class CoursePanel {
  /** page: the window in whose address the class is, or null, without which there are no classes. */
  constructor({ store, problem, page }) {
    this.store = store;
    this.shown = null; // the class and seat that are shown
    this.title = make("h2");
    this.explanation = make("p");
    this.seats = make("fieldset", { class: "seats" });
    this.otherSeat = makeButton("Another seat", () => this.#sit(null));
    this.link = makeCopyField("Link for the class", "Copy the link");
    this.pooled = make("a", {}, "The class’s runs");
    this.line = makeCopyField("Line with your runs", "Copy the line");
    const save = makeButton("Save as a file", () => download(this.file, `${this.text}\n`));
    this.finished = makeBlock(
      make("p", {}, "Your runs are over. Send this line, or the file, to the person who collects them:"),
      this.line.element,
      makeControls(save),
    );
    this.current = make(
      "section",
      { class: "welcome", "aria-label": "Class" },
      this.title,
      this.explanation,
      this.seats,
      makeControls(this.otherSeat, makeButton("Leave the class", () => store.set({ course: null })), this.pooled),
      this.finished,
      make("details", {}, make("summary", {}, "The link of this class"), this.link.element),
    );
    this.begin = makeBeginning(store, problem);
    this.page = page;
  }

  /** Show the class of the state. outcomes: for each algorithm, in `made`, the results of its runs by number. */
  show(outcomes) {
    const { course, runs } = this.store.state;
    this.current.hidden = !course || !this.page;
    this.begin.hidden = Boolean(course) || !this.page;
    if (this.current.hidden) return;
    if (this.shown !== course) this.#showCourse(course, runs);
    const isOver = course.seat !== null && outcomes.length > 0 &&
      outcomes.every(({ made }) => made.filter((result) => result).length === runs);
    this.finished.hidden = !isOver;
    if (!isOver) return;
    this.text = writeLine(course, this.store.state, outcomes.map(({ made }) => made.map(outcomeOf)));
    this.file = `${course.name.replaceAll(/[^\p{L}\p{N}]+/gu, "-")}-seat-${course.seat}.txt`;
    this.line.show(this.text);
  }

  #showCourse(course, runs) {
    const { name, seats, seat } = course, { algorithms, maze } = this.store.state;
    const what = `${listText(algorithms.map(titleOf))} on ${maze.name}`;
    this.shown = course;
    const fragment = `#${writeAddress(this.store.state)}`;
    this.link.show(this.page.location.href.split("#")[0] + fragment);
    this.pooled.href = `class.html${fragment}`;
    this.title.textContent = `Class ${name}` + (seat ? `: seat ${seat} of ${seats}` : "");
    this.seats.hidden = seat !== null;
    this.otherSeat.hidden = seat === null;
    this.explanation.textContent = seat === null
      ? `Which of the ${seats} seats is yours? Each makes ${runs} runs of ${what} which no other seat makes.`
      : `Your runs are ${firstRunOf(seat, runs)} to ${firstRunOf(seat, runs) + runs - 1} of ${what}, ` +
        `and yours alone. All seats together make the runs 0 to ${
          seats * runs - 1
        } of the experiment with this seed, the same ` +
        "that safe.run makes in Python.";
    const buttons = Array.from({ length: seats }, (_, i) => makeButton(`${i + 1}`, () => this.#sit(i + 1)));
    this.seats.replaceChildren(make("legend", {}, "Your seat"), ...(seat === null ? buttons : []));
  }

  #sit(seat) {
    const { course } = this.store.state;
    remember(keyOfSeat(course), seat ?? "");
    this.store.set({ course: { ...course, seat } });
    (seat === null ? this.seats.querySelector("button") : this.otherSeat).focus();
  }
}

/** A class with the seat that this browser took in it before, unless another is known; that it then remembers. */
export function seated(course) {
  if (course.seat !== null) remember(keyOfSeat(course), course.seat);
  const seat = Number(remembered(keyOfSeat(course)) ?? 0);
  return course.seat === null && seat >= 1 && seat <= course.seats ? { ...course, seat } : course;
}

function keyOfSeat({ name, seats }) {
  return `safe: seat in ${name} of ${seats}`;
}

/** Fields that make a class of the settings above. */
function makeBeginning(store, problem) {
  const name = make("input", { type: "text", maxlength: 40, size: 12, autocomplete: "off" });
  const seats = make("input", { type: "number", min: 1, max: MOST_SEATS, value: 30 });
  const begin = () =>
    problem.attempt(() => {
      const course = checkedCourse({ name: name.value.trim(), seats: seats.valueAsNumber });
      experimentsOf(course, store.state);
      store.set({ course });
    });
  return make(
    "details",
    {},
    make("summary", {}, "Share these runs in a class"),
    make(
      "p",
      { class: "note" },
      "Everyone opens the same link, takes a seat, and makes other runs of the same experiment.",
    ),
    makeControls(labelled("Name of the class", name), labelled("Seats", seats), makeButton("Make the link", begin)),
  );
}
