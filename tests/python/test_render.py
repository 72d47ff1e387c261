"""Pictures by the second extension."""

import subprocess
import sys

import numpy as np
import pytest

import domelight as dl
from conftest import png_size


def test_embree_is_loaded_only_for_a_picture():
    code = """
import domelight as dl, sys
maps = lambda: any("embree" in line for line in open("/proc/self/maps"))
dl.irradiance(dl.sky(16), size=2)
assert not maps()
dl.render("ball", dl.sky(16), width=8, spp=1)
assert maps()
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_picture_has_layers(sky):
    picture = dl.render("ball", sky, width=32, height=24, spp=4)
    assert picture.radiance.shape == (24, 32, 3) and np.isfinite(picture.radiance).all()
    assert picture["opacity"].shape == (24, 32) and picture["normal"].shape == (24, 32, 3)
    assert png_size(picture._repr_png_()) == (32, 24)
    again = dl.render("ball", sky, width=32, height=24, spp=4, threads=1)
    assert picture.radiance.tobytes() == again.radiance.tobytes()


def test_a_furnace_is_white():
    ones = np.ones((16, 32, 3), np.float32)
    picture = dl.render("furnace", ones, width=16, spp=64, multiple_scattering=True)
    assert abs(picture.radiance.mean() - 1) < 0.02


@pytest.mark.parametrize("shading", ["split-sum", "stretched", "phong", "mirror", "refract"])
def test_shading_as_engines_do(sky, shading):
    picture = dl.render("spheres", sky, width=24, height=12, spp=1, shading=shading)
    assert np.isfinite(picture.radiance).all() and picture.radiance.max() > 0


def test_the_picture_is_the_program_s(program, tmp_path):
    program("sky", "-o", tmp_path / "sky.exr", "--height", 32, "--exr", "float")
    program("render", "ball", "--env", tmp_path / "sky.exr", "-o", tmp_path / "a.exr", "--width", 24, "--spp", 2)
    ours = dl.render("ball", tmp_path / "sky.exr", width=24, spp=2)
    assert dl.compare(ours.radiance, tmp_path / "a.exr", flip=False)["largest"] == 0


def test_errors_name_the_keyword(sky, tmp_path):
    for words, field in [({"spp": 0}, "spp"), ({"fov_deg": 200}, "fov_deg"), ({"shading": "toon"}, "shading"),
                         ({"strategy": "luck"}, "strategy"), ({"camera_position": [1, 2]}, "camera_position")]:
        with pytest.raises(dl.Error) as caught:
            dl.render("ball", sky, width=8, **words)
        assert caught.value.field == field
    with pytest.raises(dl.FileError):
        dl.render(tmp_path / "none.glb", sky)


def test_a_render_is_cancelled(sky):
    with pytest.raises(dl.Cancelled):
        dl.render("ball", sky, width=256, spp=4096, progress=lambda *_: False)
