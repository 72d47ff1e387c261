"""Conventions of research projects, each against the mapping in that project's own code, written down a second time here.

Each function gives the world directions of the samples of a height x width map, with the file and function that it follows.
"""

import math

import numpy as np
import pytest

import domelight as dl


def nvdiffrec(height, width):
    """NVlabs/nvdiffrec render/util.py, cubemap_to_latlong: gy from 0 to 1 and gx from -1 to 1 at texel centres, the direction is
    (sin θ sin φ, cos θ, -sin θ cos φ) with θ = π gy, φ = π gx. GaussianShader's scene/NVDIFFREC/util.py has the same."""
    gy = np.linspace(1 / height / 2, 1 - 1 / height / 2, height)[:, None] * math.pi
    gx = np.linspace(-1 + 1 / width, 1 - 1 / width, width)[None, :] * math.pi
    return np.stack(np.broadcast_arrays(np.sin(gy) * np.sin(gx), np.cos(gy), -np.sin(gy) * np.cos(gx)), -1)


def stanford_orb(height, width):
    """StanfordORB/Stanford-ORB orb/utils/env_map.py, env_map_to_cam_to_world_by_convention, convention "ours":
    θ from -π/2 to 3π/2 over the columns, φ from 0 to π over the rows, both ends included; the direction is
    (-cos θ sin φ, cos φ, -sin θ sin φ)."""
    theta = np.linspace(-0.5 * math.pi, 1.5 * math.pi, width)[None, :]
    phi = np.linspace(0, math.pi, height)[:, None]
    return np.stack(np.broadcast_arrays(-np.cos(theta) * np.sin(phi), np.cos(phi), -np.sin(theta) * np.sin(phi)), -1)


def mitsuba(height, width):
    """mitsuba-renderer/mitsuba3 src/emitters/envmap.cpp, uv_to_direction: θ = π v, φ = 2π u, the direction is
    (sin φ sin θ, cos θ, -cos φ sin θ). eval_spectrum reads column u W - 1/2 and row v (H - 1)."""
    theta = np.linspace(0, math.pi, height)[:, None]
    phi = (np.arange(width) + 0.5)[None, :] / width * 2 * math.pi
    return np.stack(np.broadcast_arrays(np.sin(phi) * np.sin(theta), np.cos(theta), -np.cos(phi) * np.sin(theta)), -1)


DIRECTIONS = {"nvdiffrec": nvdiffrec, "gaussianshader": nvdiffrec, "stanford-orb": stanford_orb, "mitsuba": mitsuba}


def light_from(direction):
    """Smooth light that is different from every direction, and its linear harmonics are known."""
    x, y, z = np.moveaxis(np.asarray(direction), -1, 0)
    return np.stack([2 + x, 2 + y, 2 + z], -1).astype(np.float32)


def test_each_convention_names_its_source():
    assert set(dl.conventions.CONVENTIONS) == set(DIRECTIONS)
    assert all("/" in each.source and ":" in each.source for each in dl.conventions.CONVENTIONS.values())


@pytest.mark.parametrize("name", DIRECTIONS)
def test_light_is_read_from_where_the_project_has_it(name):
    environment = dl.Environment(light_from(DIRECTIONS[name](64, 128)), name)
    directions = np.random.default_rng(1).normal(size=(50, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    assert np.allclose(environment.radiance(directions), light_from(directions), atol=3e-3)
    # Y_1 = √(3/4π) (y, z, x): red is 2 + x, green 2 + y, blue 2 + z.
    linear = dl.spherical_harmonics(environment)[1:4] * math.sqrt(3 / (4 * math.pi))
    assert np.allclose(linear, [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=3e-3)


@pytest.mark.parametrize("name", DIRECTIONS)
def test_light_is_written_where_the_project_looks_for_it(name):
    source = dl.Environment(light_from(nvdiffrec(128, 256)), "nvdiffrec")
    written = dl.convert(source, name, size=64)
    wanted = light_from(DIRECTIONS[name](64, 128))
    assert written.shape == wanted.shape and np.abs(written - wanted).max() < 0.03


def test_cubes_lie_as_nvdiffrast_reads_them():
    """NVlabs/nvdiffrec render/util.py, cube_to_dir: (1, -y, -x), (-1, -y, x), (x, 1, y), (x, -1, -y), (x, -y, 1), (-x, -y, -1)
    for x to the right and y down."""
    x, y = np.meshgrid((np.arange(16) + 0.5) / 8 - 1, (np.arange(16) + 0.5) / 8 - 1)
    one = np.ones_like(x)
    faces = [(one, -y, -x), (-one, -y, x), (x, one, y), (x, -one, -y), (x, -y, one), (-x, -y, -one)]
    directions = np.stack([np.stack(face, -1) for face in faces])
    directions /= np.linalg.norm(directions, axis=-1, keepdims=True)
    cube = dl.convert(dl.Environment(light_from(nvdiffrec(128, 256)), "nvdiffrec"), "cube", size=16)
    assert np.abs(cube - light_from(directions)).max() < 0.03


def test_nvdiffrec_s_roughness():
    """render/light.py, build_mips: 512² down to 16² are six levels, from 0.08 to 0.5 in equal steps and then 1."""
    assert np.allclose(dl.conventions.nvdiffrec_roughness(6), [0.08, 0.185, 0.29, 0.395, 0.5, 1])


def test_a_file_is_read_in_a_project_s_convention(tmp_path):
    dl.write(tmp_path / "orb.exr", light_from(stanford_orb(64, 128)), half=False)
    environment = dl.read(tmp_path / "orb.exr", projection="stanford-orb")
    assert np.allclose(environment.radiance([[1, 0, 0], [0, 0, 1]]), [[3, 2, 2], [2, 2, 3]], atol=3e-3)
