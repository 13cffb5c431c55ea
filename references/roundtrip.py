#!/usr/bin/env python3
"""The bench's scenes, exported and measured by Mitsuba 3: do both say the same?

    python3 -m venv target/mitsuba && target/mitsuba/bin/pip install mitsuba==3.9.1
    target/mitsuba/bin/python references/roundtrip.py [--quick]

1. `cornell_box` and `cornell_empty`, exported at 32 x 32 pixels, against the stored references/*.exr, which Mitsuba
   made from its own description of the box: the image's mean and 4 x 4 tiles. Both were rounded alike, so this asks
   whether the export is faithful.
2. `cornell_flush`, with and without blocks: the radiance of its six tiles, all of it and bounce by bounce. Up to three
   values stand against each other: Mitsuba's, the bench's own, and a deterministic one where results.csv has it
   (column `truth`, with `truth_bound`). This asks whether both renderers are right. Light scattered at most k times is
   what Mitsuba gives for max_depth k + 1; what one bounce adds is the difference of two such renderings.

Every value comes from several independent renderings, whose scatter gives its standard error. Two values differ where
|difference|, less the bound on a deterministic value's error, passes so many standard errors as a quantile of Student's
distribution (Welch's degrees of freedom) tells, such that one or more false alarms among all comparisons of the run
have a probability of at most --alpha. Beside that stands the smallest difference that would have been found with a
probability of 90 %: agreement means no more than that. What few paths reach is printed and not compared: light that one
of Mitsuba's renderings missed, or that the bench does not judge.

Mitsuba works in single precision and offsets its rays; near contacts this alone can move a value by 1e-3. The second
part therefore exports with `--scale 100`, which moves the scene's middle to the origin and enlarges it. It also adds up
a pixel's samples in single precision, so that a sum of very many is wrong: for direct light on tile 1 not visibly with
16384 samples a rendering, by 4e-5 with 262144, by 8e-3 with two millions. More precision comes from more --seeds.

Exit status: 0 no difference found, 1 a difference found, 2 could not run.
"""

import argparse
import csv
import functools
import math
import os
import statistics
import subprocess
import sys
import tempfile
import traceback
from collections import namedtuple
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CHANNELS = "RGB"
SIZE = 32  # pixels along each edge of the stored references
TILES = 4  # tiles along each edge
REFERENCE_DF = 31  # degrees of freedom of a stored pixel's standard error
POWER = 0.9
MOST_SPP = 65536  # samples a pixel and rendering; single precision adds up more of them wrongly

# error: its standard error, with so many degrees of freedom; bound: on its systematic error
Value = namedtuple("Value", "mean error df bound", defaults=[0.0])
Difference = namedtuple("Difference", "name got right whole")  # whole: what a difference is told relative to


class CannotRun(Exception):
    """What is missing, in a sentence."""


# Statistics


def tail(t, df):
    """Probability that Student's t with df degrees of freedom exceeds t >= 0."""
    if math.isinf(df):
        return 0.5 * math.erfc(t / math.sqrt(2))
    # I_x(df / 2, 1 / 2) / 2 by its continued fraction [Abramowitz & Stegun 26.5.8], evaluated from its far end
    a, b, x = 0.5 * df, 0.5, df / (df + t * t)
    if x > (a + 1) / (a + b + 2):
        return 0.5 - 0.5 * beta_fraction(b, a, 1 - x)
    return 0.5 * beta_fraction(a, b, x)


def beta_fraction(a, b, x):
    """The regularized incomplete beta function I_x(a, b) for x < (a + 1) / (a + b + 2)."""
    if x == 0:
        return 0.0
    log_front = a * math.log(x) + b * math.log1p(-x) - math.log(a)
    log_front += math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b)
    fraction = 1.0
    for m in range(200, 0, -1):
        odd = -(a + m - 1) * (a + b + m - 1) * x / ((a + 2 * m - 2) * (a + 2 * m - 1))
        even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m))
        fraction = 1 + odd / (1 + even / fraction)
    return math.exp(log_front) / fraction


