// The viewer's controls; they show the state and change nothing but through v.show and v.set.

const CHANNELS_OF_VIEWER = ["RGB", "R", "G", "B", "luminance"];
const LAYOUTS = { single: "one", four: "four side by side", all: "all side by side" };

const HELP = [
  ["1 … 9, 0", "show a picture"],
  ["[ ]", "previous, next picture"],
  ["R", "the reference, and back"],
  ["E, Shift E", "half a stop brighter, darker"],
  ["V, Shift V", "next, previous view"],
  ["C, Shift C", "next, previous channel"],
  ["G", "one picture, four, all"],
  ["+ −", "zoom; also the wheel, about the pointer, or two fingers"],
  ["F", "the whole picture; also a double click"],
  ["X", "crosshair on or off"],
  ["arrows", "move the crosshair where it is on, else a picture that is zoomed, else flip; with Shift ten times as far"],
];

// A select with its label.
function choice(v, name, label, options) {
  const select = element(
    "select",
    { onchange: (event) => v.set(name, event.target.value) },
    Object.entries(options).map(([value, text]) => element("option", { value }, text)),
  );
  v.controls[name] = select;
  return element("label", {}, element("span", {}, label), select);
}

function button(text, action, attributes = {}) {
  return element("button", { type: "button", onclick: action, ...attributes }, text);
}

function exposureControls(v) {
  const set = (event) => event.target.value !== "" && v.set("exposure", Number(event.target.value));
  const limits = { min: -10, max: 10, step: 0.5 };
  v.controls.slider = element("input", { type: "range", ...limits, "aria-label": "exposure", oninput: set });
  v.controls.number = element("input", { type: "number", ...limits, step: "any", "aria-label": "exposure in stops", onchange: set });
  return element("div", { class: "exposure" }, element("span", {}, "exposure [stops]"), v.controls.slider, v.controls.number);
}

function savePicture(v) {
  const { state } = v;
  const name = state.layout === "single" ? v.items[state.shown].name : state.scene.replace(/[^A-Za-z0-9]+/g, "_");
  v.canvas.toBlob((blob) => save(`${name}_${state.view}.png`, blob));
}

// All that stays; what depends on the scene is filled in by `fillScene`.
function buildControls(v) {
  const c = v.controls;
  c.list = element("div", { class: "list", role: "group", "aria-label": "pictures" });
  c.links = element("span", { class: "links" });
  c.words = element("p", { class: "note" });
  c.readout = element("div", { class: "readout", role: "status", "aria-live": "off" });
  c.crosshair = button("crosshair", () => toggleCrosshair(v));
  const views = Object.fromEntries(Object.entries(VIEWS).map(([key, view]) => [key, view.name]));
  const channels = Object.fromEntries(CHANNELS_OF_VIEWER.map((channel) => [channel, channel]));
  const scenes = Object.fromEntries(v.scenes.map((scene) => [scene, scene]));
  v.canvas = element("canvas", { role: "img", tabindex: 0 });
  v.root.replaceChildren(
    element(
      "div",
      { class: "bar" },
      v.scenes.length > 1 ? choice(v, "scene", "scene", scenes) : null,
      choice(v, "view", "view", views),
      choice(v, "channel", "channel", channels),
      choice(v, "against", "against", {}),
      choice(v, "layout", "pictures", LAYOUTS),
      exposureControls(v),
    ),
    element("div", { class: "stage" }, c.list, element("div", {}, v.canvas, c.readout)),
    element(
      "div",
      { class: "bar" },
      button("−", () => zoomBy(v, Math.SQRT1_2), { "aria-label": "zoom out" }),
      button("+", () => zoomBy(v, Math.SQRT2), { "aria-label": "zoom in" }),
      button("whole picture", () => resetView(v)),
      c.crosshair,
      button("save as PNG", () => savePicture(v)),
      c.links,
    ),
    c.words,
    element(
      "details",
      {},
      element("summary", {}, "Keys, while a part of the viewer has the focus"),
      element("dl", {}, HELP.flatMap(([keys, what]) => [element("dt", {}, keys), element("dd", {}, what)])),
    ),
  );
}

