// What a row of the verdict table opens to.

function details(cell, columns) {
  const numbers = element("div", { class: "wide" }, rows(cell.rows, columns));
  const made = element("div", { class: "details" },
    element("h3", {}, cell.label),
    command(cell.replay),
    element("div", { class: "plots" }, cell.figures.map((data) => {
      const place = element("figure", { class: "plot small" });
      figure(place, data);
      return place;
    })),
    cell.evidence && evidence(cell.evidence),
    element("details", {}, element("summary", {}, `All ${cell.rows.length} numbers`), numbers));
  reachable(numbers);
  return made;
}

// A command with a button that copies it.
function command(words) {
  const button = element("button", {
    type: "button", onclick: async () => {
      await navigator.clipboard.writeText(words);
      button.textContent = "Copied";
      setTimeout(() => { button.textContent = "Copy"; }, 1500);
    },
  }, "Copy");
  return element("div", { class: "command" }, element("pre", { tabindex: 0 }, words), button);
}

const lamp = (light) => element("span", { class: `lamp ${light}` }, light);

function evidence({ guards, channel, checks, worst }) {
  return element("div", {},
    element("ul", { class: "guard" }, guards.map(([name, light, why]) => element("li", {}, lamp(light), ` guard of ${name}: ${why}`))),
    element("details", {},
      element("summary", {}, `MCNP's ten checks: ${worst}`),
      element("p", { class: "note" }, `Those of ${channel}; they are diagnostics, and decide nothing.`),
      element("ol", { class: "checks" }, checks.map(([light, name, found]) => element("li", {}, lamp(light), ` ${name}: ${found}`)))));
}

const BADGES = { PASS: "pass", FAIL: "fail", INVALID: "fail", INCONCLUSIVE: "open" };

function rows(records, columns) {
  const shown = (value, i) => {
    const badge = columns[i][0] === "verdict" && value;
    return element("td", { class: columns[i][1] ? "n" : null }, badge ? element("span", { class: `badge ${BADGES[value]}` }, value) : value);
  };
  const table = element("table", {},
    element("thead", {}, element("tr", {}, columns.map(([name, isNumber]) => element("th", { class: isNumber ? "n" : null }, name)))),
    element("tbody", {}, records.map((record) => element("tr", {}, record.map(shown)))));
  sortable(table);
  return table;
}
