// Pointer, wheel and keys.

// Zooms by a factor about a place of the screen; about the middle where none is given.
function zoomBy(v, factor, screen) {
  const at = screen && fromScreen(v, screen.x, screen.y);
  const before = v.state.zoom;
  v.state.zoom = before * factor;
  settle(v);
  if (at) {
    const kept = before / v.state.zoom;
    v.state.x = at.x + (v.state.x - at.x) * kept;
    v.state.y = at.y + (v.state.y - at.y) * kept;
  }
  v.update();
}

function resetView(v) {
  Object.assign(v.state, { zoom: 1, x: v.frame.width / 2, y: v.frame.height / 2 });
  v.update();
}

function panBy(v, dx, dy) {
  v.state.x -= dx / v.scale;
  v.state.y -= dy / v.scale;
  v.update();
}

function screenPlace(v, event) {
  const box = v.canvas.getBoundingClientRect();
  return { x: event.clientX - box.left, y: event.clientY - box.top };
}

// Remembers what is under the pointer; a step of the crosshair says it instead.
function pointAt(v, screen) {
  const at = fromScreen(v, screen.x, screen.y);
  const inside = at && at.x >= 0 && at.y >= 0 && at.x < v.frame.width && at.y < v.frame.height;
  v.state.pointed = inside ? { x: Math.floor(at.x), y: Math.floor(at.y), item: at.pane.item } : null;
  v.read();
}

function listenToPointers(v) {
  const { canvas } = v;
  const down = new Map();
  const spread = () => {
    const [a, b] = [...down.values()];
    return { length: Math.hypot(a.x - b.x, a.y - b.y), x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
  };
  canvas.addEventListener("pointerdown", (event) => {
    down.set(event.pointerId, screenPlace(v, event));
    canvas.setPointerCapture(event.pointerId);
    pointAt(v, screenPlace(v, event));
  });
  canvas.addEventListener("pointermove", (event) => {
    const place = screenPlace(v, event);
    const last = down.get(event.pointerId);
    if (last && down.size === 2) {
      const before = spread();
      down.set(event.pointerId, place);
      const after = spread();
      zoomBy(v, after.length / Math.max(before.length, 1), after);
      panBy(v, after.x - before.x, after.y - before.y);
    } else if (last) {
      down.set(event.pointerId, place);
      panBy(v, place.x - last.x, place.y - last.y);
    }
    pointAt(v, place);
  });
  const up = (event) => down.delete(event.pointerId);
  canvas.addEventListener("pointerup", up);
  canvas.addEventListener("pointercancel", up);
  canvas.addEventListener("pointerleave", () => {
    v.state.pointed = null;
    v.read();
  });
  canvas.addEventListener("dblclick", () => resetView(v));
  canvas.addEventListener(
    "wheel",
    (event) => {
      // where there is nothing to zoom out of, the page scrolls
      if (event.deltaY === 0 || (event.deltaY > 0 && v.state.zoom <= 1)) return;
      event.preventDefault();
      const lines = event.deltaMode === 1 ? 16 : 1;
      zoomBy(v, 2 ** (-event.deltaY * lines * 0.0025), screenPlace(v, event));
      pointAt(v, screenPlace(v, event));
    },
    { passive: false },
  );
}

// Moves the crosshair, and the picture where it would leave the pane.
function moveCrosshair(v, dx, dy) {
  const { state, frame } = v;
  const within = (at, length) => Math.min(Math.max(at, 0), length - 1);
  state.cross = { x: within(state.cross.x + dx, frame.width), y: within(state.cross.y + dy, frame.height) };
  const pane = v.panes[0];
  const follow = (centre, at, room) => {
    const half = Math.max(room / v.scale / 2 - 1, 0.5);
    return Math.min(Math.max(centre, at + 0.5 - half), at + 0.5 + half);
  };
  state.x = follow(state.x, state.cross.x, pane.w);
  state.y = follow(state.y, state.cross.y, pane.h);
  v.update();
  v.read("polite");
}

function toggleCrosshair(v) {
  const { state } = v;
  state.cross = state.cross ? null : { x: Math.floor(state.x), y: Math.floor(state.y) };
  v.update();
  v.read("polite");
}

// What an arrow key does: it moves the crosshair, or a picture that is larger than its pane, or flips.
function arrow(v, dx, dy, step) {
  if (v.state.cross) moveCrosshair(v, dx * step, dy * step);
  else if (v.state.zoom > 1) panBy(v, -40 * dx * step, -40 * dy * step);
  else if (dx !== 0) flipBy(v, dx);
  else return false;
  return true;
}

// Shows another item; beyond the last comes the first.
function flipBy(v, step) {
  v.show((v.state.shown + step + v.items.length) % v.items.length);
}

// Shows the reference, and the picture before it when it is shown already.
function flipToReference(v) {
  const { shown, before } = v.state;
  const item = v.items[shown];
  if (item.isReference) return v.show(before ?? 0);
  const own = v.items.findIndex((other) => other.isReference && other.reference === item.reference);
  const at = own >= 0 ? own : v.items.findIndex((other) => other.isReference);
  if (at >= 0) v.show(at);
}

function cycle(v, name, values, step) {
  v.set(name, values[(values.indexOf(v.state[name]) + step + values.length) % values.length]);
}

const KEYS = {
  "[": (v) => flipBy(v, -1),
  "]": (v) => flipBy(v, 1),
  r: (v) => flipToReference(v),
  f: (v) => resetView(v),
  "+": (v) => zoomBy(v, Math.SQRT2),
  "=": (v) => zoomBy(v, Math.SQRT2),
  "-": (v) => zoomBy(v, Math.SQRT1_2),
  e: (v, shift) => v.set("exposure", v.state.exposure + (shift ? -0.5 : 0.5)),
  v: (v, shift) => cycle(v, "view", Object.keys(VIEWS), shift ? -1 : 1),
  c: (v, shift) => cycle(v, "channel", CHANNELS_OF_VIEWER, shift ? -1 : 1),
  g: (v, shift) => cycle(v, "layout", Object.keys(LAYOUTS), shift ? -1 : 1),
  x: (v) => toggleCrosshair(v),
};

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

function onKey(v, event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const field = event.target.closest("select, input");
  const isDigit = /^[0-9]$/.test(event.key);
  // a field keeps the keys that mean something to it
  if (field && (field.matches("select, input[type=number]") || event.key.startsWith("Arrow"))) return;
  const key = event.key.toLowerCase();
  if (isDigit) {
    const index = (Number(event.key) + 9) % 10;
    if (index < v.items.length) v.show(index);
  } else if (Object.hasOwn(ARROWS, event.key)) {
    if (!arrow(v, ...ARROWS[event.key], event.shiftKey ? 10 : 1)) return;
  } else if (Object.hasOwn(KEYS, key)) KEYS[key](v, event.shiftKey);
  else return;
  event.preventDefault();
}
