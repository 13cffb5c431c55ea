// Data that the page carries: base64 of zlib, see packed.rs.

// The bytes of a block; null where the page has no such block.
async function unpack(id) {
  const block = document.getElementById(id);
  if (!block) return null;
  const letters = atob(block.textContent);
  const packed = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; i++) packed[i] = letters.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// The value of a block; null where the page has no such block.
async function unpackJson(id) {
  const bytes = await unpack(id);
  return bytes && JSON.parse(new TextDecoder().decode(bytes));
}

// An element with attributes and children; strings become text, never markup. A name "svg:path" is one of SVG.
function element(name, attributes = {}, ...children) {
  const svg = name.startsWith("svg:");
  const made = svg
    ? document.createElementNS("http://www.w3.org/2000/svg", name.slice(4))
    : document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key.startsWith("on")) made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value === true ? "" : value);
  }
  made.append(...children.flat().filter((child) => child !== null && child !== undefined));
  return made;
}

// Lets the browser answer its reader before work goes on.
function breath() {
  return new Promise((resume) => { setTimeout(resume); });
}

// Offers text or a blob for saving.
function save(name, content, type) {
  const blob = content instanceof Blob ? content : new Blob([content], { type });
  const url = URL.createObjectURL(blob);
  element("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
