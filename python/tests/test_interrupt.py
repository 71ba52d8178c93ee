"""Python's lock is released, and Ctrl-C ends every long call within a second."""

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import twelvefold

#: Seconds of work each, of at most some gigabytes if it were not interrupted.
LONG = {
    "sample": "sample(n=1e9)",
    "sample of an image": "sample(np.arange(10**6).reshape(1000, 1000) % 7, 3e8)",
    "part": "sample(n=4e8, part=(0, 2))",
    "weights": "sample(n=2e8, relaxed=False, weights=True)",
    "ranks": "sample(n=3e8, ranks=True)",
    "exactly": "exactly(n=20_000_000)",
    "stipple": "stipple(np.zeros((2000, 2000)), 5_000_000)",
    "refine": "stipple(np.zeros((500, 500)), 300_000, refine=1000)",
    "best": "stipple(np.zeros((500, 500)), 100_000, refine=1000, best=True)",
    "mesh": "mesh_points(np.eye(3), [[0, 1, 2]], 300_000, relax=1000)",
    "environment": "environment(np.ones((64, 128, 3)), 60_000_000)",
    "measure": "measure(np.random.default_rng(0).random((65_000, 2)))",
}


@pytest.mark.skipif(os.name != "posix", reason="signals of POSIX")
@pytest.mark.parametrize("name", LONG)
def test_an_interrupt_ends_a_long_call_within_a_second(name):
    code = f"""
import threading, time, sys
import numpy as np, twelvefold
# While the call runs, another thread can speak.
threading.Timer(0.4, lambda: print('on', flush=True)).start()
try:
    twelvefold.{LONG[name]}
except KeyboardInterrupt:
    # Not taken for another interrupt's: the package still works.
    assert len(twelvefold.sample(n=1000)) > 900
    print('interrupted', flush=True)
"""
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE)
    try:
        assert process.stdout.readline() == b"on\n"
        start = time.monotonic()
        process.send_signal(signal.SIGINT)
        assert process.stdout.readline() == b"interrupted\n"
        assert time.monotonic() - start < 1
    finally:
        process.kill()
        process.communicate()


def test_another_thread_runs_meanwhile():
    done = []
    work = threading.Thread(target=lambda: done.append(len(twelvefold.sample(n=20_000_000))))
    turns = 0
    work.start()
    while work.is_alive():
        time.sleep(0.001)
        turns += 1
    assert done and turns > 5


def test_threads_get_what_one_gets():
    image = np.random.default_rng(3).random((50, 60))
    expected = [twelvefold.stipple(image, 2000, seed=seed).tobytes() for seed in range(6)]
    found = [None] * 6

    def work(seed):
        found[seed] = twelvefold.stipple(image, 2000, seed=seed).tobytes()

    threads = [threading.Thread(target=work, args=(seed,)) for seed in range(6)]
    [thread.start() for thread in threads]
    [thread.join() for thread in threads]
    assert found == expected
