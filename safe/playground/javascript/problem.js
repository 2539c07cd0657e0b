// The message that says what went wrong.

import { make } from "./dom.js";

export class Problem {
  constructor() {
    this.element = make("p", { class: "problem", role: "alert", hidden: true });
  }

  report(error) {
    this.element.textContent = error.message;
    this.element.hidden = false;
    this.element.scrollIntoView({ block: "nearest" });
  }

  clear() {
    this.element.hidden = true;
  }

  /** Do what fails if the reader's entry is wrong. If it does, say so, and restore what is shown. */
  attempt(action, restore = () => {}) {
    try {
      this.clear();
      action();
    } catch (error) {
      this.report(error);
      restore();
    }
  }
}
