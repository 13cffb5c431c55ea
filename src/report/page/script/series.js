// A series of a chart: lines, markers, bars, their error bars, and what lies beyond the axes.

const DASHES = { line: null, dashed: "7 4", dotted: "2 3", dash_dotted: "8 3 2 3" };

const MARKERS = {
  circle: (r) => `M${-r},0a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0Z`,
  square: (r) => `M${-r},${-r}h${2 * r}v${2 * r}h${-2 * r}Z`,
  triangle: (r) => `M0,${-r * 1.2}L${r * 1.1},${r}H${-r * 1.1}Z`,
  diamond: (r) => `M0,${-r * 1.3}L${r * 1.1},0L0,${r * 1.3}L${-r * 1.1},0Z`,
  cross: (r) => `M${-r},${-r}L${r},${r}M${-r},${r}L${r},${-r}`,
};

// Its group, which the legend can hide; adds its points to what the pointer can find.
function drawn(view, series) {
  const group = element("svg:g", { "data-series": series.label, "data-colour": series.colour });
  const colour = ink(series.colour);
  const points = series.points.map((p) => {
    const [x, y, low, high] = p.map(real);
    return { x, y, low, high, onX: view.onX(x), onY: view.onY(y) };
  });
  if (series.style in DASHES) group.append(path(view, points, colour, DASHES[series.style]));
  points.forEach((point) => {
    if (series.style === "bars") group.append(bar(view, series, point, colour));
    if (series.style === "bars" || series.marker) {
      group.append(...errorBar(view, series, point, colour));
      if (series.marker && !beyond(point)) group.append(marker(series.marker, shifted(view, series, point), colour));
    }
    if (beyond(point)) group.append(flag(view, point, colour));
    const [x, y] = shifted(view, series, point);
    const isMark = Boolean(series.marker) || series.style === "bars";
    view.hits.push({ x, y, series: series.label, isMark, words: words(view, series, point) });
  });
  return group;
}

const beyond = (point) => point.onX.beyond ?? point.onY.beyond;

function words(view, series, { x, y, low, high }) {
  const where = view.names.length ? view.names[x] : `${view.panel.x.label} ${told(x)}`;
  const bar = Number.isFinite(low) && Number.isFinite(high) && low !== undefined ? ` (${told(low)} to ${told(high)})` : "";
  return `${series.label ? series.label + "; " : ""}${where}: ${told(y)}${bar}`;
}

// Where a point is drawn: side by side in a category where several series share it.
function shifted(view, series, point) {
  const among = view.names.length ? view.panel.series : [];
  const offset = among.length > 1 ? (0.6 * (among.indexOf(series) - (among.length - 1) / 2)) / among.length / view.names.length : 0;
  return view.at(point.onX.at + offset, point.onY.at);
}

function path(view, points, colour, dashes) {
  let d = "";
  let open = false;
  for (const point of points) {
    if (point.onX.beyond || point.onY.beyond === "none") { open = false; continue; }
    const [x, y] = view.at(point.onX.at, point.onY.at);
    d += `${open ? "L" : "M"}${x.toFixed(1)},${y.toFixed(1)}`;
    open = !point.onY.beyond;
  }
  return element("svg:path", { d, fill: "none", stroke: colour, "stroke-width": 1.6, "stroke-dasharray": dashes });
}

function marker(kind, [x, y], colour) {
  const open = kind === "cross";
  return element("svg:path", {
    d: MARKERS[kind](3.6), transform: `translate(${x.toFixed(1)} ${y.toFixed(1)})`,
    fill: open ? "none" : colour, stroke: colour, "stroke-width": open ? 1.6 : 0.5,
  });
}

function bar(view, series, point, colour) {
  const count = view.bars.length;
  const thick = (0.7 * (view.lying ? view.frame.h : view.frame.w)) / view.names.length / count;
  const zero = view.logY ? 0 : view.onY(0).at;
  const [x, y] = shifted(view, series, point);
  const [bx, by] = view.at(point.onX.at, zero);
  return view.lying
    ? element("svg:rect", { x: Math.min(bx, x), y: y - thick / 2, width: Math.abs(x - bx), height: thick, fill: colour, "fill-opacity": 0.8 })
    : element("svg:rect", { x: x - thick / 2, y: Math.min(by, y), width: thick, height: Math.abs(by - y), fill: colour, "fill-opacity": 0.8 });
}

function errorBar(view, series, point, colour) {
  if (Number.isNaN(point.y) || (point.low === undefined && point.high === undefined)) return [];
  const end = (v) => view.onY(Number.isNaN(v) ? point.y : v);
  const [low, high] = [end(point.low), end(point.high)];
  const [x, y] = shifted(view, series, point);
  const on = (share) => (view.lying ? [view.at(0, share)[0], y] : [x, view.at(0, share)[1]]);
  const style = { stroke: series.style === "bars" ? "currentColor" : colour, "stroke-width": 1.3 };
  const cap = (e) => { // an end beyond the axis has no cap
    const [cx, cy] = on(e.at);
    if (e.beyond) return null;
    return view.lying ? line([cx, cy - 3], [cx, cy + 3], style) : line([cx - 3, cy], [cx + 3, cy], style);
  };
  return [line(on(low.at), on(high.at), style), cap(low), cap(high)].filter(Boolean);
}

// A small triangle at the edge towards which a value lies, a cross for what is not a number.
function flag(view, point, colour) {
  const [x, y] = view.at(point.onX.at, point.onY.at);
  const kind = beyond(point);
  const turned = { low: view.lying ? -90 : 180, high: view.lying ? 90 : 0, none: 0 };
  const turn = point.onX.beyond && !view.lying ? turned[kind] + 90 : turned[kind];
  return element("svg:path", {
    d: kind === "none" ? MARKERS.cross(4) : MARKERS.triangle(4), transform: `translate(${x} ${y}) rotate(${turn})`,
    fill: kind === "none" ? "none" : colour, stroke: colour, class: "beyond",
  });
}
