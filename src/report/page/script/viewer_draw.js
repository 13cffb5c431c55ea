// Drawing: panes, pictures, the numbers in them, and the bar that explains the colours. Lengths are CSS pixels.

const LABEL_HEIGHT = 20;
const BAR_HEIGHT = 44;
const GAP = 6;

// Pixels this wide have their values written in them.
const VALUES_FROM = 90;

// The radiance that is white at the exposure.
function whiteOf(v) {
  return 1 / (v.data.exposure * 2 ** v.state.exposure);
}

// What an item is compared with; null where there is nothing, or where it is the very thing.
function againstOf(v, item) {
  const { against } = v.state;
  if (against !== "reference") return v.items.find((other) => other.name === against) ?? null;
  return item.isReference ? item : (v.items.find((other) => other.reference === item.reference && other.isReference) ?? null);
}

// The view of an item: what there is to compare with is shown as it is.
function viewOf(v, item) {
  return VIEWS[v.state.view].compares && againstOf(v, item) === item ? "radiance" : v.state.view;
}

// Where the colour of a view is full.
function limitOf(v, view) {
  return VIEWS[view].fixed ? v.data.full : VIEWS[view].limit(whiteOf(v), v.state.exposure);
}

// From the cache, or made; the oldest is forgotten.
function cached(v, key, make) {
  const known = v.cache.get(key) ?? make();
  v.cache.delete(key);
  v.cache.set(key, known);
  if (v.cache.size > 64 + 4 * v.items.length) v.cache.delete(v.cache.keys().next().value);
  return known;
}

// The numbers behind a view of an item; null for radiance, and where they cannot be had.
function shownField(v, item) {
  const view = viewOf(v, item);
  const against = againstOf(v, item);
  if (view === "radiance" || (VIEWS[view].compares && !against)) return null;
  const { channel } = v.state;
  const key = ["field", v.state.scene, item.name, view, channel, against?.name].join("\n");
  return cached(v, key, () => ({ field: fieldOf(item, view, channel, against) })).field;
}

// A canvas with a pixel for each number, and its colours; null where there is nothing to show.
function bitmapOf(v, item) {
  const view = viewOf(v, item);
  const { channel, exposure, scene } = v.state;
  const stops = VIEWS[view].fixed ? 0 : exposure;
  const key = ["bitmap", scene, item.name, view, channel, stops, againstOf(v, item)?.name].join("\n");
  return cached(v, key, () => {
    const field = shownField(v, item);
    if (view !== "radiance" && !field) return { made: null };
    const image = field
      ? paintField(field, VIEWS[view].scale, limitOf(v, view))
      : paintRadiance(item.raster, WEIGHTS[channel], 1 / whiteOf(v));
    const canvas = element("canvas", { width: image.width, height: image.height });
    canvas.getContext("2d").putImageData(image, 0, 0);
    return { made: { canvas, width: image.width, height: image.height, colours: image.data } };
  }).made;
}

// Makes what flipping will show, one picture at a time, while nothing else is to be done.
function prepare(v) {
  clearTimeout(v.preparing);
  const next = (i) => {
    if (i === v.items.length) return;
    bitmapOf(v, v.items[i]);
    v.preparing = setTimeout(next, 0, i + 1);
  };
  v.preparing = setTimeout(next, 20, 0);
}

// The items on the canvas.
function shownItems(v) {
  const { layout, shown } = v.state;
  if (layout === "single") return [v.items[shown]];
  if (layout === "all") return v.items;
  return v.items.slice(shown - (shown % 4), shown - (shown % 4) + 4);
}

// Where each item is drawn: as many columns as make the pictures largest.
function layPanes(v, width, height) {
  const items = shownItems(v);
  const cell = (columns) => {
    const rows = Math.ceil(items.length / columns);
    return { w: (width - GAP * (columns - 1)) / columns, h: (height - GAP * (rows - 1)) / rows - LABEL_HEIGHT };
  };
  const scale = ({ w, h }) => Math.min(w / v.frame.width, h / v.frame.height);
  let columns = 1;
  for (let more = 2; more <= items.length; more++) if (scale(cell(more)) > scale(cell(columns))) columns = more;
  const { w, h } = cell(columns);
  return items.map((item, i) => {
    const [column, row] = [i % columns, Math.floor(i / columns)];
    return { item, x: column * (w + GAP), y: row * (h + LABEL_HEIGHT + GAP) + LABEL_HEIGHT, w: Math.max(w, 1), h: Math.max(h, 1) };
  });
}

