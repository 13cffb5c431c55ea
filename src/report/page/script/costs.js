// Errors at equal samples, rays and time, scene by scene, and speed-ups over a baseline that the reader chooses.

const Z = 3.2905; // 99.9 %, two-sided

const CHOICES = { "all channels": [0, 1, 2], R: [0], G: [1], B: [2] };

function costs(section, scenes, seconds) {
  for (const { scene, cells } of scenes) {
    const choose = (label, options) => {
      const select = element("select", { onchange: () => draw() }, options.map((words, i) => element("option", { value: i }, words)));
      return [select, element("label", {}, `${label} `, select)];
    };
    const [channel, channelLabel] = choose("channels", Object.keys(CHOICES));
    const [baseline, baselineLabel] = choose("baseline", cells.map((cell) => `${cell.estimator}, ${cell.rule}`));
    const priced = () => cells.map((cell) => price(cell, Object.values(CHOICES)[channel.value], seconds));
    baseline.value = Math.max(0, priced().findIndex((cell) => cell.noise > 0 && cell.floor === 0));
    const place = element("div", { class: "wide" });
    const draw = () => {
      const all = priced();
      place.replaceChildren(costTable(all, all[baseline.value]));
    };
    section.append(element("h3", {}, scene), element("div", { class: "tools" }, baselineLabel, channelLabel), place);
    draw();
  }
}

// A cell's error and what a sample takes; the error of several channels is the mean of theirs, NaN where one is not known.
function price(cell, channels, seconds) {
  const lit = channels.map((c) => cell.channels[c]).filter(Boolean);
  const mean = (f) => (lit.length ? lit.reduce((sum, one) => sum + f(one), 0) / lit.length : NaN);
  const noise = mean((one) => one.noise ?? NaN);
  // channels share their paths: errors add up, at worst
  const spread = mean((one) => (one.noise ? one.noise * (one.error ?? NaN) : 0)) / noise;
  const time = seconds?.[cell.cell] ? seconds[cell.cell] / cell.samples : NaN;
  return { ...cell, noise, spread: noise ? spread : 0, floor: mean((one) => one.floor), time, one: 1 };
}

function costTable(cells, base) {
  const budgets = [["samples", "one", "samples"], ["rays", "rays", "rays"], ["time", "time", "s"]]
    .map(([what, key, unit]) => ({ what, key, unit, amount: base.samples * base[key] }))
    .filter(({ amount }) => Number.isFinite(amount));
  const after = (cell, { key, amount }) => (cell.noise * cell[key]) / amount + cell.floor;
  const isPicture = cells.some((cell) => cell.measured);
  const row = (cell) => element("tr", { class: cell === base ? "base" : null },
    element("td", {}, cell.estimator), element("td", {}, cell.rule),
    budgets.flatMap((budget) => [
      number(after(cell, budget), known(after(cell, budget))),
      number(after(base, budget) / after(cell, budget), speedUp(after(base, budget) / after(cell, budget), cell, base)),
    ]),
    number(cell.floor, cell.floor ? `${told(100 * Math.sqrt(cell.floor), 3)} %` : ""),
    isPicture ? pictured(cell.measured) : []);
  const numeric = [
    ...budgets.flatMap(({ what, key, amount, unit }) => [`relMSE, equal ${what} (${key === "one" ? amount : told(amount, 3)} ${unit})`, "speed-up"]),
    "bias that stays", ...(isPicture ? ["relMSE of the picture", "FLIP of the picture"] : []),
  ];
  const table = element("table", {},
    element("thead", {}, element("tr", {}, ["estimator", "rule"].map((head) => element("th", {}, head)),
      numeric.map((head) => element("th", { class: "n" }, head)))),
    element("tbody", {}, cells.map(row)));
  sortable(table);
  return table;
}

// A cell of the table, which sorts by its value.
const number = (value, words) => element("td", { class: "n", "data-sort": value }, words);

const known = (v) => (Number.isFinite(v) ? told(v, 3) : "not known");

// relMSE with its standard error, and FLIP.
function pictured(measured) {
  if (!measured) return [number(NaN, "not known"), number(NaN, "not known")];
  const { rel_mse: relMse, error, flip } = measured;
  return [number(relMse, told(relMse, 3) + (error === null ? "" : ` ± ${told(error, 2)}`)), number(flip, told(flip, 3))];
}

// "3.1 (2.9 to 3.3)": the logarithm of a ratio of independent variances is nearly normal.
function speedUp(ratio, cell, base) {
  if (cell === base) return "baseline";
  if (!Number.isFinite(ratio)) return "not known";
  if (cell.floor || base.floor) return `${told(ratio, 3)} (biased)`;
  const reach = Math.exp(Z * Math.hypot(cell.spread, base.spread));
  return Number.isFinite(reach) ? `${told(ratio, 3)} (${told(ratio / reach, 3)} to ${told(ratio * reach, 3)})` : told(ratio, 3);
}
