// The transport bar: play, pause and step through generations.

import { checkedInteger, MOST } from "./checks.js";
import { labelled, make, makeButton, makeControls } from "./dom.js";
import { makeStateInput } from "./fields.js";

const SPEEDS = [1, 2, 5, 10, 30, 100, Infinity]; // generations a second

export class Transport {
  /** onplay: called when the reader plays or pauses. onstep: called when the reader asks for one generation. */
  constructor(store, problem, { onplay, onstep }) {
    this.playButton = makeButton("Play", onplay, { class: "primary" });
    this.generation = makeStateInput(store, problem, { type: "number", min: 0, step: 1 }, {
      name: "generation",
      read: () => store.state.generation,
      write: (generation) => store.set({ generation: checkedInteger("generation", generation, 0, MOST) }),
    });
    this.speedText = make("output");
    this.slider = make("input", { type: "range", min: 0, max: SPEEDS.length - 1, step: 1, value: 3 });
    this.slider.addEventListener("input", () => this.#showSpeed());
    this.#showSpeed();
    this.element = makeControls(
      this.playButton,
      makeButton("One generation", onstep, { class: "step" }),
      makeButton("From the start", () => store.set({ generation: 0 })),
      labelled("Generation", this.generation),
      make("label", { class: "field" }, make("span", {}, "Speed"), this.slider, this.speedText),
    );
  }

  /** Generations a second. */
  get speed() {
    return SPEEDS[this.slider.valueAsNumber];
  }

  #showSpeed() {
    this.speedText.value = this.speed === Infinity ? "as fast as it can" : `${this.speed} a second`;
    this.slider.setAttribute("aria-valuetext", this.speedText.value);
  }

  showPlaying(isPlaying) {
    this.playButton.textContent = isPlaying ? "Pause" : "Play";
  }

  showGeneration(generation) {
    this.generation.value = generation;
  }
}
