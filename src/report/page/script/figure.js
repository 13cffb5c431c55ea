// A figure: panels with one legend, and what can be done with them.

// Fills a <figure>: `name` is that of its files beside the page, if there are any.
function figure(place, data, name) {
  const state = { hidden: new Set(), log: data.panels.map((p) => ({ logX: p.x.log, logY: p.y.log })) };
  const panels = element("div", { class: "panels" });
  const status = element("div", { class: "readout", role: "status" }, " ");
  const table = element("div", { class: "wide", hidden: true });
  let room = 0;
  const draw = () => {
    panels.replaceChildren(...data.panels.map((panel, i) => drawnPanel(panel, i, { room, state, data, status, draw })));
    hide(panels, state.hidden);
  };
  const toggle = (label, button) => {
    if (!state.hidden.delete(label)) state.hidden.add(label);
    button.setAttribute("aria-pressed", String(!state.hidden.has(label)));
    hide(panels, state.hidden);
  };
  const asTable = element("button", {
    type: "button", "aria-expanded": "false", onclick: () => {
      if (!table.firstChild) table.append(numbers(data));
      table.hidden = !table.hidden;
      asTable.setAttribute("aria-expanded", String(!table.hidden));
    },
  }, "Data");
  const file = name ?? "figure";
  place.append(
    element("figcaption", {}, data.title), legend(data, toggle), panels, status,
    element("div", { class: "tools" },
      element("button", { type: "button", onclick: () => saveSvg(panels, file) }, "Save SVG"),
      element("button", { type: "button", onclick: () => savePng(panels, file) }, "Save PNG"),
      asTable,
      name && element("span", { class: "files" }, "files: ",
        ["svg", "png", "csv"].flatMap((kind) => [element("a", { href: `${name}.${kind}` }, kind.toUpperCase()), " "]))),
    table);
  place.setAttribute("aria-label", data.alt || data.title);
  reachable(table);
  // once it has a place, and whenever that changes
  const fit = () => {
    if (place.clientWidth === 0 || place.clientWidth === room) return;
    room = place.clientWidth;
    draw();
  };
  fit();
  new ResizeObserver(fit).observe(place);
}

// Whether all that is drawn along an axis has a logarithm.
function positive(panel, axis) {
  const of = axis === "x" ? (p) => p.slice(0, 1) : (p) => p.slice(1);
  return panel.series.every((series) => series.points.flatMap(of).map(real).every((v) => !(v <= 0)));
}

// One panel with the choices of its axes.
function drawnPanel(panel, i, { room, state, data, status, draw }) {
  const columns = Math.min(data.columns, data.panels.length);
  // letters keep their size on narrow screens: the panel gets narrower instead
  const width = Math.min(columns === 1 ? 760 : columns === 2 ? 580 : 410, Math.max(300, room));
  const { svg, hits } = chart(panel, { ...state.log[i], width });
  svg.style.width = `${width}px`;
  readout(svg, hits, status, state);
  const choice = (axis, key) => {
    const isLog = state.log[i][key];
    if (axis.categories.length || (!isLog && !positive(panel, key === "logX" ? "x" : "y"))) return null;
    const box = element("input", { type: "checkbox", onchange: () => { state.log[i][key] = box.checked; draw(); } });
    box.checked = isLog;
    const which = panel.lying ? "" : key === "logX" ? " x" : " y";
    return element("label", {}, box, ` log${which}`);
  };
  return element("div", { class: "panel" }, svg, element("div", { class: "axes" }, choice(panel.x, "logX"), choice(panel.y, "logY")));
}

// Every label once, as a button that shows and hides what has it.
function legend(data, toggle) {
  const entries = new Map();
  for (const panel of data.panels) {
    for (const one of [...panel.series, ...panel.regions, ...panel.marks]) {
      if (one.label && !entries.has(one.label)) entries.set(one.label, one);
    }
  }
  const entry = (one) => {
    const swatch = element("span", { class: `swatch ${one.style ?? "area"}`, style: `color:${one.colour === "#000000" ? "inherit" : one.colour}` });
    const button = element("button", { type: "button", "aria-pressed": "true", onclick: () => toggle(one.label, button) }, swatch, one.label);
    return button;
  };
  return element("div", { class: "legend", role: "group", "aria-label": "series" }, [...entries.values()].map(entry));
}

