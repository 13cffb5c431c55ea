// What each view shows of a picture.

// How channels make one number: ITU-R BT.709 for luminance.
const WEIGHTS = { R: [1, 0, 0], G: [0, 1, 0], B: [0, 0, 1], luminance: [0.2126, 0.7152, 0.0722] };
const MEAN_OF_RGB = [1 / 3, 1 / 3, 1 / 3];

// `limit` is where the colour is full, of the radiance that an exposure makes white; `compares` needs a second picture.
const VIEWS = {
  radiance: { name: "radiance" },
  "false-colour": { name: "false colour", scale: "sequential", limit: (white) => white, unit: "radiance" },
  error: { name: "signed error", scale: "diverging", limit: (white) => white / 10, compares: true, unit: "error" },
  "relative-error": {
    name: "signed relative error",
    scale: "diverging",
    limit: (_, stops) => 100 * 2 ** -stops,
    compares: true,
    unit: "error [%]",
  },
  "absolute-error": {
    name: "absolute difference",
    scale: "sequential",
    limit: (white) => white / 10,
    compares: true,
    unit: "|error|",
  },
  z: { name: "difference in standard errors", scale: "diverging", compares: true, unit: "z", fixed: true },
  tiles: { name: "tile z-map", scale: "diverging", compares: true, unit: "z of a tile", fixed: true },
};

const TILES = 4;

// A number a pixel; NaN where one that it is made of is not finite.
function weighted([r, g, b], [ofR, ofG, ofB]) {
  const made = new Float64Array(r.length);
  for (let i = 0; i < made.length; i++) {
    // what has no weight must not matter, infinite or not
    const sum = (ofR && ofR * r[i]) + (ofG && ofG * g[i]) + (ofB && ofB * b[i]);
    made[i] = Number.isFinite(sum) ? sum : NaN;
  }
  return made;
}

// Deviation in standard errors of both; 0 where nothing differs. A right value without noise makes it infinite.
function inErrors(difference, ours, theirs) {
  return difference === 0 ? 0 : difference / Math.sqrt(ours * ours + theirs * theirs);
}

// Deviations between means `a` and `b` whose standard errors are given; NaN where they cannot be told.
function deviations(a, b, errorOfA, errorOfB) {
  const made = new Float64Array(a.length);
  for (let i = 0; i < made.length; i++) {
    const difference = a[i] - b[i];
    made[i] = Number.isFinite(difference) ? inErrors(difference, errorOfA[i], errorOfB[i]) : NaN;
  }
  return made;
}

// The channel that deviates most, of each place; NaN where one is.
function strongest([r, g, b]) {
  const letters = new Uint8Array(r.length);
  const values = new Float64Array(r.length);
  for (let i = 0; i < values.length; i++) {
    const [x, y, z] = [Math.abs(r[i]), Math.abs(g[i]), Math.abs(b[i])];
    letters[i] = x >= y && x >= z ? 0 : y >= z ? 1 : 2;
    values[i] = Number.isNaN(x + y + z) ? NaN : letters[i] === 0 ? r[i] : letters[i] === 1 ? g[i] : b[i];
  }
  return { values, letters };
}

// Of one channel, of the one that deviates most, or of luminance, whose errors are those of the channels added, as these
// share their paths.
function deviationField({ width, height, ours, theirs }, channel) {
  const sides = [ours.mean, theirs.mean, ours.error, theirs.error];
  const of = (c) => deviations(...sides.map((side) => side[c]));
  if (channel === "RGB") return { width, height, ...strongest([0, 1, 2].map(of)) };
  if (channel !== "luminance") return { width, height, values: of("RGB".indexOf(channel)) };
  return { width, height, values: deviations(...sides.map((side) => weighted(side, WEIGHTS.luminance))) };
}

// Tiles as the rows of the results have them, where the reference is that of the results; else by the pixels.
function tileField(item, against, channel) {
  const size = { width: TILES, height: TILES };
  if (item.tiles && against.isReference && channel !== "luminance") {
    const of = (c) => Float64Array.from(item.tiles.z, (tile) => Number(tile[c]));
    const c = "RGB".indexOf(channel);
    const isRgb = channel === "RGB";
    const field = isRgb ? strongest([0, 1, 2].map(of)) : { values: of(c) };
    const wrong = item.tiles.wrong.map((tile) => (isRgb ? tile.some(Boolean) : tile[c]));
    return { ...size, ...field, wrong };
  }
  const [ours, theirs] = [item.raster, against.raster];
  const sides = [ours.width, ours.height, theirs.width, theirs.height];
  if (sides.some((side) => side % TILES !== 0)) return null;
  const blocks = (raster) => inBlocks(raster, TILES, TILES);
  return deviationField({ ...size, ours: blocks(ours), theirs: blocks(theirs) }, channel);
}

// The numbers that a view shows in colour; null where it cannot be made.
function fieldOf(item, view, channel, against) {
  const weights = WEIGHTS[channel] ?? MEAN_OF_RGB;
  if (view === "tiles") return tileField(item, against, channel);
  if (!VIEWS[view].compares) {
    const { width, height, mean } = item.raster;
    return { width, height, values: weighted(mean, weights) };
  }
  const pair = compare(item.raster, against.raster);
  if (view === "z") return deviationField(pair, channel);
  const [a, b] = [weighted(pair.ours.mean, weights), weighted(pair.theirs.mean, weights)];
  const made = {
    error: (x, right) => x - right,
    "relative-error": (x, right) => (x === right ? 0 : (100 * (x - right)) / right),
    "absolute-error": (x, right) => Math.abs(x - right),
  }[view];
  return { width: pair.width, height: pair.height, values: a.map((x, i) => made(x, b[i])) };
}

// What the colours of a view mean, in a sentence.
function viewWords(view, channel) {
  const sum = { RGB: "the mean of red, green and blue", luminance: "luminance (BT.709)" }[channel] ?? channel;
  const worst = channel === "RGB" ? "the channel that deviates most" : sum;
  return {
    radiance: channel === "RGB" ? "Radiance times the exposure in sRGB." : `Radiance times the exposure as grey: ${sum}.`,
    "false-colour": `Radiance in false colour (viridis): ${sum}.`,
    error: `This picture less the other: ${sum}; blue is too dark, white right, orange too bright.`,
    "relative-error": `This picture less the other, in percent of the other: ${sum}; blue is too dark, orange too bright.`,
    "absolute-error": `Absolute difference (viridis): ${sum}.`,
    z: `Difference in standard errors of both pictures together: ${worst}; blue is too dark, orange too bright.`,
    tiles: `Mean of each of 4 × 4 tiles less the other's, in standard errors: ${worst}.`,
  }[view];
}
