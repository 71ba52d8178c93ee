"""Dots of a picture, part by part, on the workers of a Dask cluster: see docs/farm.md.

    pip install ./python 'dask[distributed]'
    python examples/farm/dask_parts.py pixels.npy 1000000 16 dots

PIXELS is an image as `twelvefold.stipple` takes it, written by `np.save`. The parts and the whole, dots.npy, go to
the folder, which all workers must see, as they must PIXELS. A part's file is there when it is whole; run again,
only missing parts are made. A worker that is killed is started again, and its part is made again by another;
--kill kills workers at random to show it, and --compare makes the whole at once, too, and compares.
"""

import argparse
import os
import random
import signal
import threading
import zlib
from contextlib import suppress
from pathlib import Path

import dask
import numpy as np
import twelvefold
from dask.distributed import Client, LocalCluster

# How often a part is made again: if it failed with an error, and if its worker was killed.
RETRIES = 3
DEATHS = 20


def save(path, array):
    """Writes an array beside `path` and renames it, so that `path` is whole or not there."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}")
    with open(unfinished, "wb") as file:
        np.save(file, array)
        file.flush()
        os.fsync(file.fileno())
    os.replace(unfinished, path)


def claim(folder, settings):
    """Keeps parts of another picture or with other arguments from being taken for this one's."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "settings"
    if path.exists() and path.read_text() != settings:
        raise SystemExit(f"{folder} holds parts of another picture or with other arguments; choose another folder")
    path.write_text(settings)


def part(pixels, dots, number, parts, seed, folder):
    """Makes part `number`, from 0, unless it is there; returns its path and how many dots it has."""
    path = folder / f"part-{number + 1:05}.npy"
    if not path.exists():
        # A map of the file: workers of one machine share its pages.
        image = np.load(pixels, mmap_mode="r")
        save(path, twelvefold.stipple(image, dots, refine=0, seed=seed, part=(number, parts)))
    return path, len(np.load(path, mmap_mode="r"))


def merge(made, path):
    """One array of all parts, which are (path, number of dots); only a part at a time is in memory."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}")
    shape = (sum(count for _, count in made), 2)
    whole = np.lib.format.open_memmap(unfinished, "w+", np.float32, shape)
    start = 0
    for name, count in made:
        whole[start : start + count] = np.load(name)
        start += count
    whole.flush()
    os.replace(unfinished, path)


def kill_some(cluster, client, count, done, killed):
    """Kills `count` workers of the cluster, each at random and busy with a part, until `done`."""
    while len(killed) < count and not done.wait(random.uniform(0, 1)):
        busy = {address for address, parts in client.processing().items() if parts}
        workers = [w for w in cluster.workers.values() if w.worker_address in busy and w.pid is not None]
        if workers:
            pid = random.choice(workers).pid
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
                killed.append(pid)


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("pixels", type=Path)
    arguments.add_argument("dots", type=int)
    arguments.add_argument("parts", type=int)
    arguments.add_argument("folder", type=Path)
    arguments.add_argument("--seed", type=int, default=0)
    arguments.add_argument("--workers", type=int, default=os.cpu_count())
    arguments.add_argument("--kill", type=int, default=0, metavar="N", help="kill workers at random, N times")
    arguments.add_argument("--compare", action="store_true", help="compare with the whole")
    given = arguments.parse_args()
    pixels, folder = given.pixels.resolve(), given.folder.resolve()
    picture = zlib.crc32(np.load(pixels, mmap_mode="r"))
    claim(folder, f"{picture} {given.dots} {given.parts} {given.seed}\n")

    # Dask gives up on a part whose workers died more often than that, 3 times unless told.
    dask.config.set({"distributed.scheduler.allowed-failures": DEATHS})
    done, killed = threading.Event(), []
    # One thread a worker: a part uses all cores that the package may use.
    cluster = LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None)
    with cluster, Client(cluster) as client:
        killer = threading.Thread(target=kill_some, args=(cluster, client, given.kill, done, killed))
        killer.start()
        try:
            jobs = [
                client.submit(
                    part, pixels, given.dots, i, given.parts, given.seed, folder, retries=RETRIES, pure=False
                )
                for i in range(given.parts)
            ]
            made = client.gather(jobs)
        finally:
            done.set()
            killer.join()
    merge(made, folder / "dots.npy")
    print(f"{sum(count for _, count in made)} dots in {given.parts} parts, {len(killed)} workers killed")
    if given.compare:
        whole = twelvefold.stipple(np.load(pixels), given.dots, refine=0, seed=given.seed)
        merged = np.load(folder / "dots.npy")
        if whole.dtype != merged.dtype or whole.tobytes() != merged.tobytes():
            raise SystemExit("the parts are not the whole")
        print("the parts are the whole, bit for bit")


if __name__ == "__main__":
    main()
