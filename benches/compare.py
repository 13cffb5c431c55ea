"""The Cornell box by Mitsuba and by this bench, in turns; see compare.sh, which calls this."""

import argparse
import math
import multiprocessing
import os
import statistics
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "references"))
from roundtrip import Difference, Value, judge, mean_of, quantile  # noqa: E402

SIZE, TILES = 256, 4
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
SYSTEMATIC = 1e-3  # of Mitsuba's tiles, relative; see references/README.md


# Mitsuba, in a process of its own


def prepare(variant, file):
    """One thread, the scene loaded, and its code compiled. What LLVM says as it gives up is long, and left out."""
    global scene
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
    mi.set_variant(variant)
    mi.set_log_level(mi.LogLevel.Error)
    dr.set_thread_count(1)
    scene = mi.load_file(file)
    mitsuba_render(16, 1 << 20)


def mitsuba_render(spp, seed):
    """CPU seconds of the rendering alone, and the image."""
    before = time.process_time()
    image = mi.render(scene, spp=spp, seed=seed)
    dr.eval(image)
    dr.sync_thread()
    seconds = time.process_time() - before
    return seconds, np.array(image.array, dtype=np.float64).reshape(SIZE, SIZE, 3)


def counted_rays(spp):
    """Rays a path of Mitsuba's `path`: nearest hits and shadow rays. It tells neither, so its walk is taken again here."""
    class Count(mi.SamplingIntegrator):
        @dr.syntax
        def sample(self, scene, sampler, ray, medium=None, active=True):
            ray, active = mi.Ray3f(ray), mi.Bool(active)
            throughput, depth = mi.Spectrum(1), mi.UInt32(0)
            nearest, shadow = mi.Float(0), mi.Float(0)
            while active:
                si = scene.ray_intersect(ray, mi.RayFlags.All, depth == 0, active)
                nearest += 1
                active &= si.is_valid()
                ds, _ = scene.sample_emitter_direction(si, sampler.next_2d(active), False, active)
                shadow += dr.select(active & (ds.pdf != 0), 1, 0)
                scattered, weight = si.bsdf(ray).sample(
                    mi.BSDFContext(), si, sampler.next_1d(active), sampler.next_2d(active), active
                )
                ray = si.spawn_ray(si.to_world(scattered.wo))
                throughput *= weight
                depth += 1
                largest = dr.max(throughput)
                q = dr.minimum(largest, 0.95)
                plays = depth >= 5
                goes_on = sampler.next_1d(active) < q
                throughput[plays] *= dr.rcp(q)
                active &= (~plays | goes_on) & (largest != 0)
            return mi.Color3f(nearest, shadow, 0), mi.Bool(True), []

    image = mi.render(scene, spp=spp, integrator=Count(mi.Properties()))
    return np.array(image.array, dtype=np.float64).reshape(-1, 3).mean(axis=0)[:2]


class Mitsuba:
    def __init__(self, variant, file, library=None):
        self.name = f"mitsuba {variant}"
        if library:
            os.environ["DRJIT_LIBLLVM_PATH"] = library
        spawn = multiprocessing.get_context("spawn")
        self.pool = ProcessPoolExecutor(1, spawn, prepare, (variant, file))

    def render(self, spp, number):
        return self.pool.submit(mitsuba_render, spp, number).result()


def fastest(file, libraries):
    """The LLVM that gives Mitsuba its best speed; None if it works with none of them."""
    best = None
    for library in libraries:
        candidate = Mitsuba("llvm_ad_rgb", file, library)
        try:
            candidate.render(16, 0)
            seconds = min(candidate.render(16, seed)[0] for seed in range(1, 5))
        except BrokenProcessPool:
            print(f"  {Path(library).name}: Mitsuba fails with it")
            continue
        print(f"  {Path(library).name}: {16 * SIZE * SIZE / seconds / 1e3:.0f} k paths a second")
        if best is None or seconds < best[0]:
            best = seconds, candidate
    return best and best[1]


# The bench


class Ours:
    def __init__(self, program, core, workload):
        self.name = f"{core}, {workload}"
        self.program, self.core, self.workload, self.rays = program, core, workload, 0.0

    def render(self, spp, number):
        pixels = f"{self.program}.pixels"
        args = [self.program, self.workload, self.core, str(spp), str(spp * number), str(SIZE), pixels]
        line = subprocess.run(args, check=True, capture_output=True, text=True).stdout.split()
        image = np.fromfile(pixels, dtype="<f8").reshape(SIZE, SIZE, 6)[:, :, :3]
        os.remove(pixels)
        self.rays = float(line[2]) / float(line[1])
        return float(line[0]), image


# What is made of it


class Runs:
    """Renderings by one renderer, with their CPU seconds."""

    def __init__(self, renderer, spp):
        self.renderer, self.spp, self.seconds, self.images = renderer, spp, [], []

    def add(self, number):
        seconds, image = self.renderer.render(self.spp, number)
        self.seconds.append(seconds)
        self.images.append(image)

    def finish(self):
        """Variance of a sample of luminance, mean over pixels and median pixel: from all renderings, and without each."""
        values = np.stack([image @ LUMINANCE for image in self.images])
        count = len(values)
        without = [np.delete(np.arange(count), i) for i in range(count)]
        variances = [self.spp * values[rows].var(axis=0, ddof=1) for rows in [np.arange(count), *without]]
        self.mean = [v.mean() for v in variances]
        self.median = [np.median(v) for v in variances]
        self.rates = [self.spp * SIZE * SIZE / seconds for seconds in self.seconds]


