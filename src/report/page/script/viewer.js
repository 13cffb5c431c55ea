// The image viewer: what it shows is a function of its state; each change draws all of it anew.

async function viewer() {
  const root = document.getElementById("viewer");
  if (!root) return;
  try {
    startViewer(root, await loadPictures());
  } catch (error) {
    root.replaceChildren(element("p", {}, `The pictures cannot be shown here (${error}); they lie beside this page as EXR and PNG files.`));
    console.error(error);
  }
}

function startViewer(root, data) {
  const v = { root, data, scenes: [...new Set(data.pictures.map((p) => p.scene))], controls: {}, cache: new Map() };
  v.state = { view: "radiance", channel: "RGB", layout: "single", exposure: 0, cross: null, pointed: null };
  v.update = () => update(v);
  v.read = (live = "off") => readOut(v, live);
  v.show = (index) => {
    if (!v.items[v.state.shown].isReference) v.state.before = v.state.shown;
    v.state.shown = index;
    v.update();
    v.read();
  };
  v.set = (name, value) => {
    if (name === "scene") return enterScene(v, value);
    v.state[name] = name === "exposure" ? Math.min(Math.max(value, -10), 10) : value;
    v.update();
    v.read();
  };
  // for the console and for tests: the values behind a pixel of a picture, by its name or its number on the page
  root.pixel = (which, x, y) => pixelOf(v, which, x, y);
  buildControls(v);
  listenToPointers(v);
  root.addEventListener("keydown", (event) => onKey(v, event));
  enterScene(v, v.scenes[0]);
  new ResizeObserver(() => draw(v)).observe(v.canvas);
  new MutationObserver(() => draw(v)).observe(document.documentElement, { attributeFilter: ["data-theme", "class"] });
  for (const media of ["(prefers-color-scheme: dark)", "print"]) matchMedia(media).addEventListener("change", () => draw(v));
  document.fonts?.ready.then(() => draw(v));
}

// The pictures of a scene and the references that they have.
function itemsOf(data, scene) {
  const pictures = data.pictures.filter((picture) => picture.scene === scene);
  const used = [...new Set(pictures.map((picture) => picture.reference).filter((r) => r !== null))];
  const items = pictures.map((picture, i) => ({ ...picture, key: i < 10 ? String((i + 1) % 10) : "" }));
  const references = used.map((reference, i) => {
    const name = i === 0 ? "reference" : `reference-${i + 1}`;
    return { name, short: name, key: "R", isReference: true, reference, raster: data.references[reference] };
  });
  return [...items, ...references].map((item) => ({ ...item, notFinite: countNotFinite(item.raster) }));
}

function countNotFinite({ mean: [r, g, b] }) {
  let count = 0;
  for (let i = 0; i < r.length; i++) count += !Number.isFinite(r[i] + g[i] + b[i]);
  return count;
}

function enterScene(v, scene) {
  v.items = itemsOf(v.data, scene);
  const { width, height } = v.items[0];
  v.frame = { width, height };
  const against = v.items.some((item) => item.isReference) ? "reference" : v.items[0].name;
  const at = { zoom: 1, x: width / 2, y: height / 2, cross: null, pointed: null };
  Object.assign(v.state, { scene, against, shown: 0, before: 0, ...at });
  fillScene(v);
  v.update();
  v.read();
}

function update(v) {
  const { state, root } = v;
  draw(v);
  prepare(v);
  showState(v);
  Object.assign(root.dataset, {
    scene: state.scene,
    shown: v.items[state.shown].name,
    index: state.shown,
    view: state.view,
    channel: state.channel,
    against: state.against,
    layout: state.layout,
    exposure: state.exposure,
    zoom: state.zoom,
  });
}

function pixelOf(v, which, x, y) {
  const named = (item) => item.name === which;
  const raster = (v.data.pictures[which] ?? v.data.pictures.find(named) ?? v.items.find(named))?.raster;
  if (!raster || !(x >= 0 && y >= 0 && x < raster.width && y < raster.height)) return null;
  const i = y * raster.width + x;
  return { mean: raster.mean.map((m) => m[i]), std_error: raster.error.map((e) => e[i]) };
}

// Writes the values under the pointer, or under the crosshair.
function readOut(v, live) {
  const { state, controls } = v;
  const at = state.pointed ?? (state.cross && { ...state.cross, item: v.items[state.shown] });
  controls.readout.setAttribute("aria-live", live);
  controls.readout.replaceChildren(...(at ? readings(v, at) : [element("p", { class: "note" }, "Point at a pixel for its values.")]));
}

function readings(v, { x, y, item }) {
  const own = item.raster;
  // a reference may have fewer pixels than the picture that it stands beside
  const place = (raster) => {
    const [column, row] = [Math.floor((x * raster.width) / v.frame.width), Math.floor((y * raster.height) / v.frame.height)];
    return row * raster.width + column;
  };
  const against = againstOf(v, item);
  const pair = against && against !== item ? compare(own, against.raster) : null;
  const block = pair && pair.width < own.width ? `${own.width / pair.width} × ${own.height / pair.height}` : null;
  const value = (raster) => (c) => {
    const i = place(raster);
    return element("td", {}, significant(raster.mean[c][i], 6) + " ", element("span", {}, "± " + significant(raster.error[c][i], 2)));
  };
  const z = (c) => {
    const i = place(pair.ours);
    const difference = pair.ours.mean[c][i] - pair.theirs.mean[c][i];
    return element("td", {}, significant(inErrors(difference, pair.ours.error[c][i], pair.theirs.error[c][i]), 3));
  };
  const row = (name, cell) => element("tr", {}, element("th", { scope: "row" }, name), [0, 1, 2].map(cell));
  const heads = ["R", "G", "B"].map((name) => element("th", { scope: "col" }, name));
  return [
    element(
      "table",
      {},
      element("caption", {}, element("b", {}, `x ${x}, y ${y}`), ` ${item.short}`),
      element("thead", {}, element("tr", {}, element("td"), heads)),
      element(
        "tbody",
        {},
        row("pixel", value(own)),
        block ? row(`block of ${block}`, value(pair.ours)) : null,
        pair ? [row(against.short, value(pair.theirs)), row("z", z)] : null,
      ),
    ),
  ];
}
