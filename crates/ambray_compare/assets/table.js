/** Sorts the rows of a table by the heading that is clicked: one way, the other way, as they were. */
function makeSortable(table) {
  const body = table.tBodies[0];
  const original = [...body.rows];
  const headings = [...table.tHead.rows[0].cells];

  const valueOf = (row, column) => {
    const cell = row.cells[column];
    if (cell.classList.contains("empty")) return null;
    const { value } = cell.dataset;
    if (value === undefined) return cell.textContent;
    const number = value === "inf" ? Infinity : value === "-inf" ? -Infinity : Number(value);
    if (Number.isNaN(number)) return null;
    return headings[column].dataset.by === "size" ? Math.abs(number) : number;
  };

  const compare = (a, b) => {
    if (typeof a === "number" && typeof b === "number") return a < b ? -1 : a > b ? 1 : 0;
    return String(a).localeCompare(String(b), undefined, { numeric: true });
  };

  const sort = (heading, column) => {
    const first = heading.dataset.first;
    const second = first === "ascending" ? "descending" : "ascending";
    const next = { none: first, [first]: second, [second]: "none" }[heading.ariaSort];
    for (const other of headings) other.ariaSort = other === heading ? next : "none";
    const rows = [...original];
    const sign = next === "descending" ? -1 : 1;
    // What was not measured stays at the end either way.
    const order = (a, b) => (a === null || b === null ? (a === null) - (b === null) : sign * compare(a, b));
    if (next !== "none") rows.sort((a, b) => order(valueOf(a, column), valueOf(b, column)));
    body.append(...rows);
  };

  headings.forEach((heading, column) => {
    heading.querySelector("button").addEventListener("click", () => sort(heading, column));
  });
}

