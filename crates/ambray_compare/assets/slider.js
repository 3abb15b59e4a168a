/** Two pictures over each other with a divider. */
class Slider extends Block {
  constructor(figure) {
    super(figure);
    this.stage = figure.querySelector(".stage");
    this.divider = figure.querySelector(".divider");
    this.selects = [...figure.querySelectorAll("select")];
    for (const select of this.selects) select.addEventListener("change", () => this.show(select));
    this.divider.addEventListener("keydown", (event) => this.moveBy(event));
    // Browsers may remember what was chosen before the page was loaded again.
    for (const select of this.selects) this.show(select);
    this.divide(0.5);
  }

  handlers() {
    return { ...super.handlers(), divide: (u) => this.divide(u) };
  }

  /** Puts the divider at a fraction of the width. */
  divide(u) {
    this.at = clamp(u, 0, 1);
    const percent = Math.round(this.at * 1000) / 10;
    this.stage.style.setProperty("--at", `${percent}%`);
    this.divider.setAttribute("aria-valuenow", Math.round(percent));
    this.divider.setAttribute("aria-valuetext", `${Math.round(percent)} %`);
  }

  moveBy(event) {
    const step = event.shiftKey ? 0.1 : 0.01;
    const targets = {
      ArrowLeft: this.at - step, ArrowDown: this.at - step, ArrowRight: this.at + step, ArrowUp: this.at + step,
      PageDown: this.at - 0.1, PageUp: this.at + 0.1, Home: 0, End: 1,
    };
    if (!Object.hasOwn(targets, event.key) || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    this.divide(targets[event.key]);
  }

  /** Shows what `select` says on its side. */
  show(select) {
    const side = select.dataset.side;
    const option = select.selectedOptions[0];
    const svg = this.figure.querySelector(`.picture.${side}`);
    svg.firstElementChild.setAttribute("href", `#${option.value}`);
    svg.setAttribute("aria-label", option.dataset.name);
    this.figure.querySelector(`.tag.${side}`).textContent = option.dataset.name;
    const caption = this.figure.querySelector(`.caption.${side}`);
    caption.querySelector("b").textContent = option.dataset.name;
    caption.querySelector("span").textContent = option.dataset.caption && ` – ${option.dataset.caption}`;
    this.draw();
  }

  choose(select, index) {
    if (index >= select.options.length) return;
    select.selectedIndex = index;
    this.show(select);
  }

  press(key) {
    const [left, right] = this.selects;
    if (/^[1-9]$/.test(key)) {
      const isRight = this.pointed !== null && this.pointed[0] > this.at;
      this.choose(isRight ? right : left, Number(key) - 1);
      return true;
    }
    if (key.toLowerCase() === "x") {
      const index = left.selectedIndex;
      this.choose(left, right.selectedIndex);
      this.choose(right, index);
      return true;
    }
    return super.press(key);
  }

  shown() {
    return this.selects.map((select) => [select.selectedOptions[0].dataset.name, select.value]);
  }
}