// Keeps the picture in its pane, and gives the screen length of one of its pixels.
function settle(v) {
  const { state, frame } = v;
  const pane = v.panes[0];
  const fit = Math.min(pane.w / frame.width, pane.h / frame.height);
  state.zoom = Math.min(Math.max(state.zoom, 1), Math.max(400 / fit, 1));
  v.scale = fit * state.zoom;
  const within = (centre, length, room) => {
    const half = room / v.scale / 2;
    return 2 * half >= length ? length / 2 : Math.min(Math.max(centre, half), length - half);
  };
  state.x = within(state.x, frame.width, pane.w);
  state.y = within(state.y, frame.height, pane.h);
}

// The screen position of a place in the picture.
function toScreen(v, pane, x, y) {
  return [pane.x + pane.w / 2 + (x - v.state.x) * v.scale, pane.y + pane.h / 2 + (y - v.state.y) * v.scale];
}

// The place in the picture and the pane of a screen position; null between panes.
function fromScreen(v, x, y) {
  const pane = v.panes.find((p) => x >= p.x && x < p.x + p.w && y >= p.y && y < p.y + p.h);
  if (!pane) return null;
  const at = (screen, start, length, centre) => (screen - start - length / 2) / v.scale + centre;
  return { pane, x: at(x, pane.x, pane.w, v.state.x), y: at(y, pane.y, pane.h, v.state.y) };
}

// Draws all of it.
function draw(v) {
  const { canvas } = v;
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (width === 0 || height === 0) return;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const style = getComputedStyle(v.root);
  v.ink = style.color;
  v.line = style.borderTopColor;
  v.font = style.fontFamily;
  const ctx = canvas.getContext("2d");
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.fillStyle = style.backgroundColor;
  ctx.fillRect(0, 0, width, height);
  v.panes = layPanes(v, width, height - BAR_HEIGHT);
  settle(v);
  v.panes.forEach((pane) => drawPane(v, ctx, pane));
  drawBar(v, ctx, width, height - BAR_HEIGHT + 6);
}

function drawPane(v, ctx, pane) {
  const { item } = pane;
  const isChosen = v.panes.length > 1 && item === v.items[v.state.shown];
  ctx.font = `${isChosen ? "bold " : ""}13px ${v.font}`;
  ctx.fillStyle = v.ink;
  ctx.textAlign = "left";
  ctx.textBaseline = "alphabetic";
  ctx.fillText(shortened(ctx, `${item.key} ${item.short}`, pane.w), pane.x, pane.y - 6);
  const bitmap = bitmapOf(v, item);
  ctx.save();
  ctx.beginPath();
  ctx.rect(pane.x, pane.y, pane.w, pane.h);
  ctx.clip();
  if (bitmap) {
    const [left, top] = toScreen(v, pane, 0, 0);
    const [w, h] = [v.frame.width * v.scale, v.frame.height * v.scale];
    const ratio = window.devicePixelRatio || 1;
    ctx.imageSmoothingEnabled = w * ratio < bitmap.width;
    ctx.drawImage(bitmap.canvas, left, top, w, h);
    // what is white must end somewhere on a white page
    ctx.strokeStyle = v.line;
    ctx.strokeRect(left + 0.5, top + 0.5, w - 1, h - 1);
    drawNumbers(v, ctx, pane, bitmap);
  } else {
    const why = againstOf(v, item) ? "no 4 × 4 tiles" : "nothing to compare with: see “against”";
    ctx.fillText(shortened(ctx, why, pane.w), pane.x, pane.y + 20);
  }
  drawCrosshair(v, ctx, pane);
  ctx.restore();
}

function shortened(ctx, text, width) {
  if (ctx.measureText(text).width <= width) return text;
  let length = text.length;
  while (length > 1 && ctx.measureText(text.slice(0, length) + "…").width > width) length--;
  return text.slice(0, length) + "…";
}

