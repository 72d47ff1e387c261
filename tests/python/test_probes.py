"""The light at many points of a scene."""

import numpy as np
import pytest

import domelight as dl

SMALL = {"size": 16, "spp": 4, "bounces": 1}


def test_probes_in_memory_are_those_of_the_files(sky, tmp_path):
    memory = dl.probes("spheres", sky, grid=(2, 1, 1), **SMALL)
    files = dl.probes("spheres", sky, tmp_path / "set", grid=(2, 1, 1), threads=1, **SMALL)
    again = dl.ProbeSet(tmp_path / "set")
    assert len(memory) == len(files) == len(again) == 2 and again.grid == (2, 1, 1)
    assert memory.positions.shape == (2, 3) and memory.harmonics.shape == (2, 9, 3) and memory.valid.shape == (2,)
    directions = np.random.default_rng(1).normal(size=(5, 4, 3))
    for roughness in (0, 0.4, 1):
        found = memory.radiance(1, directions, roughness)
        assert found.shape == (5, 4, 3) and found.max() > 0
        assert found.tobytes() == again.radiance(1, directions, roughness).tobytes()
    assert memory.irradiance_over_pi(0, [0, 1, 0]).shape == (3,)


def test_probes_are_the_program_s(program, tmp_path):
    program("sky", "-o", tmp_path / "sky.exr", "--height", 32, "--exr", "float")
    program("probes", "ball", "--env", tmp_path / "sky.exr", "-o", tmp_path / "a", "--at", "0,1,3", "--at", "3,1,0", "--size", 16, "--spp", 4)
    dl.probes("ball", tmp_path / "sky.exr", tmp_path / "b", at=[[0, 1, 3], [3, 1, 0]], size=16, spp=4)
    for name in ("specular.ktx2", "irradiance.ktx2", "distance.ktx2", "probes.json"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes(), name


def test_under_a_uniform_sky_the_blend_is_uniform():
    ones = np.ones((16, 32, 3), np.float32)
    set = dl.probes("ball", ones, at=[[0, 50, 0], [5, 50, 0]], size=16, spp=1)
    points = np.array([[0, 50, 0], [2, 51, 0], [4, 50, 1]])
    assert np.abs(set.irradiance_over_pi_at(points, [0, 1, 0]) - 1).max() < 0.01
    assert np.abs(set.irradiance_over_pi_at(points, [0, 1, 0], visibility=False) - 1).max() < 0.01


def test_errors_name_the_keyword(sky, tmp_path):
    for words, field in [({}, "at"), ({"grid": (0, 1, 1)}, "grid"), ({"grid": (1, 1)}, "grid"), ({"density": -1}, "density"), ({"auto": 3}, "auto"),
                         ({"grid": (1, 1, 1), "size": 4}, "size"), ({"grid": (1, 1, 1), "encoding": "bc6h"}, "encoding"),
                         ({"grid": (1, 1, 1), "region": [0] * 6}, "region")]:
        with pytest.raises(dl.Error) as caught:
            dl.probes("spheres", sky, tmp_path / "none", **{**SMALL, **words})
        assert caught.value.field == field, words
    assert not (tmp_path / "none").exists()
    with pytest.raises(dl.FileError):
        dl.ProbeSet(tmp_path)
    with pytest.raises(dl.Error):
        dl.probes("spheres", sky, at=[1, 2])
    set = dl.probes("spheres", sky, grid=(1, 1, 1), **SMALL)
    with pytest.raises(dl.Error):
        set.radiance(1, [0, 1, 0])


def test_a_capture_is_cancelled(sky):
    with pytest.raises(dl.Cancelled):
        dl.probes("spheres", sky, grid=(4, 4, 4), spp=256, progress=lambda *_: False)
