/** Pictures side by side that are enlarged together. */
class Gallery extends Block {
  shown() {
    return [...this.figure.querySelectorAll(".picture")].map((svg) => [svg.getAttribute("aria-label"), pictureOf(svg)]);
  }
}