@functools.lru_cache(maxsize=None)
def quantile(p, df):
    """The t that is exceeded with probability p < 1/2."""
    low, high = 0.0, 1.0
    while tail(high, df) > p:
        high *= 2
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if tail(middle, df) > p else (low, middle)
    return high


def mean_of(values):
    """Mean of independent values of one distribution."""
    return Value(statistics.fmean(values), statistics.stdev(values) / math.sqrt(len(values)), len(values) - 1)


def combined(terms, weight=1.0):
    """Standard error and degrees of freedom of a sum of independent values, times `weight` [Welch 1947]."""
    squares = [t.error**2 for t in terms]
    below = sum(s * s / t.df for s, t in zip(squares, terms))
    df = sum(squares) ** 2 / below if below > 0 else math.inf
    return weight * math.sqrt(sum(squares)), df


def minus(a, b):
    error, df = combined([a, b])
    return Value(a.mean - b.mean, error, df, a.bound + b.bound)


def average(values):
    error, df = combined(values, 1 / len(values))
    return Value(statistics.fmean(v.mean for v in values), error, df)


def judge(differences, alpha):
    """Prints what was found; returns whether there is no difference."""
    p = alpha / (2 * len(differences))
    found, smallest = [], []
    for d in differences:
        by = minus(d.got, d.right)
        limit = quantile(p, by.df)
        if abs(by.mean) > limit * by.error + by.bound:
            found.append((d, by, limit))
        if d.whole > 0:
            needed = (limit + quantile(1 - POWER, by.df)) * by.error + 2 * by.bound
            smallest.append((needed / d.whole, d.name))
    smallest.sort()
    print(f"\n{len(differences)} comparisons, false-alarm probability {alpha:g} for all of them together.")
    print(f"Smallest difference found with probability {POWER:.0%}, relative to the whole: "
          f"median {smallest[len(smallest) // 2][0]:.1e}, worst {smallest[-1][0]:.1e} ({smallest[-1][1]}).")
    for d, by, limit in found:
        print(f"DIFFERS: {d.name}: {d.got.mean:.6g} instead of {d.right.mean:.6g}, "
              f"{by.mean / by.error if by.error else math.inf:+.1f} standard errors; the limit is {limit:.1f}")
    print("A difference was found." if found else "No difference was found.")
    return not found


def z(difference):
    by = minus(difference.got, difference.right)
    return by.mean / by.error if by.error > 0 else (0.0 if by.mean == 0 else math.inf)


# Rendering


def prepare(variant):
    """In each process: one thread, for the processes share the cores."""
    import drjit
    import mitsuba

    mitsuba.set_variant(variant)
    mitsuba.set_log_level(mitsuba.LogLevel.Error)
    drjit.set_thread_count(1)


@functools.lru_cache(maxsize=4)
def loaded(file, max_depth):
    import mitsuba

    return mitsuba.load_file(file, max_depth=str(max_depth))


def render(file, max_depth, spp, seed):
    """Pixel after pixel, row after row from the top left, its three channels."""
    import mitsuba

    return [float(v) for v in mitsuba.render(loaded(file, max_depth), spp=spp, seed=seed).array]


class Bench:
    """The experiment program, and processes that render what it exports."""

    def __init__(self, args, folder):
        self.args, self.folder, self.seed, self.exports = args, Path(folder), args.seed, 0
        cargo = ["cargo", "run", "--quiet", "--locked", "--manifest-path", str(ROOT / "Cargo.toml")]
        cargo += ["--bin", "experiment", "--"]
        self.program = [str(Path(args.experiment).resolve())] if args.experiment else cargo
        self.pool = ProcessPoolExecutor(args.jobs, initializer=prepare, initargs=(args.variant,))

    def experiment(self, *args):
        try:
            run = subprocess.run([*self.program, *args], cwd=self.folder, capture_output=True, text=True)
        except OSError as error:
            raise CannotRun(f"cannot start {self.program[0]}: {error}") from error
        if run.returncode != 0:
            raise CannotRun(f"experiment {' '.join(args)}: exit status {run.returncode}: {run.stderr.strip()}")

    def export(self, scene, *options):
        self.exports += 1
        file = self.folder / f"{self.exports}.xml"
        self.experiment("export", scene, "--format", "mitsuba", "-o", str(file), *options)
        return str(file)

    def start(self, file, spp, max_depth=-1):
        """Renderings with a seed each, to be waited for."""
        seeds = range(self.seed, self.seed + self.args.seeds)
        self.seed = seeds.stop
        return [self.pool.submit(render, file, max_depth, spp, seed) for seed in seeds]


