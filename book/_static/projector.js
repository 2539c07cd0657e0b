// Pages on a projector: one section at a time, in large type, and nothing beside it.
//
// `?projector` in a page's address begins it, and what follows the # is the section. Right, down, space and Page Down
// scroll on and then turn to the next section; left, up, shift + space and Page Up turn back; Home and End lead to the
// first and the last; n shows notes (a dropdown of the class `notes`); Escape leaves a control, and then the projector.

(() => {
  const ONWARDS = ["ArrowRight", "ArrowDown", "PageDown", " "], BACK = ["ArrowLeft", "ArrowUp", "PageUp"];
  const USES_KEYS = 'input, select, textarea, [contenteditable], [role="tab"], [tabindex]:not(.headed)';
  const USES_SPACE = "a, button, summary";
  const MEDIA = ".live, img:not(.live *, .panels *)";
  const SCREENFUL = 0.85; // of a window that one scrolls at once
  const SLACK = 0.05; // of a window, which may be hidden when one turns
  const ENOUGH = 0.4, AMPLE = 0.75; // of a window, for a figure: if less is left than enough, one scrolls anyway

  const root = document.documentElement;
  const headed = ":scope > :is(h1, h2, h3, h4, h5, h6)";
  const article = document.querySelector(".bd-article");
  const sections = [...article.querySelectorAll("section:not(.playground *)")].filter((one) =>
    one.querySelector(headed)
  );
  let place = null; // in sections; null if the page is not projected

  const button = (title, onclick) => {
    const element = document.createElement("button");
    element.type = "button";
    element.className = "btn btn-sm";
    element.textContent = title;
    element.addEventListener("click", onclick);
    return element;
  };
  const count = document.createElement("span");
  const back = button("Back", () => turn(-1)), next = button("Next", () => turn(1));
  const notes = button("Notes", () => showNotes(!root.classList.contains("with-notes")));
  const bar = document.createElement("nav");
  bar.className = "projector-bar";
  bar.setAttribute("aria-label", "Projector");
  bar.append(back, count, next, notes, button("Leave", leave));

  /** The place of the section that the address names, or else of the one that is read. */
  function placeToBegin() {
    const named = sections.indexOf(sectionOf(document.getElementById(decodeURIComponent(location.hash.slice(1)))));
    const begun = sections.filter((one) => one.getBoundingClientRect().top < innerHeight / 2).length - 1;
    return named < 0 ? begun : named;
  }

  function sectionOf(element) {
    return sections.findLast((one) => one.contains(element));
  }

  function setAddress(query) {
    const hash = sections.length > 1 ? `#${sections[place].id}` : location.hash; // the playground's holds its state
    history.replaceState(history.state, "", `${location.pathname}${query}${hash}`);
  }

  function show(number) {
    place = Math.min(Math.max(number, 0), sections.length - 1);
    const shown = sections[place];
    for (const one of sections) {
      one.classList.toggle("projected", one === shown);
      one.classList.toggle("above", one !== shown && one.contains(shown));
      one.classList.toggle("away", !one.contains(shown));
    }
    count.textContent = `${place + 1} / ${sections.length}`;
    back.disabled = place === 0;
    next.disabled = place === sections.length - 1;
    notes.hidden = shown.querySelector(":scope > .notes") === null;
    setAddress("?projector");
    fit();
    scrollTo({ top: 0, behavior: "instant" });
    read(shown);
  }

  /** Move the focus to a section's heading, from where the keyboard and screen readers go on. */
  function read(section) {
    const heading = section.querySelector(headed);
    heading.tabIndex = -1;
    heading.classList.add("headed");
    heading.focus({ preventScroll: true });
  }

  /** Let the figures of the section fill what its text leaves of the window. */
  function fit() {
    const shown = sections[place];
    const media = [...shown.querySelectorAll(MEDIA)].filter((one) => sectionOf(one) === shown);
    for (const one of media) one.style.display = "none";
    const left = innerHeight - article.getBoundingClientRect().bottom - scrollY;
    for (const one of media) one.style.display = "";
    const room = left / media.length < ENOUGH * innerHeight ? AMPLE * innerHeight : left / media.length;
    shown.style.setProperty("--room", `${room}px`);
    for (const figure of media.filter((one) => one.matches(".live"))) {
      figure.style.zoom = "";
      const zoom = Math.min(room / figure.offsetHeight, figure.parentElement.clientWidth / figure.offsetWidth);
      figure.style.zoom = zoom;
    }
  }

  /** Turn to another section, or first scroll what does not fit on the screen. */
  function turn(direction) {
    const hidden = direction > 0 ? root.scrollHeight - scrollY - innerHeight : scrollY;
    if (hidden > SLACK * innerHeight) scrollBy({ top: direction * SCREENFUL * innerHeight, behavior: "instant" });
    else if (sections[place + direction]) show(place + direction);
  }

  function showNotes(isOn) {
    root.classList.toggle("with-notes", isOn);
    notes.setAttribute("aria-pressed", isOn);
    for (const one of document.querySelectorAll("details.notes")) one.open = isOn;
    fit();
  }

  function enter() {
    const number = placeToBegin();
    root.classList.add("projector");
    document.body.append(bar);
    show(number);
  }

  function leave() {
    const shown = sections[place];
    showNotes(false);
    setAddress("");
    place = null;
    root.classList.remove("projector");
    bar.remove();
    for (const one of sections) one.classList.remove("projected", "above", "away");
    for (const figure of document.querySelectorAll(".live")) figure.style.zoom = "";
    shown.scrollIntoView({ behavior: "instant" });
    read(shown);
  }

  function onKey(event) {
    const { key, target } = event;
    if (place === null || event.defaultPrevented || event.ctrlKey || event.altKey || event.metaKey) return;
    if (key === "Escape" && target.closest(`${USES_KEYS}, ${USES_SPACE}`)) read(sections[place]);
    else if (target.closest(USES_KEYS) || (key === " " && target.closest(USES_SPACE))) return;
    else if (key === "Escape") leave();
    else if (BACK.includes(key) || (key === " " && event.shiftKey)) turn(-1);
    else if (ONWARDS.includes(key)) turn(1);
    else if (key === "Home") show(0);
    else if (key === "End") show(sections.length - 1);
    else if (key === "n" && !notes.hidden) showNotes(!root.classList.contains("with-notes"));
    else return;
    event.preventDefault();
  }

  document.addEventListener("keydown", onKey);
  addEventListener("resize", () => place !== null && fit());
  addEventListener("hashchange", () => place !== null && sections.length > 1 && show(placeToBegin()));
  globalThis.project = enter; // for the button above every page
  if (new URLSearchParams(location.search).has("projector")) {
    enter();
    addEventListener("load", () => place !== null && read(sections[place])); // to go to a fragment takes the focus away
  }
})();