// Values in squares that are wide enough for them; those of tiles always.
function drawNumbers(v, ctx, pane, bitmap) {
  const field = shownField(v, pane.item);
  const [w, h] = [(v.frame.width * v.scale) / bitmap.width, (v.frame.height * v.scale) / bitmap.height];
  const isTiles = viewOf(v, pane.item) === "tiles";
  if (!isTiles && w < VALUES_FROM) return;
  const [left, top] = toScreen(v, pane, 0, 0);
  const first = (start, origin, step) => Math.max(Math.floor((start - origin) / step), 0);
  const size = isTiles ? Math.min(Math.max(w / 4, 7), 16) : 14;
  ctx.font = `${size}px ${v.font}`;
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  for (let y = first(pane.y, top, h); y < bitmap.height && top + y * h < pane.y + pane.h; y++) {
    for (let x = first(pane.x, left, w); x < bitmap.width && left + x * w < pane.x + pane.w; x++) {
      const i = y * bitmap.width + x;
      ctx.fillStyle = wantsBlack(bitmap.colours.subarray(4 * i, 4 * i + 3)) ? "#000" : "#fff";
      const lines = field ? [fieldText(field, i, isTiles)] : pane.item.raster.mean.map((m) => significant(m[i], 4));
      lines.forEach((line, l) => {
        ctx.fillText(line, left + (x + 0.5) * w, top + (y + 0.5) * h + (l - (lines.length - 1) / 2) * 1.3 * size, w);
      });
      if (field?.wrong?.[i]) {
        ctx.lineWidth = 2;
        ctx.strokeStyle = ctx.fillStyle;
        ctx.strokeRect(left + x * w + 3, top + y * h + 3, w - 6, h - 6);
      }
    }
  }
}

function fieldText(field, i, isTiles) {
  const value = field.values[i];
  const letter = field.letters ? "RGB"[field.letters[i]] + " " : "";
  if (!isTiles) return letter + significant(value, 4);
  return letter + (value > 0 ? "+" : "") + (Math.abs(value) < 99.5 ? value.toFixed(1) : value.toFixed(0)).replace("-", "−");
}

// A number with so many significant digits.
function significant(value, digits) {
  if (!Number.isFinite(value) || value === 0) return String(value).replace("Infinity", "∞").replace("-", "−");
  const size = Math.abs(value);
  const text = size >= 1e5 || size < 1e-3 ? value.toExponential(digits - 1) : value.toPrecision(digits);
  return text.replaceAll("-", "−");
}

function drawCrosshair(v, ctx, pane) {
  const { cross } = v.state;
  if (!cross) return;
  const [left, top] = toScreen(v, pane, cross.x, cross.y);
  const length = v.scale;
  for (const [colour, wide] of [["#000", 3], ["#fff", 1]]) {
    ctx.strokeStyle = colour;
    ctx.lineWidth = wide;
    ctx.strokeRect(left, top, length, length);
    ctx.beginPath();
    for (const [x, y] of [[-1, 0], [1, 0], [0, -1], [0, 1]]) {
      const from = (at, side) => at + length / 2 + side * (length / 2 + 3);
      ctx.moveTo(from(left, x), from(top, y));
      ctx.lineTo(from(left, x) + 10 * x, from(top, y) + 10 * y);
    }
    ctx.stroke();
  }
}

// The colours of the view and the numbers that they stand for.
function drawBar(v, ctx, width, top) {
  const view = VIEWS[v.state.view];
  if (!view.scale) return;
  const [length, left] = [Math.min(width - 60, 420), 30];
  const { table } = TABLES[view.scale];
  for (let x = 0; x < length; x++) {
    const colour = table[Math.round((x / (length - 1)) * (table.length - 1))];
    ctx.fillStyle = `rgb(${colour & 255} ${(colour >> 8) & 255} ${(colour >> 16) & 255})`;
    ctx.fillRect(left + x, top, 1.5, 14);
  }
  const limit = limitOf(v, v.state.view);
  const low = view.scale === "diverging" ? -limit : 0;
  ctx.font = `12px ${v.font}`;
  ctx.fillStyle = v.ink;
  ctx.textBaseline = "top";
  ctx.textAlign = "center";
  for (const at of [0, 0.5, 1]) {
    const beyond = at === 1 ? "≥ " : at === 0 && low < 0 ? "≤ " : "";
    ctx.fillText(beyond + significant(low + at * (limit - low), 3), left + at * length, top + 19);
  }
  ctx.textAlign = "left";
  if (width - left - length > 120) ctx.fillText(view.unit, left + length + 24, top + 2);
}
