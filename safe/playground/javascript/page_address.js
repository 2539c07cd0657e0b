// The state in the address of a page, behind the #.

import { writeAddress } from "./address.js";

const WRITING_DELAY = 250; // milliseconds after the last change until it is in the address
const RETRY_DELAY = 2500; // some browsers allow only so many changes of an address in a while

export class PageAddress {
  /** onread: called with the text of the address when the reader has followed a link to a state. */
  constructor(page, onread) {
    this.page = page;
    this.timer = null;
    this.read = () => {
      if (this.text !== "") onread(this.text);
    };
    // a link to the address that the page has does not change it, and still asks for its state
    this.follow = ({ target }) => {
      const link = target.closest?.('a[href^="#"]');
      if (link?.hash === page.location.hash) this.read();
    };
    page.addEventListener("hashchange", this.read);
    page.addEventListener("click", this.follow);
  }

  /** The text of a state; empty if the address names none, or a place on the page. */
  get text() {
    const text = this.page.location.hash.slice(1);
    return document.getElementById(text) ? "" : text;
  }

  /** Put the state into the address, as it is when nothing has changed for a while. */
  write(state, delay = WRITING_DELAY) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      try {
        this.page.history.replaceState(null, "", `#${writeAddress(state)}`);
      } catch {
        this.write(state, RETRY_DELAY);
      }
    }, delay);
  }

  destroy() {
    clearTimeout(this.timer);
    this.page.removeEventListener("hashchange", this.read);
    this.page.removeEventListener("click", this.follow);
  }
}