# The stored images


def read_exr(path):
    """Channel name -> values, row by row from the top left."""
    import mitsuba

    bitmap = mitsuba.Bitmap(str(path))
    names = [field.name for field in bitmap.struct_()]
    values = [float(v) for v in mitsuba.TensorXf(bitmap).array]
    return {name: values[i :: len(names)] for i, name in enumerate(names)}


def write_exr(path, renderings, resolution):
    """The channels of the stored references: pixel means and their standard errors."""
    import mitsuba

    pixels = [mean_of(values) for values in zip(*renderings)]
    data = []
    for i in range(0, len(pixels), 3):
        data += [p.mean for p in pixels[i : i + 3]] + [p.error for p in pixels[i : i + 3]]
    names = [*CHANNELS, *(f"std_error.{c}" for c in CHANNELS)]
    tensor = mitsuba.TensorXf(data, (resolution, resolution, len(names)))
    mitsuba.Bitmap(tensor, channel_names=names).write(str(path))


def squares():
    """Name and pixels of the whole image and of each tile."""
    yield "image", range(SIZE * SIZE)
    edge = SIZE // TILES
    for i in range(TILES * TILES):
        x0, y0 = i % TILES * edge, i // TILES * edge
        yield f"tile {i}", [y * SIZE + x for y in range(y0, y0 + edge) for x in range(x0, x0 + edge)]


def images(bench):
    """Part 1."""
    runs = {}
    for scene in ["cornell_box", "cornell_empty"]:
        file = bench.export(scene, "--resolution", str(SIZE))
        runs[scene] = bench.start(file, bench.args.image_spp)
    for scene, run in runs.items():
        stored = read_exr(ROOT / "references" / f"{scene}_{SIZE}x{SIZE}.exr")
        renderings = [future.result() for future in run]
        differences = []
        for name, pixels in squares():
            for c, channel in enumerate(CHANNELS):
                means, errors = stored[channel], stored[f"std_error.{channel}"]
                right = average([Value(means[i], errors[i], REFERENCE_DF) for i in pixels])
                got = mean_of([statistics.fmean(r[3 * i + c] for i in pixels) for r in renderings])
                differences.append(Difference(f"{scene} {name} {channel}", got, right, right.mean))
        spp = bench.args.image_spp
        print(f"\n{scene}, {SIZE} x {SIZE} pixels, {len(renderings)} renderings of {spp} samples a pixel")
        print(f"  {'image':8} {'stored':>20} {'exported':>20} {'z':>6}")
        for d in differences[:3]:
            print(f"  {d.name[-1]:8} {shown(d.right):>20} {shown(d.got):>20} {z(d):6.2f}")
        scores = [z(d) for d in differences[3:]]
        mean_square = statistics.fmean(s * s for s in scores)
        print(f"  {TILES} x {TILES} tiles: z from {min(scores):.2f} to {max(scores):.2f}, mean z² {mean_square:.2f}")
        yield from differences


def shown(value):
    """0.24448(6): the error in the last digits."""
    if value is None:
        return "-"
    if value.error == 0 and value.bound > 0:
        digits = min(max(1 - math.floor(math.log10(value.bound)), 0), 9)
        return f"{value.mean:.{digits}f}"
    if value.error == 0:
        return f"{value.mean:.6g}"
    digits = min(max(1 - math.floor(math.log10(value.error)), 0), 12)
    return f"{value.mean:.{digits}f}({round(value.error * 10**digits)})"


