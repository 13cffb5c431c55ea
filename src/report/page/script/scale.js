// Axes: where a value lies between two ends, and which values get a tick.

// A number that JSON may have had to tell as text.
const real = (v) => (typeof v === "string" ? { inf: Infinity, "-inf": -Infinity }[v] ?? NaN : v);

// The ends of an axis: those it states, or those of the values with some space around.
function ends(axis, values, log) {
  const usable = (v) => Number.isFinite(v) && (!log || v > 0);
  const found = values.filter(usable);
  let [low, high] = (axis.range ?? [NaN, NaN]).map(real);
  const f = log ? Math.log : (v) => v;
  const back = log ? Math.exp : (v) => v;
  let [least, most] = found.length
    ? [found.reduce((a, b) => Math.min(a, b)), found.reduce((a, b) => Math.max(a, b))]
    : log ? [0.1, 10] : [0, 1];
  if (least === most) [least, most] = log ? [least / 2, most * 2] : [least - Math.abs(least || 1) / 2, most + Math.abs(most || 1) / 2];
  const space = 0.05 * (f(most) - f(least));
  if (!usable(low)) low = back(f(least) - space);
  if (!usable(high)) high = back(f(most) + space);
  return low < high ? [low, high] : log ? [low / 10, low * 10] : [low - 1, low + 1];
}

// Where a value lies: a share of the axis from 0 to 1, and whether it had to be moved to an end ("low", "high") or is not
// a number ("none").
function place(v, [low, high], log) {
  if (Number.isNaN(v)) return { at: 0, beyond: "none" };
  if (log && v <= 0) return { at: 0, beyond: "low" };
  const f = log ? Math.log : (x) => x;
  const at = v === Infinity ? 2 : v === -Infinity ? -1 : (f(v) - f(low)) / (f(high) - f(low));
  if (at < -1e-9) return { at: 0, beyond: "low" };
  if (at > 1 + 1e-9) return { at: 1, beyond: "high" };
  return { at, beyond: null };
}

// Values that get a tick, at most about `most`.
function ticks([low, high], log, most) {
  const inside = (v) => v >= low - 1e-12 * Math.abs(high) && v <= high + 1e-12 * Math.abs(high);
  if (log) {
    const [from, to] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
    const factors = high / low < 200 ? [1, 2, 5] : [1];
    const step = Math.max(1, Math.ceil((to - from) / most));
    const all = [];
    for (let power = from; power <= to; power += step) for (const m of factors) all.push(m * 10 ** power);
    const shown = all.filter(inside);
    if (shown.length >= 2) return shown;
  }
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough) ?? rough;
  const all = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; i++) all.push(i * step);
  return all.filter(inside);
}

const RAISED = { "-": "⁻", 0: "⁰", 1: "¹", 2: "²", 3: "³", 4: "⁴", 5: "⁵", 6: "⁶", 7: "⁷", 8: "⁸", 9: "⁹" };

// A number for people: few digits, powers of ten where it is very large or small.
function told(v, digits = 4) {
  if (v === Infinity) return "∞";
  if (v === -Infinity) return "−∞";
  if (Number.isNaN(v)) return "not a number";
  if (v === 0) return "0";
  const power = Math.floor(Math.log10(Math.abs(v)));
  if (power >= -3 && power < 6) return String(Number(v.toPrecision(digits))).replace("-", "−");
  const [mantissa, exponent] = v.toExponential(digits - 1).split("e");
  const raised = [...String(Number(exponent))].map((c) => RAISED[c]).join("");
  const factor = String(Number(mantissa)).replace("-", "−");
  return factor === "1" ? `10${raised}` : `${factor}·10${raised}`;
}
