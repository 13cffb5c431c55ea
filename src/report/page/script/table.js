// Tables that sort, and the verdict table, which also filters and opens.

// What a cell sorts by: what it says of itself, or its largest number, or its text.
function sortKey(cell) {
  if (cell?.dataset.sort) return Number(cell.dataset.sort);
  const words = cell?.textContent.trim() ?? "";
  if (!cell?.classList.contains("n")) return words.toLowerCase();
  const found = words.match(/[-+−]?\d[\d.,]*(e[-+]?\d+)?/gi) ?? [];
  const values = found.map((text) => Math.abs(Number(text.replace("−", "-").replaceAll(",", ""))));
  return values.length ? Math.max(...values) : NaN;
}

// Numbers before texts and emptiness last, whichever the direction.
function inOrder(a, b, direction) {
  const missing = (v) => v === "" || Number.isNaN(v);
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  if (typeof a === "number" && typeof b === "number") return direction * (a - b);
  return direction * String(a).localeCompare(String(b), "en", { numeric: true });
}

// Makes the headings of a table buttons that sort it; rows that belong to the row above move with it.
function sortable(table) {
  const headings = [...table.tHead.rows[0].cells];
  const order = [...table.tBodies[0].rows];
  headings.forEach((heading, column) => {
    if (!heading.textContent) return;
    const button = element("button", { type: "button", class: "sort" }, ...heading.childNodes);
    heading.scope = "col";
    heading.append(button);
    button.addEventListener("click", () => {
      const next = { none: "ascending", ascending: "descending", descending: "none" };
      const now = next[heading.getAttribute("aria-sort") ?? "none"];
      headings.forEach((other) => other.removeAttribute("aria-sort"));
      if (now !== "none") heading.setAttribute("aria-sort", now);
      const body = table.tBodies[0];
      const followers = new Map([...body.rows].filter((row) => row.opens).map((row) => [row, row.opens]));
      const rows = [...body.rows].filter((row) => !row.classList.contains("opened"));
      if (now === "none") rows.sort((a, b) => order.indexOf(a) - order.indexOf(b));
      else {
        const keys = new Map(rows.map((row) => [row, sortKey(row.cells[column])]));
        rows.sort((a, b) => inOrder(keys.get(a), keys.get(b), now === "ascending" ? 1 : -1));
      }
      body.append(...rows.flatMap((row) => (followers.has(row) ? [row, followers.get(row)] : [row])));
    });
  });
}

// Shows the rows that have every word of a text, and one of the verdicts that are switched on.
function filterable(table) {
  const rows = () => [...table.tBodies[0].rows].filter((row) => !row.classList.contains("opened"));
  const verdict = (row) => row.querySelector(".badge")?.textContent.trim() ?? "";
  const kinds = [...new Set(rows().map(verdict))];
  const off = new Set();
  const input = element("input", { type: "search", placeholder: "scene, estimator, rule …", "aria-label": "filter the cells" });
  const count = element("span", { class: "count", role: "status" });
  const texts = new Map(rows().map((row) => [row, row.textContent.toLowerCase()]));
  const apply = () => {
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows()) {
      const is = !off.has(verdict(row)) && words.every((word) => texts.get(row).includes(word));
      row.hidden = !is;
      if (row.opens) row.opens.hidden = !is || !row.isOpen;
      shown += is;
    }
    count.textContent = `${shown} of ${texts.size} cells`;
  };
  input.addEventListener("input", apply);
  const choice = (kind) => {
    const box = element("input", { type: "checkbox", onchange: () => { box.checked ? off.delete(kind) : off.add(kind); apply(); } });
    box.checked = true;
    return element("label", {}, box, ` ${kind === "–" ? "no verdict" : kind}`);
  };
  table.parentElement.before(element("div", { class: "tools filter" }, input, kinds.length > 1 ? kinds.map(choice) : [], count));
  apply();
}

// Gives each row of the verdict table a button that opens what is known of its cell.
function openable(table, data) {
  table.tHead.rows[0].prepend(element("td"));
  for (const row of [...table.tBodies[0].rows]) {
    const cell = data.cells.find((one) => one.cell === Number(row.dataset.cell));
    const button = element("button", { type: "button", class: "open", "aria-expanded": "false", "aria-label": `open ${cell.label}` }, "▸");
    row.prepend(element("td", {}, button));
    row.isOpen = false;
    button.addEventListener("click", () => {
      if (!row.opens) {
        row.opens = element("tr", { class: "opened" }, element("td", { colspan: row.cells.length }, details(cell, data.columns)));
        row.after(row.opens);
      }
      row.isOpen = !row.isOpen;
      row.opens.hidden = !row.isOpen;
      button.setAttribute("aria-expanded", String(row.isOpen));
      button.textContent = row.isOpen ? "▾" : "▸";
    });
  }
}
