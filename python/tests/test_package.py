"""The package as one finds it: documentation, types, a fork."""

import doctest
import inspect
import multiprocessing
import os
import pydoc
import subprocess
import sys
from importlib.resources import files

import numpy as np
import pytest
import twelvefold

FUNCTIONS = [name for name in twelvefold.__all__ if name != "__version__"]


def test_examples_in_the_documentation_are_right():
    failed, tried = doctest.testmod(twelvefold)
    assert not failed and tried > 2 * len(FUNCTIONS)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_help_tells_every_argument(name):
    function = getattr(twelvefold, name)
    text = pydoc.plain(pydoc.render_doc(function))
    assert "Parameters" in text and "(*args" not in text
    listed = text[text.index("Parameters\n") :]
    for argument in inspect.signature(function).parameters:
        assert argument in listed, argument


def test_stubs_have_the_signatures_of_the_functions(tmp_path):
    """stubtest compares names, kinds and defaults; the example below is checked with the stubs."""
    assert files("twelvefold").joinpath("py.typed").is_file()
    run = [sys.executable, "-m", "mypy.stubtest", "twelvefold", "--ignore-missing-stub"]
    found = subprocess.run(run, cwd=tmp_path, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_types_are_checked(tmp_path):
    (tmp_path / "good.py").write_text(
        "import numpy as np, twelvefold\n"
        "dots = twelvefold.stipple(np.zeros((3, 3)), 10, exact=True)\n"
        "x: float = float(dots[0, 0])\n"
        "points, weights = twelvefold.sample(n=10, relaxed=False, weights=True)\n"
        "points, ranks = twelvefold.Placement(seed=3).sample(n=10, ranks=True)\n"
        "directions, pdf, radiance = twelvefold.environment(np.ones((2, 4, 3)), 3, method='warp')\n"
        "tile = twelvefold.sample(np.ones((3, 2)), 10, seamless=True)\n"
        "where, on, weights = twelvefold.mesh_points(np.eye(3), [[0, 1, 2]], 9, density=[1, 2, 3])\n"
        "mean: float = twelvefold.measure(dots)['nearest_mean']\n"
    )
    (tmp_path / "bad.py").write_text(
        "import numpy as np, twelvefold\n"
        "twelvefold.environment(np.ones((2, 4, 3)), 3, method='best')\n"
        "a, b = twelvefold.sample(n=10)\n"
        "twelvefold.stipple(np.ones((2, 4)), '3')\n"
    )
    run = [sys.executable, "-m", "mypy", "--strict"]
    good = subprocess.run([*run, "good.py"], cwd=tmp_path, capture_output=True, text=True)
    assert good.returncode == 0, good.stdout
    bad = subprocess.run([*run, "bad.py"], cwd=tmp_path, capture_output=True, text=True)
    assert all(f"bad.py:{line}:" in bad.stdout for line in (2, 4)), bad.stdout


def part(i):
    return twelvefold.sample(n=200_000, part=(i, 4))


# What Python warns of since 3.12: a child has none of its parent's threads. So it gets its own.
@pytest.mark.filterwarnings("ignore:.*multi-threaded:DeprecationWarning")
@pytest.mark.parametrize("start", multiprocessing.get_all_start_methods())
def test_processes_make_parts_however_they_start(start):
    whole = twelvefold.sample(n=200_000)
    with multiprocessing.get_context(start).Pool(2) as pool:
        parts = pool.map_async(part, range(4)).get(timeout=60)
    assert np.concatenate(parts).tobytes() == whole.tobytes()
