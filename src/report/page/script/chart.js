// One panel of a figure as SVG: axes, regions, marks, series. Lying panels have their categories from top to bottom.

const LETTER = 6.1; // width of a letter of 11 px, on average

// What is drawn, and the points that the pointer can find: { svg, hits }.
function chart(panel, { logX, logY, width = 520 }) {
  const lying = panel.lying && panel.x.categories.length > 0;
  const names = panel.x.categories;
  const longest = Math.min(names.reduce((most, name) => Math.max(most, name.length), 0) * LETTER, 0.42 * width);
  const frame = lying
    ? { left: longest + 12, top: 24, width, height: 70 + 20 * names.length }
    : { left: 66, top: 24, width, height: 320 };
  frame.w = width - frame.left - 14;
  frame.h = frame.height - frame.top - 44;
  const bars = panel.series.filter((s) => s.style === "bars");
  const xs = [...panel.series.flatMap((s) => s.points.map((p) => real(p[0]))), ...panel.marks.map((m) => real(m.x))];
  const ys = [
    ...panel.series.flatMap((s) => s.points.flatMap((p) => p.slice(1).map(real))),
    ...panel.marks.map((m) => real(m.y)),
    ...(bars.length && !logY ? [0] : []),
  ].filter((y) => y !== undefined);
  const xEnds = names.length ? [-0.5, names.length - 0.5] : ends(panel.x, xs, logX);
  const yEnds = ends(logY === panel.y.log ? panel.y : { range: null }, ys, logY);
  const onX = (v) => place(v, xEnds, !names.length && logX);
  const onY = (v) => place(v, yEnds, logY);
  // shares of both axes to pixels
  const at = lying
    ? (x, y) => [frame.left + y * frame.w, frame.top + x * frame.h]
    : (x, y) => [frame.left + x * frame.w, frame.top + (1 - y) * frame.h];
  const view = { panel, frame, lying, at, onX, onY, xEnds, yEnds, logX, logY, names, bars, hits: [] };
  const svg = element("svg:svg", {
    viewBox: `0 0 ${frame.width} ${frame.height}`, class: "chart", role: "img", tabindex: 0,
    "aria-label": `${panel.title ? panel.title + ". " : ""}${panel.y.label} over ${panel.x.label || "cells"}. Arrow keys step through the points.`,
  });
  svg.append(...axes(view), ...panel.regions.map((r) => shade(view, r)), ...panel.marks.map((m) => mark(view, m)));
  panel.series.forEach((series) => svg.append(drawn(view, series)));
  if (panel.title) {
    // a long one starts further left, and is smaller where that does not do
    const [long, room] = [1.1 * LETTER * panel.title.length, width - 4];
    const x = Math.max(4, Math.min(frame.left, room - long));
    svg.append(text(x, 14, panel.title, { "font-weight": "bold", "font-size": Math.min(11, (11 * (room - 4)) / long) }));
  }
  return { svg, hits: view.hits };
}

function text(x, y, words, attributes = {}) {
  return element("svg:text", { x, y, fill: "currentColor", "font-size": 11, ...attributes }, words);
}

function line([x1, y1], [x2, y2], attributes = {}) {
  return element("svg:line", { x1, y1, x2, y2, stroke: "currentColor", ...attributes });
}

// Okabe and Ito's black is what ink is on this page.
const ink = (colour) => (colour === "#000000" ? "currentColor" : colour);

function axes(view) {
  const { frame, at, lying, names, panel } = view;
  const grid = { "stroke-opacity": 0.14, "stroke-width": 1 };
  const made = [element("svg:rect", {
    x: frame.left, y: frame.top, width: frame.w, height: frame.h, fill: "none", stroke: "currentColor", "stroke-opacity": 0.5,
  })];
  const across = (v, label) => { // a tick of the axis that runs from left to right
    const [x, y] = lying ? at(0, view.onY(v).at) : at(view.onX(v).at, 0);
    made.push(line([x, frame.top], [x, frame.top + frame.h], grid));
    made.push(text(x, frame.top + frame.h + 15, label, { "text-anchor": "middle" }));
  };
  const up = (v, label) => {
    const [x, y] = lying ? at(view.onX(v).at, 0) : at(0, view.onY(v).at);
    made.push(line([frame.left, y], [frame.left + frame.w, y], grid));
    made.push(text(frame.left - 6, y + 4, label, { "text-anchor": "end" }));
  };
  const short = (name, room) => (name.length * LETTER > room ? `${name.slice(0, Math.max(3, Math.floor(room / LETTER) - 1))}…` : name);
  const [alongX, alongY] = lying ? [up, across] : [across, up];
  if (names.length) names.forEach((name, i) => alongX(i, short(name, lying ? frame.left - 8 : frame.w / names.length)));
  else ticks(view.xEnds, view.logX, lying ? 8 : Math.floor(frame.w / 70)).forEach((v) => alongX(v, told(v, 3)));
  ticks(view.yEnds, view.logY, lying ? Math.floor(frame.w / 70) : 7).forEach((v) => alongY(v, told(v, 3)));
  const [below, aside] = lying ? [panel.y.label, panel.x.label] : [panel.x.label, panel.y.label];
  const middle = frame.top + frame.h / 2;
  made.push(text(frame.left + frame.w / 2, frame.height - 8, below, { "text-anchor": "middle" }));
  if (aside) made.push(text(13, middle, aside, { "text-anchor": "middle", transform: `rotate(-90 13 ${middle})` }));
  return made;
}

function shade(view, region) {
  const [from, to] = [real(region.from), real(region.to)].map((v) => view.onX(v).at);
  const [[x0, y0], [x1, y1]] = [view.at(from, 0), view.at(to, 1)];
  return element("svg:rect", {
    x: Math.min(x0, x1), y: Math.min(y0, y1), width: Math.abs(x1 - x0), height: Math.abs(y1 - y0),
    fill: ink(region.colour), "fill-opacity": 0.13, stroke: ink(region.colour), "stroke-opacity": 0.5,
    "stroke-dasharray": "3 3", "data-series": region.label,
  });
}

function mark(view, m) {
  const { at } = view;
  const style = { stroke: ink(m.colour), "stroke-width": 1.2, "stroke-dasharray": "12 3", "data-series": m.label };
  if (m.kind === "point") {
    const [x, y] = at(view.onX(real(m.x)).at, view.onY(real(m.y)).at);
    view.hits.push({ x, y, series: m.label, words: `${m.label || "mark"}: ${told(real(m.x))}, ${told(real(m.y))}` });
    return element("svg:circle", { cx: x, cy: y, r: 6, fill: "none", stroke: ink(m.colour), "stroke-width": 2, "data-series": m.label });
  }
  const where = m.kind === "vertical" ? view.onX(real(m.x)) : view.onY(real(m.y));
  if (where.beyond) return element("svg:g");
  return m.kind === "vertical" ? line(at(where.at, 0), at(where.at, 1), style) : line(at(0, where.at), at(1, where.at), style);
}
