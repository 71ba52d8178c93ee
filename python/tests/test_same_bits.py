"""The same inputs give the same points, bit for bit, through every door."""

import csv
import hashlib
import io
import itertools
import os
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest
import twelvefold
from conftest import REPOSITORY

OFF_CENTER = (-3.7, 5.1, 7.3, 2.9)


def golden_map(name):
    """The maps of the library's golden file: integer arithmetic alone."""
    if name == "ramp":
        y, x = np.mgrid[:200, :300]
        return (x * x // 64 + 3 * y).astype("float32") / np.float32(1024)
    if name == "texture":
        with np.errstate(over="ignore"):
            n = np.arange(256 * 256, dtype="uint64") ^ np.uint64(0x9E37_79B9)
            n = n * np.uint64(0xD129_42F0_5EA9_2B2D)
            n = ((n ^ (n >> np.uint64(31))) * np.uint64(0x94D0_49BB_1331_11EB)) >> np.uint64(40)
        return ((n & np.uint64(255)).astype("float32") / np.float32(64)).reshape(256, 256)
    if name == "edges":
        y, x = np.mgrid[:96, :128]
        return ((x // 16 + y // 16) % 2 == 0).astype("float32")
    y, x = np.mgrid[:256, :512]
    spot = 1 + (x // 64).astype("float32")
    spot[77, 300] = 30_000
    return spot


def line(name, points, ranks):
    """As the library's golden file has it."""
    order = np.argsort(ranks)
    columns = np.dtype([("rank", "<u8"), ("point", points.dtype.newbyteorder("<"), 2)])
    rows = np.empty(len(points), columns)
    rows["rank"], rows["point"] = ranks[order], points[order]
    precision = {"float32": "f32", "float64": "f64"}[points.dtype.name]
    return f"{name} {precision} {len(points)} {hashlib.sha256(rows.tobytes()).hexdigest()[:16]}"


def golden_cases():
    """Name, map, n, seed, domain, whether relaxed, whether seamless."""
    maps = ["ramp", "texture", "edges", "hot-spot"]
    for name, domain in {"unit": (0, 0, 1, 1), "3-2": (-3.7, 5.1, 7.5, 5.0)}.items():
        for relaxed in [False, True]:
            for n in [50, 1000, 40_000]:
                kind = "relaxed" if relaxed else "constant"
                yield f"seamless-{kind}-{name}-{n}", None, n, 1, domain, relaxed, True
            kind = "texture-relaxed" if relaxed else "texture"
            yield f"seamless-{kind}-{name}", "texture", 10_000, 1, domain, relaxed, True
    for seed, n in itertools.product([1, 2], [3, 50, 1000, 40_000]):
        yield f"constant-unit-{seed}-{n}", None, n, seed, None, False, False
        yield f"constant-off-center-{seed}-{n}", None, n, seed, OFF_CENTER, False, False
        for name in maps:
            yield f"{name}-{seed}-{n}", name, n, seed, None, False, False
        yield f"ramp-unit-{seed}-{n}", "ramp", n, seed, (0, 0, 1, 1), False, False
        yield f"texture-off-center-{seed}-{n}", "texture", n, seed, OFF_CENTER, False, False
        yield f"texture-power-of-two-{seed}-{n}", "texture", n, seed, (0, 0, 2, 2), False, False
    for seed in [1, 2]:
        for n in [40, 3000, 12_000, 40_000, 90_000]:
            yield f"relaxed-constant-unit-{seed}-{n}", None, n, seed, None, True, False
        for name in maps:
            yield f"relaxed-{name}-{seed}", name, 20_000, seed, None, True, False


@pytest.mark.parametrize("dtype", ["float32", "float64"])
def test_points_are_those_of_the_librarys_golden_file(dtype):
    golden = set((REPOSITORY / "tests/library/golden/points.txt").read_text().splitlines())
    wrong = []
    for name, importance, n, seed, domain, relaxed, seamless in golden_cases():
        importance = None if importance is None else golden_map(importance)
        wish = dict(seed=seed, domain=domain, relaxed=relaxed, seamless=seamless, dtype=dtype)
        points, ranks = twelvefold.sample(importance, n, ranks=True, **wish)
        if line(name, points, ranks) not in golden:
            wrong.append(name)
        # The fast way, without ranks.
        assert (twelvefold.sample(importance, n, **wish) == points).all()
        if seamless:
            kept = twelvefold.Placement(domain, seed, seamless=True)
            kept = kept.sample(importance, n, relaxed=relaxed, dtype=dtype)
            assert (kept == points).all()
    assert not wrong


def test_points_on_meshes_are_those_of_the_librarys_golden_file():
    golden = (REPOSITORY / "tests/library/golden/points.txt").read_text().splitlines()
    y, x = np.mgrid[:10, :13]
    vertices = np.stack([x, y, (x * x + 3 * y) % 7 / 4], axis=2).reshape(-1, 3)
    corner = (13 * y + x)[:9, :12].reshape(-1, 1)
    faces = (corner + [0, 1, 14, 0, 14, 13]).reshape(-1, 3)
    columns = np.dtype([("at", "<f8", 3), ("face", "<u4"), ("weights", "<f8", 3)])
    for seed, steps in itertools.product([1, 2], [0, 30]):
        for name, density in [("constant", None), ("density", (x * y % 5).ravel())]:
            made = twelvefold.mesh_points(
                vertices, faces, 1000, density=density, relax=steps, seed=seed
            )
            rows = np.empty(1000, columns)
            rows["at"], rows["face"], rows["weights"] = made
            hashed = hashlib.sha256(rows.tobytes()).hexdigest()[:16]
            assert f"mesh-{name}-{seed}-relaxed-{steps} f64 1000 {hashed}" in golden


def digest(array):
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()[:16]


def test_dots_and_directions_are_those_of_this_version(camera, esplanade):
    """The program's, as of this version: see the tests below."""
    found = {
        "refined": digest(twelvefold.stipple(camera, 3000, seed=5)),
        "raw": digest(twelvefold.stipple(camera, 3000, seed=5, refine=0)),
        "exact": digest(twelvefold.stipple(camera, 1000, exact=True)),
        "inverted": digest(twelvefold.stipple(camera, 1000, invert=True)),
        "linear": digest(twelvefold.stipple(camera, 1000, linear=True, white=230, gamma=1.3)),
        "best": digest(twelvefold.stipple(camera, 1000, best=True)),
    }
    for method in ["sobol", "progressive", "warp"]:
        directions, _, _ = twelvefold.environment(esplanade, 100, method=method, negative="zero")
        found[method] = digest(directions)
    assert found == GOLDEN


# Change them with the library's golden file, and say so in CHANGELOG.md.
GOLDEN = {
    "refined": "8a790baad6eed2e2",
    "raw": "ec70d91e0d81ea05",
    "exact": "c5943e27b1ba84b9",
    "inverted": "a82f20f553cb7f48",
    "linear": "e6f69e1ca8d2f449",
    "best": "132f3e60f64d057b",
    "sobol": "e6d3143a33759cc0",
    "progressive": "81d4fd6432026e42",
    "warp": "f83e52963d2be4ba",
}


def png(array):
    """A PNG file of (height, width[, channels]) of uint8 or uint16."""
    depth = 8 * array.itemsize
    height, width = array.shape[:2]
    color = {1: 0, 2: 4, 3: 2, 4: 6}[array.reshape(height, width, -1).shape[2]]
    rows = array.astype(array.dtype.newbyteorder(">")).reshape(height, -1)
    data = b"".join(b"\0" + row.tobytes() for row in rows)

    def chunk(name, content):
        check = struct.pack(">I", zlib.crc32(name + content))
        return struct.pack(">I", len(content)) + name + content + check

    header = struct.pack(">IIBBBBB", width, height, depth, color, 0, 0, 0)
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + chunks


@pytest.fixture
def photographs(camera):
    random = np.random.default_rng(4)
    rgb = np.stack([camera, camera.T, random.integers(0, 256, camera.shape, "uint8")], axis=2)
    alpha = np.where(np.arange(64) < 20, 0, 200).astype("uint8") * np.ones((64, 1), "uint8")
    return {
        "gray": camera,
        "gray 16": camera.astype("uint16") * 257 // 2 + 1000,
        "rgb": rgb,
        "gray alpha": np.dstack([camera, alpha]),
        "rgba": np.dstack([rgb, alpha]),
        "rgb 16": rgb.astype("uint16") * 200,
    }


@pytest.mark.parametrize("name", ["gray", "gray alpha", "gray 16", "rgb", "rgba", "rgb 16"])
@pytest.mark.parametrize(
    "keywords, options",
    [
        (dict(), ["-n", 2000]),
        (dict(refine=0, seed=3), ["-n", 2000, "--refine", 0, "--seed", 3]),
        (dict(refine=2, exact=True), ["--exact", 2000, "--refine", 2]),
        (dict(refine=0, exact=True), ["--exact", 2000, "--refine", 0]),
        (
            dict(refine=0, exact=True, relaxed=False),
            "--exact 2000 --refine 0 --centers fixed".split(),
        ),
        (dict(refine=0, relaxed=False), "-n 2000 --refine 0 --centers fixed".split()),
        (dict(invert=True, refine=1), ["-n", 2000, "--invert", "--refine", 1]),
        (dict(linear=True, refine=0), ["-n", 2000, "--linear", "--refine", 0]),
        (dict(gamma=1.7, refine=0), ["-n", 2000, "--gamma", 1.7, "--refine", 0]),
        (dict(linear=True, gamma=0.6, refine=1), "-n 2000 --linear --gamma 0.6 --refine 1".split()),
        (
            dict(black=20, white=230, gamma=1.2, linear=True, invert=True, refine=0),
            "-n 2000 --black 20 --white 230 --gamma 1.2 --linear --invert --refine 0".split(),
        ),
        (dict(white=200, best=True, refine=1), "-n 2000 --white 200 --best --refine 1".split()),
    ],
)
def test_dots_are_the_programs(program, tmp_path, photographs, name, keywords, options):
    photograph = photographs[name]
    path = tmp_path / "photo.png"
    path.write_bytes(png(photograph))
    dots = np.load(io.BytesIO(program("stipple", path, "-o", "-", "--format", "npy", "-q", *options)))
    # The program's levels are of 255 whatever the depth.
    scale = np.iinfo(photograph.dtype).max // 255
    levels = {level: scale * keywords[level] for level in ("black", "white") if level in keywords}
    ours = twelvefold.stipple(photograph, 2000, **{**keywords, **levels})
    assert dots.dtype == ours.dtype == np.float32
    assert dots.tobytes() == ours.tobytes()


@pytest.mark.parametrize("method", ["sobol", "progressive", "warp"])
@pytest.mark.parametrize("frame", ["pbrt", "mitsuba", "blender", "gltf", "openexr"])
def test_directions_are_the_programs(program, esplanade, method, frame):
    path = REPOSITORY / "tests/library/data/esplanade-64.pfm"
    options = ["--method", method, "--frame", frame, "--rotate", 30, "--seed", 4, "--negative", "zero"]
    table = program("envmap", path, "-n", 50, "-o", "-", *options).decode()
    rows = np.array([list(map(float, row)) for row in list(csv.reader(io.StringIO(table)))[1:]])
    directions, pdf, radiance = twelvefold.environment(
        esplanade, 50, method=method, frame=frame, rotate=30, seed=4, negative="zero"
    )
    assert (rows[:, :3] == directions).all()
    assert (rows[:, 3] == pdf).all()
    assert (rows[:, 4:].astype("float32") == radiance).all()


def test_measures_are_the_programs(program, tmp_path):
    points = twelvefold.sample(n=500, seed=2, dtype="float64")
    path = tmp_path / "points.csv"
    path.write_text("x,y\n" + "".join(f"{x!r},{y!r}\n" for x, y in points.tolist()))
    table = dict(csv.reader(io.StringIO(program("measure", path).decode())))
    ours = twelvefold.measure(points)
    assert ours["points"] == float(table["points"]) == len(points)
    star = ours["star_discrepancy_at_least"]
    assert star == ours["star_discrepancy_at_most"] == float(table["star discrepancy"])
    assert ours["nearest_mean"] == float(table["nearest mean"])
    assert ours["low_frequency_power"] == float(table["low-frequency power"])


@pytest.mark.parametrize("threads", ["1", "3"])
def test_the_number_of_threads_does_not_matter(threads):
    code = (
        "import hashlib, numpy, twelvefold\n"
        "ramp = numpy.arange(5000, dtype='uint8').reshape(50, 100)\n"
        "for points in (twelvefold.sample(n=300_000), twelvefold.stipple(ramp, 3000)):\n"
        "    print(hashlib.sha256(points.tobytes()).hexdigest())\n"
    )
    environment = dict(os.environ, RAYON_NUM_THREADS=threads)
    run = [sys.executable, "-c", code]
    alone = subprocess.run(run, env=environment, check=True, capture_output=True).stdout.split()
    ramp = np.arange(5000, dtype="uint8").reshape(50, 100)
    here = [twelvefold.sample(n=300_000), twelvefold.stipple(ramp, 3000)]
    assert [hashlib.sha256(p.tobytes()).hexdigest().encode() for p in here] == alone