def interval(values):
    """Mean of logarithms, and its 95 % interval by Student's t, as ratios."""
    half = quantile(0.025, len(values) - 1) * statistics.stdev(values) / math.sqrt(len(values))
    middle = statistics.fmean(values)
    return f"{math.exp(middle):.2f} [{math.exp(middle - half):.2f}, {math.exp(middle + half):.2f}]"


def jackknifed(ours, theirs, times):
    """The same for the ratio of efficiencies, by pseudo-values [Tukey 1958]."""
    count = len(times)
    total = sum(times)
    all_but = [total / count] + [(total - t) / (count - 1) for t in times]
    logs = [math.log(b / a) + t for a, b, t in zip(ours, theirs, all_but)]
    return interval([count * logs[0] - (count - 1) * log for log in logs[1:]])


def table(runs):
    print(f"\n{'':24} {'k paths a CPU second':>28} {'variance of a sample':>24} {'efficiency':>24}")
    print(f"{'':24} {'median [range]':>28} {'mean':>12}{'median px':>12} {'mean':>12}{'median px':>12}")
    for run in runs:
        k = [rate / 1e3 for rate in run.rates]
        speed = f"{statistics.median(k):.0f} [{min(k):.0f}..{max(k):.0f}]"
        rate = statistics.median(run.rates)
        mean, median = run.mean[0], run.median[0]
        efficiency = f"{rate / mean / 1e6:>10.1f} M{rate / median / 1e6:>10.0f} M"
        print(f"{run.renderer.name:24} {speed:>28} {mean:>12.4f}{median:>12.5f} {efficiency}")


def ratios(ours, theirs):
    print("\nours / theirs, with 95 % intervals over the rounds")
    print(f"{'':46} {'paths a CPU second':>22} {'efficiency, mean':>22} {'efficiency, median px':>22}")
    for their in theirs:
        for our in ours:
            times = [math.log(b / a) for a, b in zip(our.seconds, their.seconds)]
            mean, median = jackknifed(our.mean, their.mean, times), jackknifed(our.median, their.median, times)
            print(f"{our.renderer.name + ' / ' + their.renderer.name:46} {interval(times):>22} {mean:>22} {median:>22}")


def same(ours, theirs, alpha):
    """Whether all measure the same image: its mean and its tiles."""
    edge = SIZE // TILES
    squares = [("image", slice(None), slice(None))]
    for y in range(TILES):
        for x in range(TILES):
            squares.append((f"tile {TILES * y + x}", slice(y * edge, y * edge + edge), slice(x * edge, x * edge + edge)))
    differences = []
    for their in theirs:
        for our in ours:
            for name, rows, columns in squares:
                for c, channel in enumerate("RGB"):
                    got, right = (mean_of([float(i[rows, columns, c].mean()) for i in r.images]) for r in [our, their])
                    bound = SYSTEMATIC * right.mean if name != "image" else 0.0
                    right = Value(right.mean, right.error, right.df, bound)
                    what = f"{our.renderer.name} / {their.renderer.name}: {name} {channel}"
                    differences.append(Difference(what, got, right, right.mean))
    for run in [*ours, *theirs]:
        means = [mean_of([float(i[:, :, c].mean()) for i in run.images]) for c in range(3)]
        print(f"{run.renderer.name:24} mean " + "  ".join(f"{m.mean:.6f} ± {m.error:.6f}" for m in means))
    return judge(differences, alpha)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scene")
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=12)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--alpha", type=float, default=1e-3)
    parser.add_argument("--libraries", nargs="*", default=[])
    args = parser.parse_args()

    print("Mitsuba's llvm_ad_rgb by LLVM:")
    llvm = fastest(args.scene, args.libraries)
    if llvm is None:
        print("  no LLVM here can compile its code; only scalar_rgb is compared")
    renderers = [Mitsuba("scalar_rgb", args.scene)] + [llvm] * (llvm is not None)
    theirs = [Runs(renderer, args.spp) for renderer in renderers]
    kinds = [(core, workload) for workload in ["light", "both"] for core in ["textbook", "fast"]]
    ours = [Runs(Ours(args.program, *kind), args.spp) for kind in kinds]

    print(f"{args.rounds} rounds, {args.spp} samples a pixel, {SIZE} x {SIZE} pixels; the first round is not counted")
    everyone = [*theirs, *ours]
    for number in range(args.rounds + 1):
        for run in everyone[number % len(everyone) :] + everyone[: number % len(everyone)]:
            if number == 0:
                run.renderer.render(args.spp, 0)
            else:
                run.add(number)
    for run in everyone:
        run.finish()
    table(everyone)
    if llvm:
        nearest, shadow = llvm.pool.submit(counted_rays, 16).result()
        print(f"{'mitsuba':24} {nearest + shadow:.2f} rays a path: {nearest:.2f} for the nearest hit, {shadow:.2f} shadow rays")
    for run in ours:
        print(f"{run.renderer.name:24} {run.renderer.rays:.2f} rays a path, shadow rays among them")
    ratios(ours, theirs)
    print()
    return 0 if same(ours, theirs, args.alpha) else 1


if __name__ == "__main__":
    sys.exit(main())
