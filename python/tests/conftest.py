"""What several tests need."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program():
    """The program `twelvefold` of the environment variable TWELVEFOLD_PROGRAM, run with arguments."""
    path = os.environ.get("TWELVEFOLD_PROGRAM")
    if path is None:
        pytest.skip("TWELVEFOLD_PROGRAM does not say where the program is")

    def run(*arguments):
        return subprocess.run([path, *map(str, arguments)], check=True, capture_output=True).stdout

    return run


@pytest.fixture(scope="session")
def camera():
    """A small photograph, (64, 64) of uint8."""
    pgm = (REPOSITORY / "tests/library/data/camera-64.pgm").read_bytes()
    return np.frombuffer(pgm[-64 * 64 :], "uint8").reshape(64, 64)


@pytest.fixture(scope="session")
def esplanade():
    """A small environment map, (32, 64, 3) of float32; the sun in one pixel."""
    pfm = (REPOSITORY / "tests/library/data/esplanade-64.pfm").read_bytes()
    # Rows from the bottom.
    return np.frombuffer(pfm[-64 * 32 * 12 :], "<f4").reshape(32, 64, 3)[::-1]
