"""How long points take here and in scipy and poisson-disc, each at its best, and how even they are.

    pip install ./python[examples] && python python/benchmarks/timing.py

Every contender runs once a round, so that what else the machine does disturbs all alike; its time is the
least of its rounds. Only ratios of one run mean something. Sequences are made once and reset, since making
one costs more than a thousand of its points. PoissonDisk and poisson-disc take a radius: the one that gives
about as many points.
"""

import time

import numpy as np
import twelvefold
from poisson_disc import Bridson_sampling
from scipy.stats import qmc

#: Points of a maximal Poisson-disk set in a unit square, times the squared radius.
PACKED = 0.60


def rounds(contenders, seconds):
    """The least time of each contender, and its last points."""
    least = {name: np.inf for name in contenders}
    points = {}
    start = time.perf_counter()
    done = 0
    while done < 2 or time.perf_counter() - start < seconds:
        for name, make in contenders.items():
            if done >= 2 and least[name] > seconds / 100:
                continue
            before = time.perf_counter()
            points[name] = make()
            least[name] = min(least[name], time.perf_counter() - before)
        done += 1
    return least, points


def reset(engine, make):
    """Points from the beginning of a sequence."""

    def again():
        engine.reset()
        return make(engine)

    return again


def uniform(exponent):
    """Contenders for 2**exponent points in the unit square."""
    n = 2**exponent
    placement = twelvefold.Placement(seed=1)
    sobol, halton = qmc.Sobol(2, rng=1), qmc.Halton(2, rng=1)
    random = np.random.default_rng(1)
    contenders = {
        "twelvefold.sample": lambda: placement.sample(n=n),
        "twelvefold.sample, relaxed=False": lambda: placement.sample(n=n, relaxed=False),
        "twelvefold.exactly": lambda: placement.exactly(n=n)[0],
        "scipy Sobol": reset(sobol, lambda engine: engine.random_base2(exponent)),
        "scipy Halton": reset(halton, lambda engine: engine.random(n)),
        "scipy Halton, all cores": reset(halton, lambda engine: engine.random(n, workers=-1)),
        "numpy random": lambda: random.random((n, 2)),
    }
    if n <= 4096:
        radius = (PACKED / n) ** 0.5
        disk = qmc.PoissonDisk(2, radius=radius, rng=1)
        contenders["scipy PoissonDisk"] = reset(disk, lambda engine: engine.fill_space())
        contenders["poisson-disc"] = lambda: np.array(Bridson_sampling(radius=radius))
    return contenders


def inverted(density, points):
    """Points of the unit square, moved so that they follow a density: by row, then in the row."""
    height, width = density.shape
    rows = np.concatenate([[0], np.cumsum(density.sum(axis=1))])
    columns = np.concatenate([np.zeros((height, 1)), np.cumsum(density, axis=1)], axis=1)
    y = np.interp(points[:, 1] * rows[-1], rows, np.arange(height + 1))
    row = np.minimum(y.astype(int), height - 1)
    # All rows in one increasing list, so that one search finds each point's pixel.
    start = rows[:-1]
    increasing = (columns[:, 1:] + start[:, None]).ravel()
    target = start[row] + points[:, 0] * columns[row, -1]
    at = np.minimum(np.searchsorted(increasing, target, side="right"), row * width + width - 1)
    column = at - row * width
    x = column + (target - start[row] - columns[row, column]) / density[row, column]
    return np.stack([x, y], axis=1)


def on_an_image(exponent):
    """Contenders for 2**exponent points that follow an image."""
    n = 2**exponent
    y, x = np.mgrid[:512, :512] / 512
    image = (0.05 + np.exp(-20 * ((x - 0.5) ** 2 + (y - 0.4) ** 2))).astype("float32")
    image[300:400, 100:200] = 1
    sobol = qmc.Sobol(2, rng=1)
    contenders = {
        "twelvefold.sample": lambda: twelvefold.sample(image, n),
        "twelvefold.sample, relaxed=False": lambda: twelvefold.sample(image, n, relaxed=False),
        "twelvefold.stipple": lambda: twelvefold.stipple(1 - image / image.max(), n),
        "scipy Sobol, inverse CDF": reset(
            sobol, lambda engine: inverted(image, engine.random_base2(exponent))
        ),
    }
    return contenders, image


def table(title, contenders, image=None, seconds=20):
    """Prints times beside those of the first contender, and measures."""
    least, points = rounds(contenders, seconds)
    first = next(iter(least.values())) / len(next(iter(points.values())))
    print(f"\n{title}\n\n| | points | ns a point | time / first | nearest, mean | ", end="")
    print("star discrepancy |" if image is None else "variance in blocks |")
    print("|---|---:|---:|---:|---:|---:|")
    for name, set in points.items():
        each = least[name] / len(set)
        if image is None:
            measures = twelvefold.measure(set[:65_536]) if len(set) <= 65_536 else {}
            last = measures.get("star_discrepancy_at_least")
        else:
            measures = twelvefold.measure(set, importance=image)
            last = measures.get("block_variance")
        nearest = measures.get("nearest_mean" if image is None else "local_nearest_mean")
        shown = ["–" if value is None else f"{value:.2g}" for value in (nearest, last)]
        ns, ratio = f"{each * 1e9:.3g}", f"{each / first:.3g}"
        print(f"| {name} | {len(set):,} | {ns} | {ratio} | {shown[0]} | {shown[1]} |")


if __name__ == "__main__":
    table("4,096 points of the unit square", uniform(12))
    table("1,048,576 points of the unit square", uniform(20))
    contenders, image = on_an_image(16)
    table("65,536 points on an image of 512 × 512 pixels", contenders, image)
