"""Where the numbers of tests/images_are_compared_as_published.rs come from: the authors' own program, in single precision.

    pip install flip-evaluator==1.7 numpy && python tests/golden/flip.py

Prints for each pair of pictures, which the test makes by the same formulas, the mean of the map, its largest value, and its
values at a third and at two thirds of the pixels, in the order of rows.
"""

import sys

import flip_evaluator
import numpy as np


def random(i):
    """A number in [0, 1) of 24 bits."""
    x = i * 2654435761 % 2**32
    x ^= x >> 16
    x = x * 2246822519 % 2**32
    x ^= x >> 13
    return (x >> 8) / 2**24


def noise(seed):
    return lambda x, y, w, h: [random(seed * 1000003 + 3 * (y * w + x) + c) for c in range(3)]


def edge(place):
    return lambda x, y, w, h: [0.875, 0.25, 0.125] if x < place else [0.125, 0.25, 0.75]


def box(x, y, w, h):
    """A red wall, a green wall, a lamp."""
    if 8 * y < h and 3 * w <= 8 * x < 5 * w:
        return [16.0, 12.0, 8.0]
    wall = [0.5, 0.0625, 0.0625] if 4 * x < w else [0.0625, 0.5, 0.0625] if 4 * x >= 3 * w else [0.5, 0.5, 0.5]
    return [v * (h - y) / h for v in wall]


def steep(x, y, w, h):
    """Sixteen stops."""
    stops, mantissa = noise(4)(x, y, w, h), noise(5)(x, y, w, h)
    return [2.0 ** int(16 * stops[0] - 8) * (0.5 + m) for m in mantissa]


def noisy(picture, seed):
    def noised(x, y, w, h):
        factors = noise(seed)(x, y, w, h)
        return [v * (0.5 + f) for v, f in zip(picture(x, y, w, h), factors)]

    return noised


def black(x, y, w, h):
    return [0.0, 0.0, 0.0]


PAIRS = {
    "noise": (32, 32, noise(1), noise(2)),
    "edge": (48, 20, edge(24), edge(27)),
    "box": (32, 32, box, noisy(box, 3)),
    "large box": (128, 128, box, noisy(box, 3)),
    "steep": (24, 40, steep, noisy(steep, 6)),
    "black": (16, 8, black, noise(7)),
    "alike": (16, 8, box, box),
}


def picture(formula, w, h):
    return np.array([[formula(x, y, w, h) for x in range(w)] for y in range(h)], dtype=np.float32)


for name, (w, h, reference, image) in PAIRS.items():
    reference, image = picture(reference, w, h), picture(image, w, h)
    # the program finds no exposure for a black reference
    for kind in ["LDR", "HDR"] if reference.any() else ["LDR"]:
        pair = [np.clip(p, 0, 1) for p in (reference, image)] if kind == "LDR" else [reference, image]
        found, mean, used = flip_evaluator.evaluate(*pair, kind, inputsRGB=False, applyMagma=False)
        values = found.reshape(-1)
        print(f'("{name}", "{kind}", [{mean:.7}, {values.max():.7}, {values[w * h // 3]:.7}, {values[w * h * 2 // 3]:.7}]),')
        if len(sys.argv) > 1:
            print(used)
            np.savetxt(f"{sys.argv[1]}/{name.replace(' ', '_')}_{kind}.txt", values)