// What depends on the scene: its pictures and what they can be compared with.
function fillScene(v) {
  const { list, against } = v.controls;
  list.replaceChildren(
    ...v.items.map((item, i) => button([element("kbd", {}, item.key), " " + item.short], () => v.show(i))),
  );
  const names = v.items.filter((item) => !item.isReference).map((item) => [item.name, item.short]);
  const options = v.items.some((item) => item.isReference) ? [["reference", "reference"], ...names] : names;
  against.replaceChildren(...options.map(([value, text]) => element("option", { value }, text)));
}

function link(href, text) {
  return element("a", { href }, text);
}

// Makes the controls say what is shown.
function showState(v) {
  const { state, controls: c } = v;
  const item = v.items[state.shown];
  [...c.list.children].forEach((made, i) => made.setAttribute("aria-pressed", i === state.shown));
  for (const name of ["scene", "view", "channel", "against", "layout"]) if (c[name]) c[name].value = state[name];
  c.against.disabled = !VIEWS[state.view].compares;
  for (const input of [c.slider, c.number]) {
    input.value = state.exposure;
    input.disabled = Boolean(VIEWS[state.view].fixed);
  }
  c.crosshair.setAttribute("aria-pressed", Boolean(state.cross));
  const files = item.isReference
    ? []
    : [link(`${item.name}.exr`, "EXR"), link(`${item.name}.png`, "PNG"), item.map ? link(item.name + v.data.map, "difference map") : null];
  c.links.replaceChildren(...files.filter(Boolean).flatMap((file, i) => (i === 0 ? [file] : [" · ", file])));
  c.words.textContent = wordsOf(v, item);
  v.canvas.style.touchAction = state.zoom > 1 ? "none" : "pan-y";
  v.canvas.setAttribute("aria-label", describe(v));
}

// What the view shows, and what must be known of it.
function wordsOf(v, item) {
  const { state } = v;
  const view = viewOf(v, item);
  const against = againstOf(v, item);
  const words = [viewWords(view, state.channel)];
  if (view === "radiance") words.push(`White is a radiance of ${significant(whiteOf(v), 3)} W m⁻² sr⁻¹.`);
  if (VIEWS[state.view].compares && view === "radiance") words.unshift("This is what the others are compared with.");
  if (view === "tiles" && against) {
    const byRows = item.tiles && against.isReference && state.channel !== "luminance";
    if (byRows) words.push(tileWords(item.tiles, v.data.rate));
    else words.push("By the pixels of both.");
  }
  if (VIEWS[view].fixed && against && !against.isReference && item.paired && against.paired) {
    words.push("Both share their random numbers, so that they differ by less than independent ones would.");
  }
  if (VIEWS[view].compares && !against) words.push("There is nothing to compare with: choose another picture.");
  if (item.samples > 0) words.push(`${item.samples} samples a pixel.`);
  if (item.notFinite > 0) words.push(`Magenta: not a finite number (${item.notFinite} pixels).`);
  return words.join(" ");
}

function tileWords({ words, claimed }, rate) {
  const source = claimed ? "the claim on tiles" : "normal distributions, as nothing is claimed of tiles";
  return (
    `${words} Framed: told to be wrong, at most ${100 * rate} % of them falsely, by the procedure of Benjamini and ` +
    `Hochberg (1995) with p-values of ${source}.`
  );
}

// The same for those who cannot see the canvas.
function describe(v) {
  const { state } = v;
  const names = shownItems(v).map((item) => item.short).join("; ");
  const view = VIEWS[state.view];
  const exposure = view.fixed ? "" : `, exposure ${state.exposure} stops`;
  const limit = view.scale ? `, full colour at ${significant(limitOf(v, state.view), 3)}` : "";
  const channel = state.channel === "RGB" ? "" : `, ${state.channel}`;
  const against = view.compares ? ` against ${v.items.find((i) => i.name === state.against)?.short ?? "the reference"}` : "";
  const cross = state.cross ? `, crosshair at x ${state.cross.x}, y ${state.cross.y}` : "";
  return `${state.scene}: ${names}; ${view.name}${channel}${against}${exposure}${limit}, zoom ${state.zoom.toFixed(1)}${cross}`;
}