function hide(panels, hidden) {
  for (const part of panels.querySelectorAll("[data-series]")) {
    part.style.display = hidden.has(part.dataset.series) ? "none" : "";
  }
}

// The value under the pointer, or of the point that the arrow keys have reached.
function readout(svg, hits, status, state) {
  const ring = element("svg:circle", { r: 7, fill: "none", stroke: "currentColor", "stroke-width": 1.5, visibility: "hidden" });
  svg.append(ring);
  let reached = -1;
  const seen = () => hits.filter((hit) => !state.hidden.has(hit.series));
  const show = (hit) => {
    ring.setAttribute("visibility", hit ? "visible" : "hidden");
    if (hit) { ring.setAttribute("cx", hit.x); ring.setAttribute("cy", hit.y); }
    status.textContent = hit ? hit.words : " ";
  };
  svg.addEventListener("pointermove", (event) => {
    const box = svg.getBoundingClientRect();
    const scale = svg.viewBox.baseVal.width / box.width;
    const [x, y] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    // curves have points everywhere, and would hide what lies on them
    const far = (hit) => Math.hypot(hit.x - x, hit.y - y) + (hit.isMark ? 0 : 8);
    const nearest = seen().reduce((best, hit) => (!best || far(hit) < far(best) ? hit : best), null);
    show(nearest && far(nearest) < 30 ? nearest : null);
  });
  svg.addEventListener("pointerleave", () => show(null));
  svg.addEventListener("blur", () => show(null));
  svg.addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
    const all = seen();
    if (!step || !all.length) return;
    event.preventDefault();
    reached = (reached + step + all.length) % all.length;
    show(all[reached]);
  });
}

// All points as a table, for those who want numbers or cannot see the plot.
function numbers(data) {
  const rows = data.panels.flatMap((panel) => panel.series.flatMap((series) => series.points.map((p) => {
    const [x, y, low, high] = p.map(real);
    const where = panel.x.categories[x] ?? told(x, 6);
    return [panel.title, series.label, where, told(y, 6), low === undefined ? "" : told(low, 6), high === undefined ? "" : told(high, 6)];
  })));
  const names = ["panel", "series", "x", "y", "low", "high"];
  return element("table", {},
    element("thead", {}, element("tr", {}, names.map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, rows.map((row) => element("tr", {}, row.map((v) => element("td", {}, v))))));
}

// The panels one below the other, in ink on paper whatever the page's style.
function sheet(panels) {
  const shown = [...panels.querySelectorAll("svg.chart")];
  let height = 0;
  const parts = shown.map((svg) => {
    const copy = svg.cloneNode(true);
    const { width, height: tall } = svg.viewBox.baseVal;
    for (const [key, value] of Object.entries({ x: 0, y: height, width, height: tall })) copy.setAttribute(key, value);
    copy.removeAttribute("style");
    height += tall + 10;
    return copy;
  });
  const width = Math.max(...shown.map((svg) => svg.viewBox.baseVal.width));
  return element("svg:svg", {
    xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${height}`, width, height,
    style: "color:#1d2327;background:#fff;font-family:'DejaVu Sans',Verdana,sans-serif",
  }, element("svg:rect", { width, height, fill: "#fff" }), parts);
}

const svgText = (panels) => new XMLSerializer().serializeToString(sheet(panels));

function saveSvg(panels, name) {
  save(`${name}.svg`, svgText(panels), "image/svg+xml");
}

async function savePng(panels, name) {
  const picture = new Image();
  picture.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText(panels))}`;
  await picture.decode();
  const canvas = element("canvas", { width: 2 * picture.width, height: 2 * picture.height });
  canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
  canvas.toBlob((blob) => save(`${name}.png`, blob));
}
