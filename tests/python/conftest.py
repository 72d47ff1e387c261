"""Environments that the tests share. DOMELIGHT_PROGRAM is the program to compare with, DOMELIGHT_DATA the test data."""

import os
import pathlib
import struct
import subprocess

import numpy as np
import pytest

import domelight as dl


def small_environment(height=32, seed=1):
    """Smooth light with a small sun, the same each time."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0 : 2 * height]
    image = 0.2 + rng.random((height, 2 * height, 3)) * 0.1 + (1 + np.cos(x / height * np.pi))[..., None] * [0.3, 0.2, 0.1]
    image[height // 4, height // 3] += [60, 50, 40]
    return image.astype(np.float32)


@pytest.fixture
def light():
    return small_environment()


@pytest.fixture(scope="session")
def program():
    name = os.environ.get("DOMELIGHT_PROGRAM")
    if not name:
        pytest.skip("DOMELIGHT_PROGRAM is not set")

    def run(*words, cwd=None):
        subprocess.run([name, *map(str, words), "--quiet"], check=True, cwd=cwd)

    return run


@pytest.fixture(scope="session")
def photograph():
    folder = os.environ.get("DOMELIGHT_DATA")
    if not folder:
        pytest.skip("DOMELIGHT_DATA is not set")
    return pathlib.Path(folder) / "env_latlong" / "noon_grass_1k.hdr"


@pytest.fixture(scope="session")
def sky():
    return dl.sky(64)


def ktx2_levels(file):
    """The bytes of each level of an uncompressed KTX2 file."""
    data = pathlib.Path(file).read_bytes()
    count = max(1, struct.unpack_from("<I", data, 40)[0])
    places = [struct.unpack_from("<QQQ", data, 80 + 24 * level) for level in range(count)]
    return [data[offset : offset + length] for offset, length, _ in places]


def ktx2_floats(file):
    """The levels of an rgba32f cube as arrays of shape (6, size, size, 3)."""
    levels = []
    for data in ktx2_levels(file):
        texels = np.frombuffer(data, np.float32).reshape(6, -1, 4)
        size = int(round(texels.shape[1] ** 0.5))
        levels.append(texels.reshape(6, size, size, 4)[..., :3])
    return levels


def png_size(data):
    """Width and height of a PNG."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    return struct.unpack(">II", data[16:24])
