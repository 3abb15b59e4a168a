/** Copies the text of a command. Where the browser forbids it, selects it for the reader's own key. */
function makeCopyable(block) {
  const code = block.querySelector("code");
  const button = block.querySelector("button");
  const say = (text) => {
    button.textContent = text;
    setTimeout(() => (button.textContent = "Copy"), 1500);
  };
  const select = () => {
    getSelection().selectAllChildren(code);
    say("Selected");
  };
  button.addEventListener("click", () => {
    if (!navigator.clipboard) return select();
    navigator.clipboard.writeText(code.textContent).then(() => say("Copied"), select);
  });
}

document.documentElement.classList.add("js");
const blocks = new Map();
for (const figure of document.querySelectorAll(".slider")) blocks.set(figure, new Slider(figure));
for (const figure of document.querySelectorAll(".gallery")) blocks.set(figure, new Gallery(figure));
document.querySelectorAll("table.sortable").forEach(makeSortable);
document.querySelectorAll(".plot:has(.chart)").forEach(enliven);
document.querySelectorAll(".command").forEach(makeCopyable);

// Keys are for the block under the pointer, or else the one that has the focus.
document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches("input, select, textarea")) return;
  const figure = document.querySelector(".zooms:hover") ?? document.activeElement?.closest(".zooms");
  if (figure && blocks.get(figure).press(event.key)) event.preventDefault();
});