# The flush box

FLUSH = ["cornell_flush", "cornell_flush_blocks"]

EXPERIMENT = """question = "What leaves the six tiles?"
samples = {samples}
[grid]
scene = [{{ cornell_flush = {{ tile = {tiles} }} }}, {{ cornell_flush = {{ tile = {tiles}, blocks = true }} }}]
estimator = ["explicit"]
roulette = ["throughput"]
"""


def own_values(bench):
    """(scene, tile, bounce or "all", channel) -> the bench's value and the deterministic one, if there is one."""
    path = bench.args.results
    if path is None:
        file = bench.folder / "flush.toml"
        file.write_text(EXPERIMENT.format(samples=bench.args.own_samples, tiles=list(range(1, 7))))
        bench.experiment(str(file), "--quiet", "--jobs", str(bench.args.jobs), "--out", str(bench.folder))
        path = bench.folder / "flush" / "results.csv"
    try:
        with open(path, newline="") as file:
            rows = list(csv.DictReader(file))
    except (OSError, UnicodeDecodeError) as error:
        raise CannotRun(f"cannot read {path}: {error}") from error
    values = {}
    for row in rows:
        if row.get("scene") not in FLUSH or row.get("estimand") not in ["mean", "bounce"] or not row.get("tile"):
            continue
        if not row["std_error"] or "not judged" in row["note"] or "clamp" in row["roulette"]:
            continue  # infinite variance, too few samples or paths, or paths cut short
        bounce = row["bounce"] if row["estimand"] == "bounce" else "all"
        key = row["scene"], int(float(row["tile"])), bounce, row["channel"]
        ours = Value(float(row["mean"]), float(row["std_error"]), math.inf)
        value, error, bound = (float(row[name] or 0) for name in ["truth", "truth_error", "truth_bound"])
        truth = Value(value, error, math.inf, bound) if row["truth"] else None
        # of several estimators, the one that knows best
        if key not in values or ours.error < values[key][0].error:
            values[key] = ours, truth
    if not values:
        raise CannotRun(f"{path} has no rows of {' or '.join(FLUSH)} with a column `tile`")
    return values


def flush(bench):
    """Part 2."""
    spp, bounces = bench.args.flush_spp, bench.args.bounces
    own = {} if bench.args.mitsuba_alone else own_values(bench)
    runs = {}
    for scene in FLUSH:
        for tile in range(1, 7):
            blocks = ["--blocks"] if scene.endswith("blocks") else []
            file = bench.export("cornell_flush", "--tile", str(tile), *blocks, "--scale", str(bench.args.scale))
            for k in [*range(1, bounces + 1), "all"]:
                runs[scene, tile, k] = bench.start(file, spp, -1 if k == "all" else k + 1)
    upto, missed = {}, set()
    for key, run in runs.items():
        renderings = [future.result() for future in run]
        for c, channel in enumerate(CHANNELS):
            upto[(*key, channel)] = mean_of([r[c] for r in renderings])
            if not all(r[c] for r in renderings):
                missed.add((*key, channel))
    print(f"\nRadiance of the tiles, {bench.args.seeds} renderings of {spp} samples each, scale {bench.args.scale:g}")
    print("z: difference in standard errors, F furnace, M Mitsuba, D deterministic")
    row = "  {:21} {:4} {:6} {:1} {:>18} {:>18} {:>18} {:>6} {:>6} {:>6}"
    print(row.format("scene", "tile", "bounce", "", "deterministic", "furnace", "Mitsuba", "M-F", "M-D", "F-D"))
    for scene, tile, k, channel in upto:
        got, whole = upto[scene, tile, k, channel], upto[scene, tile, "all", channel].mean
        values = [(str(k), minus(got, upto[scene, tile, k - 1, channel]) if k != "all" and k > 1 else got)]
        if k == "all":
            values.append((f"{bounces + 1}+", minus(got, upto[scene, tile, bounces, channel])))
        for bounce, value in values:
            ours, truth = own.get((scene, tile, bounce, channel), (None, None))
            few = bounce in ["1", "all"] and (scene, tile, k, channel) in missed
            name = f"{scene} tile {tile} bounce {bounce} {channel}"
            scores = []
            for pair, left, right in [("M-F", value, ours), ("M-D", value, truth), ("F-D", ours, truth)]:
                if left and right and not (few and left is value):
                    difference = Difference(f"{name} {pair}", left, right, whole)
                    scores.append(f"{z(difference):.2f}")
                    yield difference
                else:
                    scores.append("")
            if bounce == "all" or not bench.args.quick:
                print(row.format(scene, tile, bounce, channel, shown(truth), shown(ours), shown(value), *scores))


