/** Decoded pictures whose values can be read; the least recently used leave first, for they are large. */
class Pixels {
  constructor(most) {
    this.most = most;
    this.canvases = new Map();
  }

  /** Red, green and blue of pixel (x, y), 0 to 255; nothing until the picture is decoded, when `ready` is called. */
  value(id, x, y, ready) {
    const canvas = this.canvases.get(id);
    if (canvas === undefined) this.decode(id, ready);
    if (!canvas) return null;
    this.canvases.delete(id);
    this.canvases.set(id, canvas);
    return Array.from(canvas.getImageData(x, y, 1, 1).data.slice(0, 3));
  }

  decode(id, ready) {
    this.canvases.set(id, null);
    const image = new Image();
    image.onload = () => {
      const canvas = document.createElement("canvas");
      canvas.width = image.naturalWidth;
      canvas.height = image.naturalHeight;
      const context = canvas.getContext("2d", { willReadFrequently: true });
      context.drawImage(image, 0, 0);
      this.canvases.set(id, context);
      while (this.canvases.size > this.most) this.canvases.delete(this.canvases.keys().next().value);
      ready();
    };
    image.src = document.getElementById(id).getAttribute("href");
  }
}

const pixels = new Pixels(24);

/**
 * Says which pixel is at (u, v) of `view`, and its value in each of `shown`: pairs of a name and an id. Calls `again` when
 * a picture has been decoded whose value was not known.
 */
function readOut(line, view, u, v, shown, again) {
  // All that are shown must fit, or each would push out another for ever.
  pixels.most = Math.max(pixels.most, shown.length);
  const [px, py] = view.at(u, v);
  const read = ([name, id]) => {
    const { width, height } = sizeOf(id);
    const x = clamp(Math.floor(px * width), 0, width - 1);
    const y = clamp(Math.floor(py * height), 0, height - 1);
    return { name, x, y, value: pixels.value(id, x, y, again) };
  };
  const values = shown.map(read);
  if (values.length === 0) return;
  const piece = (kind, text) => {
    const span = document.createElement("span");
    span.className = kind;
    span.textContent = text;
    return span;
  };
  const said = (value) => (value ? value.join(" ") : "…");
  const pieces = [piece("place", `x ${values[0].x}, y ${values[0].y}`)];
  for (const { name, value } of values) pieces.push(piece("value", `${name} ${said(value)}`));
  if (values.length === 2 && values[0].value && values[1].value) {
    const signed = (n) => (n > 0 ? `+${n}` : String(n));
    const differences = values[1].value.map((n, i) => signed(n - values[0].value[i]));
    pieces.push(piece("difference", `right − left ${differences.join(" ")}`));
  }
  line.replaceChildren(...pieces);
}

