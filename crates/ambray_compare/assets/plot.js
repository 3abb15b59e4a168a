/** Says at once what a point is, where the page itself can only wait for the browser's tooltip; the legend hides curves. */
function enliven(figure) {
  const tip = document.createElement("div");
  tip.className = "tip";
  tip.hidden = true;
  figure.append(tip);

  const show = (point) => {
    tip.textContent = point.dataset.label;
    tip.hidden = false;
    const mark = point.getBoundingClientRect();
    const box = figure.getBoundingClientRect();
    const middle = mark.left + mark.width / 2 - box.left;
    tip.style.left = `${clamp(middle - tip.offsetWidth / 2, 0, Math.max(box.width - tip.offsetWidth, 0))}px`;
    const above = mark.top - box.top - tip.offsetHeight - 2;
    tip.style.top = `${above > 0 ? above : mark.bottom - box.top + 2}px`;
  };

  for (const point of figure.querySelectorAll(".point")) {
    const title = point.querySelector("title");
    point.dataset.label = title.textContent;
    point.setAttribute("aria-label", title.textContent);
    title.remove();
    point.addEventListener("pointerenter", () => show(point));
    point.addEventListener("pointerleave", () => (tip.hidden = true));
  }

  const curve = (button) => figure.querySelector(`.series[data-series="${button.dataset.series}"]`);
  for (const button of figure.querySelectorAll(".legend button")) {
    const emphasise = (on) => () => {
      figure.querySelector(".chart").classList.toggle("some", on);
      curve(button).classList.toggle("chosen", on);
    };
    button.addEventListener("pointerenter", emphasise(true));
    button.addEventListener("pointerleave", emphasise(false));
    button.addEventListener("click", () => {
      const isShown = button.getAttribute("aria-pressed") !== "true";
      button.setAttribute("aria-pressed", isShown);
      curve(button).classList.toggle("hidden", !isShown);
    });
  }
}