# The command


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__.split("\n\n")[0],
        epilog="Exit status: 0 no difference found, 1 a difference found, 2 could not run.",
    )
    add = parser.add_argument
    add("--experiment", metavar="PATH", help="the experiment program; without it cargo builds and runs it")
    add("--quick", action="store_true", help="less than a minute; finds differences of some per cent")
    add("--only", choices=["images", "flush"], help="one of the two parts")
    add("--results", metavar="CSV", type=Path, help="the bench's values of the tiles, instead of sampling them")
    add("--mitsuba-alone", action="store_true", help="print Mitsuba's values of the tiles, uncompared")
    add("--write", metavar="FILE.exr", type=Path, help="render --scene into a stored reference; compares nothing")
    add("--scene", default="cornell_box", help="what --write renders (default %(default)s)")
    add("--resolution", type=int, default=SIZE, help="pixels along each edge of it (default %(default)s)")
    add("--variant", default="scalar_rgb", help="Mitsuba's variant (default %(default)s, which needs no LLVM)")
    add("--scale", type=float, default=100.0, help="scale of the flush box (default %(default)s)")
    add("--seeds", type=int, default=32, help="renderings a value (default %(default)s)")
    add("--seed", type=int, default=1, help="the first seed (default %(default)s)")
    add("--image-spp", type=int, help="samples a pixel and rendering")
    add("--flush-spp", type=int, help="samples a tile and rendering")
    add("--alpha", type=float, default=1e-3, help="probability of a false alarm (default %(default)s)")
    add("--jobs", type=int, default=os.cpu_count(), help="processes (default: one a core)")
    args = parser.parse_args()
    if args.seeds < 2:
        parser.error("a standard error needs at least 2 --seeds")
    if max(args.image_spp or 0, args.flush_spp or 0) > MOST_SPP:
        parser.error(f"more than {MOST_SPP} samples a rendering add up wrongly; take more --seeds")
    args.bounces = 2 if args.quick else 7
    args.own_samples = 400_000 if args.quick else 2_000_000
    args.image_spp = args.image_spp or (32 if args.quick else 256)
    args.flush_spp = args.flush_spp or (2048 if args.quick else 16384)
    return args


def main():
    args = arguments()
    try:
        import mitsuba

        mitsuba.set_variant(args.variant)
    except ImportError as error:
        raise CannotRun(f"{error}; `pip install mitsuba` brings it") from error
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(args, folder)
        try:
            if args.write:
                file = bench.export(args.scene, "--resolution", str(args.resolution))
                renderings = [future.result() for future in bench.start(file, args.image_spp)]
                write_exr(args.write, renderings, args.resolution)
                return 0
            print(f"Mitsuba {mitsuba.__version__}, {args.variant}", flush=True)
            parts = {"images": images, "flush": flush}
            chosen = [part for name, part in parts.items() if args.only in [None, name]]
            differences = [difference for part in chosen for difference in part(bench)]
        finally:
            bench.pool.shutdown(cancel_futures=True)
    if not differences:
        print("Nothing was compared.")
        return 0
    return 0 if judge(differences, args.alpha) else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except CannotRun as why:
        print(f"cannot run: {why}", file=sys.stderr)
    except Exception:  # a crash is not a difference
        traceback.print_exc()
    sys.exit(2)
