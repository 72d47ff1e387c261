"""Filters, by what is known of their results."""

import math

import numpy as np
import pytest

import domelight as dl


def test_a_constant_stays_constant():
    ones = np.ones((32, 64, 3), np.float32)
    for level in dl.prefilter(ones, size=16, levels=3):
        assert np.allclose(level, 1, atol=1e-5)
    assert np.allclose(dl.irradiance(ones, size=8), math.pi, rtol=1e-5)
    assert np.allclose(dl.irradiance(ones, size=8, over_pi=True), 1, rtol=1e-5)


def test_shapes(light):
    assert [level.shape for level in dl.prefilter(light, size=16, levels=2)] == [(6, 16, 16, 3), (6, 8, 8, 3)]
    assert dl.prefilter(light, size=16, levels=1, layout="latlong")[0].shape == (16, 32, 3)
    assert dl.irradiance(light, size=4).shape == (6, 4, 4, 3)
    assert dl.irradiance(light, size=4, layout="latlong").shape == (4, 8, 3)
    assert dl.spherical_harmonics(light, 4).shape == (16, 3)
    assert dl.brdf_table(16).shape == (16, 16, 2)
    assert dl.brdf_table(16, form="scale-bias-charlie").shape == (16, 16, 3)


def test_directions_are_texel_centres(light):
    level = dl.prefilter(light, size=8, roughness=[0.6], texels="centre")[0]
    # Face +Z: direction (s, -t, 1).
    s = (np.arange(8) + 0.5) / 4 - 1
    directions = np.stack(np.broadcast_arrays(s[None, :], -s[:, None], 1.0), -1).reshape(-1, 3)
    single = dl.prefilter(light, roughness=[0.6], directions=directions)
    assert single[0].shape == (64, 3) and single.layout == "directions" and single._repr_png_() is None
    assert np.allclose(single[0].reshape(8, 8, 3), level[4], rtol=2e-5)


def test_irradiance_of_a_direction_is_that_of_the_harmonics():
    y = np.cos((np.arange(64) + 0.5) / 64 * np.pi)
    image = np.broadcast_to((1 + 0.5 * y)[:, None, None], (64, 128, 3)).astype(np.float32)  # 1 + y / 2, bilinear
    up = dl.irradiance(image, directions=[[0, 1, 0]])[0]
    assert np.allclose(up, math.pi * (1 + 0.5 * 2 / 3), rtol=1e-3)
    assert np.allclose(dl.spherical_harmonics(image)[1], 0.5 / 0.488603, rtol=1e-3)


def test_the_last_level_is_irradiance_over_pi(light):
    last = dl.prefilter(light, size=8, roughness=[1.0], texels="centre")[0]
    assert np.array_equal(last, dl.irradiance(light, size=8, over_pi=True))


def test_harmonics_of_irradiance(light):
    radiance, irradiance = dl.spherical_harmonics(light), dl.spherical_harmonics(light, irradiance=True)
    factors = math.pi * np.array([1, 2 / 3, 2 / 3, 2 / 3, 0.25, 0.25, 0.25, 0.25, 0.25])
    assert np.allclose(irradiance, radiance * factors[:, None])


def test_brdf_table_agrees_with_montecarlo():
    exact, drawn = dl.brdf_table(8), dl.brdf_table(8, method="montecarlo", samples=4096)
    assert np.abs(exact - drawn).max() < 0.01


def test_levels_are_a_sequence(light):
    levels = dl.prefilter(light, size=16, levels=3)
    assert len(levels) == 3 and levels[-1].shape[1] == 4 and len(levels[1:]) == 2
    assert levels.roughness[0] == 0 and levels.roughness[2] == 1 and levels.mirror == [True, False, False]
    assert repr(levels) == "<domelight.Levels ggx, cube: 16, 8, 4>"


def test_a_cube_is_an_environment(light):
    cube = dl.convert(light, "cube", size=16)
    assert cube.shape == (6, 16, 16, 3)
    a, b = dl.irradiance(cube, size=4), dl.irradiance(light, size=4)
    assert np.allclose(a, b, rtol=0.02)


@pytest.mark.parametrize("name", ["latlong/usd", "latlong/materialx", "latlong/mod", "octahedral", "equal-area-octahedral"])
def test_light_comes_from_the_same_direction_in_every_projection(name):
    axes = dl.axes(64)
    again = dl.Environment(dl.convert(axes, name, size=64), name)
    directions = np.vstack([np.eye(3), -np.eye(3)]) + 0.02
    assert np.allclose(again.radiance(directions), axes.radiance(directions), atol=0.25)
    assert np.allclose(dl.irradiance(again, directions=directions), dl.irradiance(axes, directions=directions), rtol=0.02)
