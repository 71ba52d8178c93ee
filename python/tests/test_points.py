"""Points are those of the library, and arguments mean what they say."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import twelvefold

IMAGE = (np.arange(64 * 48) % 97).reshape(48, 64).astype("float32")


def test_points_lie_where_importance_is():
    half = np.zeros((10, 20))
    half[:, 10:] = 1
    points = twelvefold.sample(half, 2000)
    assert points.dtype == np.float32 and points.shape[1] == 2
    assert abs(len(points) - 2000) < 40
    assert points[:, 0].min() >= 10 and points[:, 0].max() < 20
    assert 0 <= points[:, 1].min() and points[:, 1].max() < 10


def test_the_same_arguments_give_the_same_bits():
    first = twelvefold.sample(IMAGE, 3000, seed=5)
    assert (first == twelvefold.sample(IMAGE, 3000, seed=5)).all()
    assert len(first) != len(twelvefold.sample(IMAGE, 3000, seed=6)) or (
        first != twelvefold.sample(IMAGE, 3000, seed=6)
    ).any()


@pytest.mark.parametrize("relaxed", [True, False])
@pytest.mark.parametrize("count", [1, 2, 7])
def test_parts_one_after_the_other_are_the_whole(relaxed, count):
    whole = twelvefold.sample(IMAGE, 5000, relaxed=relaxed)
    parts = [
        twelvefold.sample(IMAGE, 5000, relaxed=relaxed, part=(i, count)) for i in range(count)
    ]
    assert (np.concatenate(parts) == whole).all()


def test_a_kept_placement_gives_what_the_function_gives():
    placement = twelvefold.Placement((0, 0, 64, 48), seed=9)
    assert placement.seed == 9 and placement.domain == (0, 0, 64, 48)
    for _ in range(2):
        expected = twelvefold.sample(IMAGE, 1000, seed=9)
        assert (placement.sample(IMAGE, 1000) == expected).all()


def test_weights_estimate_integrals():
    points, weights = twelvefold.sample(n=4096, relaxed=False, weights=True)
    assert abs((points[:, 0] * points[:, 1] * weights).sum() - 0.25) < 0.01


def test_exactly_n_and_its_beginnings():
    points, weights = twelvefold.exactly(IMAGE, 1000)
    assert points.shape == (1000, 2) and weights.shape == (1000,)
    assert (twelvefold.exactly(IMAGE, 100)[0] == points[:100]).all()


def test_density_and_domain():
    points = twelvefold.sample(density=100.0, domain=(-1, 5, 3, 2), dtype="float64")
    assert abs(len(points) - 600) < 30
    assert (points >= [-1, 5]).all() and (points < [2, 7]).all()


def test_directions_follow_the_light():
    sky = np.full((16, 32, 3), 0.1)
    sky[3, 8] = 500.0
    for method in ("progressive", "warp"):
        directions, pdf, radiance = twelvefold.environment(sky, 256, method=method)
        assert directions.shape == (256, 3) and radiance.dtype == np.float32
        assert np.allclose(np.linalg.norm(directions, axis=1), 1)
        # A quarter of the width is +y.
        assert (radiance[:, 0] > 1).mean() > 0.8 and directions[:, 1].mean() > 0.3
        mean = (radiance[:, 0] / pdf).mean() / (4 * np.pi)
        assert abs(mean / 1.071 - 1) < 0.05


def test_the_lock_is_released():
    ran = []
    thread = threading.Thread(target=lambda: ran.append(len(twelvefold.sample(n=3e6))))
    thread.start()
    while thread.is_alive():
        time.sleep(0.001)
    assert ran


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
def test_an_interrupt_ends_a_long_call_within_a_second():
    code = "import twelvefold\nprint('on', flush=True)\ntwelvefold.sample(n=2e9, relaxed=True, dtype='float64')"
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )
    process.stdout.readline()
    time.sleep(0.5)
    start = time.monotonic()
    process.send_signal(signal.SIGINT)
    _, complaint = process.communicate(timeout=10)
    assert time.monotonic() - start < 1.5
    assert b"KeyboardInterrupt" in complaint
