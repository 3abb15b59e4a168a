const clamp = (value, least, most) => Math.min(Math.max(value, least), most);

const MOST_ZOOM = 32;

/** The part of its pictures that a block shows. Everything is in fractions of width and height, so pictures share it. */
class View {
  constructor(changed) {
    this.zoom = 1;
    this.x = 0.5;
    this.y = 0.5;
    this.changed = changed;
  }

  /** The place of the picture that is at (u, v) of the stage. */
  at(u, v) {
    return [this.x + (u - 0.5) / this.zoom, this.y + (v - 0.5) / this.zoom];
  }

  /** Enlarges by `factor`; what is at (u, v) stays there. */
  zoomAt(u, v, factor) {
    const [px, py] = this.at(u, v);
    this.zoom = clamp(this.zoom * factor, 1, MOST_ZOOM);
    // Steps back and forth end at exactly one.
    if (this.zoom < 1.01) this.zoom = 1;
    this.moveTo(px - (u - 0.5) / this.zoom, py - (v - 0.5) / this.zoom);
  }

  pan(du, dv) {
    this.moveTo(this.x - du / this.zoom, this.y - dv / this.zoom);
  }

  reset() {
    this.zoom = 1;
    this.moveTo(0.5, 0.5);
  }

  /** Shows what is around (x, y), as far as there is picture. */
  moveTo(x, y) {
    const half = 0.5 / this.zoom;
    this.x = clamp(x, half, 1 - half);
    this.y = clamp(y, half, 1 - half);
    this.changed();
  }

  /** Shows its part of the picture in `svg`, the pixels as squares where they are enlarged. */
  apply(svg) {
    const { width, height } = sizeOf(pictureOf(svg));
    const [left, top] = this.at(0, 0);
    svg.setAttribute("viewBox", `${left * width} ${top * height} ${width / this.zoom} ${height / this.zoom}`);
    const scale = (svg.clientWidth * devicePixelRatio * this.zoom) / width;
    svg.classList.toggle("enlarged", scale >= 2 || (scale > 1 && this.zoom > 1));
  }
}

/** The id of the picture that `svg` shows. */
const pictureOf = (svg) => svg.firstElementChild.getAttribute("href").slice(1);

const sizeOf = (id) => {
  const image = document.getElementById(id);
  return { width: Number(image.getAttribute("width")), height: Number(image.getAttribute("height")) };
};

