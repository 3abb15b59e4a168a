/** When the page was scrolled last: a wheel that scrolls past a picture must not begin to zoom it. */
let scrolled = -Infinity;
document.addEventListener("scroll", () => (scrolled = performance.now()), { passive: true });

/** The place of a pointer on `stage`, as fractions. */
function placeOn(stage, event) {
  const box = stage.getBoundingClientRect();
  return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
}

/**
 * Wheel, drag, pinch and double click on `stage` move `view`. `divide(u)` takes drags that move a divider, if there is
 * one; `hover(u, v)` is told where the pointer is, `leave()` that it has gone.
 */
function listen(stage, view, { divide, hover, leave }) {
  const pointers = new Map();
  let isDividing = false;

  stage.addEventListener("wheel", (event) => {
    const isOut = event.deltaY > 0;
    if (event.ctrlKey || event.deltaY === 0 || (isOut && view.zoom === 1) || performance.now() - scrolled < 250) return;
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 100 : event.deltaY / 3;
    view.zoomAt(...placeOn(stage, event), 2 ** (-clamp(lines, -2, 2) / 2));
    hover(...placeOn(stage, event));
  }, { passive: false });

  stage.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    pointers.set(event.pointerId, placeOn(stage, event));
    stage.setPointerCapture(event.pointerId);
    const isHandle = event.target.closest(".divider") !== null;
    isDividing = Boolean(divide) && pointers.size === 1 && (isHandle || view.zoom === 1);
    stage.classList.add("held");
    if (isDividing) divide(placeOn(stage, event)[0]);
    if (isHandle) event.target.focus();
    else event.preventDefault();
  });

  stage.addEventListener("pointermove", (event) => {
    const [u, v] = placeOn(stage, event);
    const before = pointers.get(event.pointerId);
    if (before && isDividing) divide(u);
    else if (before && pointers.size === 1) view.pan(u - before[0], v - before[1]);
    else if (before && pointers.size === 2) pinch(event.pointerId, before, [u, v]);
    if (before) pointers.set(event.pointerId, [u, v]);
    hover(u, v);
  });

  /** Two fingers keep what is under them: the middle of both pans, their distance zooms. */
  function pinch(moved, before, after) {
    const [other] = [...pointers].filter(([id]) => id !== moved).map(([, place]) => place);
    const middle = (place) => [(place[0] + other[0]) / 2, (place[1] + other[1]) / 2];
    const distance = (place) => Math.hypot(place[0] - other[0], place[1] - other[1]) || 1e-3;
    const [from, to] = [middle(before), middle(after)];
    view.pan(to[0] - from[0], to[1] - from[1]);
    view.zoomAt(...to, distance(after) / distance(before));
  }

  const release = (event) => {
    pointers.delete(event.pointerId);
    if (pointers.size > 0) return;
    isDividing = false;
    stage.classList.remove("held");
  };
  stage.addEventListener("pointerup", release);
  stage.addEventListener("pointercancel", release);
  stage.addEventListener("pointerleave", leave);
  stage.addEventListener("dblclick", () => view.reset());
}

/** What sliders and galleries share: one view of all pictures, its buttons and its keys. */
class Block {
  constructor(figure) {
    this.figure = figure;
    this.line = figure.querySelector(".readout");
    this.help = [...this.line.childNodes];
    this.view = new View(() => this.draw());
    this.pointed = null;
    for (const button of figure.querySelectorAll("[data-zoom]")) {
      button.addEventListener("click", () => this.zoom(button.dataset.zoom, 0.5, 0.5));
    }
    for (const stage of figure.querySelectorAll(".stage")) listen(stage, this.view, this.handlers(stage));
    // Sizes decide whether pixels are enlarged.
    new ResizeObserver(() => this.draw()).observe(figure);
  }

  handlers() {
    return { hover: (u, v) => this.hover(u, v), leave: () => this.leave() };
  }

  hover(u, v) {
    this.pointed = [u, v];
    this.read();
  }

  leave() {
    this.pointed = null;
    this.line.replaceChildren(...this.help);
  }

  /** Reads the values under the pointer anew. */
  read() {
    if (this.pointed) readOut(this.line, this.view, ...this.pointed, this.shown(), () => this.read());
  }

  zoom(how, u, v) {
    if (how === "reset") this.view.reset();
    else this.view.zoomAt(u, v, how === "in" ? 2 : 0.5);
  }

  /** Whether `key` means something here. */
  press(key) {
    const zooms = { "+": "in", "=": "in", "-": "out", 0: "reset" };
    if (!Object.hasOwn(zooms, key)) return false;
    this.zoom(zooms[key], ...(this.pointed ?? [0.5, 0.5]));
    return true;
  }

  draw() {
    for (const svg of this.figure.querySelectorAll(".picture")) this.view.apply(svg);
    this.figure.classList.toggle("zoomed", this.view.zoom > 1);
    const zoom = this.view.zoom < 10 ? Math.round(this.view.zoom * 10) / 10 : Math.round(this.view.zoom);
    this.figure.querySelector(".zoom output").textContent = `${zoom}×`;
    this.read();
  }
}

