// Pixels as the page carries them: means bit by bit, standard errors in codes. raster.rs writes them.

// All pictures and references of the page.
async function loadPictures() {
  const data = await unpackJson("viewer-data");
  const rasters = async (kind, list) => {
    const made = [];
    for (const [i, { width, height }] of list.entries()) {
      await breath();
      made.push(unpackRaster(await unpack(`viewer-${kind}-${i}`), width, height));
    }
    return made;
  };
  const pictures = await rasters("picture", data.pictures);
  const references = await rasters("reference", data.references);
  data.pictures.forEach((picture, i) => (picture.raster = pictures[i]));
  return { ...data, references };
}

// Three channels of means and of their standard errors.
function unpackRaster(bytes, width, height) {
  const count = width * height;
  const mean = [0, 1, 2].map(() => new Uint32Array(count));
  const codes = [0, 1, 2].map(() => new Uint16Array(count));
  let at = 0;
  mean.forEach((word, c) => {
    for (let shift = 0; shift < 32; shift += 8) {
      for (let i = 0; i < count; i++) word[i] |= bytes[at++] << shift;
    }
    if (c > 0) for (let i = 0; i < count; i++) word[i] += mean[c - 1][i];
  });
  for (const shift of [0, 8]) {
    for (const code of codes) for (let i = 0; i < count; i++) code[i] |= bytes[at++] << shift;
  }
  codes.forEach((code, c) => {
    for (let i = 0; i < count; i++) {
      const difference = (code[i] >>> 1) ^ -(code[i] & 1);
      code[i] = difference + (c > 0 ? codes[c - 1][i] : i > 0 ? code[i - 1] : 0);
    }
  });
  return {
    width,
    height,
    mean: mean.map((word) => new Float32Array(word.buffer)),
    error: codes.map(decoded),
  };
}

function decoded(codes) {
  const errors = new Float32Array(codes.length);
  for (let i = 0; i < codes.length; i++) errors[i] = STANDARD_ERRORS[codes[i]];
  return errors;
}

// What the code of a standard error stands for.
const STANDARD_ERRORS = Float32Array.from({ length: 65536 }, (_, code) => 2 ** ((code - 1801) / 12));
STANDARD_ERRORS[0] = 0;
STANDARD_ERRORS[65535] = NaN;

// Means over equal blocks, so many across and down; pixels are independent.
function inBlocks(raster, columns, rows) {
  if (columns === raster.width && rows === raster.height) return raster;
  const [w, h] = [raster.width / columns, raster.height / rows];
  const average = (values, finish) => {
    const sums = new Float64Array(columns * rows);
    values.forEach((value, i) => {
      const [x, y] = [Math.floor((i % raster.width) / w), Math.floor(Math.floor(i / raster.width) / h)];
      sums[y * columns + x] += value;
    });
    return sums.map(finish);
  };
  return {
    width: columns,
    height: rows,
    mean: raster.mean.map((m) => average(m, (sum) => sum / (w * h))),
    error: raster.error.map((e) => average(Float64Array.from(e, (v) => v * v), (sum) => Math.sqrt(sum) / (w * h))),
  };
}

function commonDivisor(a, b) {
  return b === 0 ? a : commonDivisor(b, a % b);
}

const compared = new WeakMap();

// Two rasters on the finest grid that both have.
function compare(ours, theirs) {
  if (!compared.has(ours)) compared.set(ours, new Map());
  const known = compared.get(ours);
  if (!known.has(theirs)) {
    const width = commonDivisor(ours.width, theirs.width);
    const height = commonDivisor(ours.height, theirs.height);
    known.set(theirs, { width, height, ours: inBlocks(ours, width, height), theirs: inBlocks(theirs, width, height) });
  }
  return known.get(theirs);
}
