// From numbers to colours.

// What is not a finite number has this colour in every view.
const NOT_FINITE = [255, 0, 255];

// 33 points of the map viridis of S. van der Walt and N. Smith (matplotlib, 2015, CC0); lines between them stay within
// two of 255 levels of it.
const VIRIDIS = (
  "440154 470d60 48186a 482374 472d7b 453681 424086 3f4989 3b528b 375a8d 33638d 2f6a8e 2c728e 297a8e 26818e 23898e " +
  "21908c 1f988b 1f9f88 21a685 28ae80 31b57b 3ebc74 4cc26c 5dc963 6ece58 82d34c 96d83f abdc32 c0df24 d5e21a eae51a " +
  "fde725"
)
  .split(" ")
  .map((hex) => [0, 2, 4].map((at) => parseInt(hex.slice(at, at + 2), 16)));

// Along viridis, from 0 to 1.
function sequential(t) {
  const at = Math.min(Math.max(t, 0), 1) * (VIRIDIS.length - 1);
  const left = Math.min(Math.floor(at), VIRIDIS.length - 2);
  return VIRIDIS[left].map((from, c) => Math.round(from + (VIRIDIS[left + 1][c] - from) * (at - left)));
}

// From blue at -1 over white to vermilion at 1: the colours of the difference maps beside the page.
function diverging(t) {
  const full = t < 0 ? [0x00, 0x72, 0xb2] : [0xd5, 0x5e, 0x00];
  return full.map((c) => Math.floor(255 + (c - 255) * Math.min(Math.abs(t), 1) + 0.5));
}

// One pixel of image data, the lowest byte first, as on every machine that runs a browser.
function word([r, g, b]) {
  return ((255 << 24) | (b << 16) | (g << 8) | r) >>> 0;
}

const SEQUENTIAL = Uint32Array.from({ length: 512 }, (_, i) => word(sequential(i / 511)));
const DIVERGING = Uint32Array.from({ length: 511 }, (_, i) => word(diverging(i / 255 - 1)));

// The table of a scale and the place in it of a value between 0 (or -1) and 1.
const TABLES = {
  sequential: { table: SEQUENTIAL, place: (t) => t * 511 },
  diverging: { table: DIVERGING, place: (t) => (t + 1) * 255 },
};

// The linear value from which on each 8-bit level of sRGB is the nearest (IEC 61966-2-1).
const LEVEL_FROM = Float64Array.from({ length: 257 }, (_, level) => {
  if (level === 0) return -Infinity;
  if (level === 256) return Infinity;
  const encoded = (level - 0.5) / 255;
  return encoded <= 0.04045 ? encoded / 12.92 : ((encoded + 0.055) / 1.055) ** 2.4;
});

// A first guess of the level, never too high, for values in steps of 1/4096.
const LEVEL_GUESS = Uint8Array.from({ length: 4097 }, (_, i) => LEVEL_FROM.findLastIndex((from) => from <= i / 4096));

// The 8-bit sRGB level of a linear value, which is clipped.
function srgbLevel(linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  let level = LEVEL_GUESS[(linear * 4096) | 0];
  while (LEVEL_FROM[level + 1] <= linear) level++;
  return level;
}

// Image data of three channels times a factor, or of one as grey.
function paintRadiance(raster, weights, factor) {
  const image = new ImageData(raster.width, raster.height);
  const pixels = new Uint32Array(image.data.buffer);
  const marked = word(NOT_FINITE);
  const [r, g, b] = raster.mean;
  const grey = weights && weighted(raster.mean, weights);
  for (let i = 0; i < pixels.length; i++) {
    if (!Number.isFinite(r[i] + g[i] + b[i])) pixels[i] = marked;
    else if (grey) pixels[i] = (255 << 24) | (srgbLevel(grey[i] * factor) * 0x010101);
    else {
      const [red, green, blue] = [srgbLevel(r[i] * factor), srgbLevel(g[i] * factor), srgbLevel(b[i] * factor)];
      pixels[i] = (255 << 24) | (blue << 16) | (green << 8) | red;
    }
  }
  return image;
}

// Image data of numbers, whose colour is full at `limit`.
function paintField({ width, height, values }, scale, limit) {
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  const { table, place } = TABLES[scale];
  const [marked, last] = [word(NOT_FINITE), table.length - 1];
  for (let i = 0; i < pixels.length; i++) {
    const t = values[i] / limit;
    pixels[i] = Number.isNaN(t) ? marked : table[Math.min(Math.max(Math.round(place(t)), 0), last)];
  }
  return image;
}

// Whether black letters are easier to read than white ones on a colour: relative luminance by WCAG 2.
function wantsBlack([r, g, b]) {
  const linear = (c) => (c <= 10 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b) > 0.179;
}
