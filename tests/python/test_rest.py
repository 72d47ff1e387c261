"""Sampling, lights, comparing, writing, and pictures in notebooks."""

import math

import numpy as np
import pytest

import domelight as dl
from conftest import png_size


def test_the_estimate_of_all_light_is_exact_for_power(light):
    sampler = dl.Sampler(light)
    s = sampler.sample(1 << 14)
    assert np.allclose(np.linalg.norm(s.direction, axis=1), 1, atol=1e-5)
    mean = (s.radiance / s.pdf_solid_angle[:, None]).mean(0) / (4 * math.pi)
    expected = dl.spherical_harmonics(light)[0] / math.sqrt(4 * math.pi)
    assert np.allclose(mean, expected, rtol=0.01)


@pytest.mark.parametrize("method", ["bilinear", "guided", "binary", "alias", "hierarchical", "linear", "walk", "bilinear-plain"])
def test_samples_have_their_density(light, method):
    sampler = dl.Sampler(light, method=method)
    s = sampler.sample(1000, sequence="random")
    assert np.allclose(sampler.pdf(s.direction), s.pdf_solid_angle, rtol=2e-2, atol=1e-3)
    assert np.allclose(sampler.radiance(s.direction), s.radiance, rtol=2e-2, atol=1e-2)


def test_points_of_every_type_are_the_same(light):
    sampler = dl.Sampler(light)
    fixed = dl.unit_points(4096, "sobol", 3)
    wanted = sampler.sample(fixed).array
    assert np.array_equal(wanted, sampler.sample(4096, sequence="sobol", seed=3).array)
    assert np.array_equal(wanted, sampler.sample(fixed * 2.0**-32).array)
    assert np.array_equal(wanted, sampler.sample(np.asfortranarray(fixed)).array)
    assert np.allclose(wanted, sampler.sample((fixed * 2.0**-32).astype(np.float32)).array, rtol=1e-3, atol=1e-3)


def test_samples_go_where_they_are_wanted(light):
    out = np.empty((9, 100_000), np.float32)
    samples = dl.Sampler(light).sample(100_000, out=out)
    assert samples.array is out and np.shares_memory(samples.direction, out)
    assert len(dl.Sampler(light).sample(0)) == 0


def test_pdf_takes_any_shape(light):
    sampler = dl.Sampler(light)
    directions = np.random.default_rng(1).normal(size=(4, 5, 6, 3)).astype(np.float32)
    assert sampler.pdf(directions).shape == (4, 5, 6)
    assert sampler.radiance(directions).shape == (4, 5, 6, 3)
    assert np.isclose(sampler.pdf([0, 1, 0]), sampler.pdf([[0, 5, 0]])[0])


def test_lights_and_remainder_are_the_whole():
    sky = dl.sky(256)
    found = dl.lights(sky)
    sun = found[0]
    assert len(found) == 1 and sun.resolved is False and found.unaccounted < 1e-6
    elevation = math.degrees(math.asin(sun.direction[1]))
    assert abs(elevation - 30) < 0.5
    power = dl.spherical_harmonics(sky)[0] - dl.spherical_harmonics(found.remainder)[0]
    assert np.allclose(power * math.sqrt(4 * math.pi), sun.irradiance, rtol=0.01)


def test_comparisons():
    rng = np.random.default_rng(2)
    reference = rng.random((48, 64, 3), np.float32)
    test = (reference * 1.1).astype(np.float32)
    result = dl.compare(test, reference)
    assert math.isclose(result["relative"], 0.1, rel_tol=1e-4) and math.isclose(result["mean-ratio"], 1.1, rel_tol=1e-4)
    assert result.map("difference").shape == (48, 64) and 0 < result["flip"] < 1
    assert dl.compare(reference, reference)["rmse"] == 0
    assert np.isclose(dl.flip(test, reference).mean(), result["hdr-flip"], rtol=1e-5)
    assert dl.flip(reference, reference, hdr=False).max() == 0
    mask = np.zeros((48, 64), np.float32)
    mask[:10] = 1
    assert dl.compare(test, reference, mask=mask)["pixels"] == 640
    test[3, 4] = np.nan
    with pytest.raises(dl.Error, match="1 pixel is NaN or infinite, the first at row 3, column 4"):
        dl.compare(test, reference)
    assert dl.compare(test, reference, skip_bad=True)["pixels"] == 48 * 64 - 1


def test_pictures_of_bytes_are_compared():
    rng = np.random.default_rng(4)
    a, b = (rng.integers(0, 256, (48, 64, 3), np.uint8) for _ in range(2))
    assert dl.compare(a, a)["largest"] == 0
    decoded = np.where(a <= 10, a / 255 / 12.92, ((a / 255 + 0.055) / 1.055) ** 2.4).astype(np.float32)
    assert dl.compare(decoded, a, flip=False)["largest"] < 1e-6
    # Strides of any kind, as of every other array.
    wanted = dl.compare(a[:, ::2].copy(), b[:, ::2].copy()).figures
    assert dl.compare(a[:, ::2], b[:, ::2]).figures == wanted
    assert dl.compare(a[::-1, ::-2][::-1, ::-1], b[:, 1::2]).figures == dl.compare(a[:, 1::2].copy(), b[:, 1::2].copy()).figures


@pytest.mark.parametrize("shape", [(48, 64), (48, 64, 4), (0, 64, 3), (70000, 1, 3), (3, 48, 64)])
def test_pictures_of_bytes_of_a_wrong_shape(shape):
    for keyword, pair in (("test", [0, 1]), ("reference", [1, 0])):
        pictures = [np.zeros(shape, np.uint8), np.zeros((48, 64, 3), np.uint8)]
        with pytest.raises(dl.Error, match=f"^{keyword}: shape is ") as caught:
            dl.compare(*(pictures[i] for i in pair))
        assert caught.value.field == keyword


def test_variance_explains_noise():
    rng = np.random.default_rng(3)
    a, b = (rng.normal(1, 0.1, (64, 64, 3)).astype(np.float32) for _ in range(2))
    variance = np.full((64, 64, 3), 0.01, np.float32)
    assert 0.9 < dl.compare(a, b, test_variance=variance, reference_variance=variance, flip=False)["chi2"] < 1.1


def test_an_audit_recognises_a_mirrored_bake(light):
    levels = dl.prefilter(light, size=32, levels=3, texels="centre")
    assert dl.audit(levels, light, within=0.01).within
    mirrored = [np.ascontiguousarray(level[[1, 0, 2, 3, 4, 5], :, ::-1]) for level in levels]
    found = dl.audit(mirrored, light, roughness=levels.roughness)
    assert "mirrored in x" in found.orientation and found.of_source
    assert abs(found.levels[2].roughness - 1) < 0.1


def test_a_cube_as_a_lat_long_map_is_what_its_sampler_reads(light):
    cube = dl.Environment(dl.convert(light, "cube", size=16))
    latlong = cube.latlong()
    height, width, _ = latlong.shape
    theta, phi = np.meshgrid((np.arange(height) + 0.5) / height * np.pi, ((np.arange(width) + 0.5) / width - 0.5) * 2 * np.pi, indexing="ij")
    directions = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], -1)
    assert np.allclose(dl.Sampler(cube).radiance(directions), latlong, rtol=1e-4, atol=1e-5)


def test_files_come_back(light, tmp_path):
    for name, tolerance in [("a.exr", 1e-3), ("a.hdr", 1e-2), ("a.ktx2", 1e-3)]:
        dl.write(tmp_path / name, light)
        back = dl.read(tmp_path / name).latlong() if name != "a.ktx2" else light
        assert np.allclose(back, light, rtol=tolerance, atol=tolerance)
    dl.write(tmp_path / "f.exr", light, half=False)
    assert np.array_equal(dl.read(tmp_path / "f.exr").latlong(), light)
    levels = dl.prefilter(light, size=16, levels=3)
    for name in ("c.ktx2", "c.ktx", "c.dds"):
        dl.write(tmp_path / name, levels, encoding="rgba32f")
        assert np.allclose(dl.convert(dl.read(tmp_path / name), "cube", size=16), levels[0], rtol=1e-4, atol=1e-4)
    dl.write(tmp_path / "p.png", light)
    dl.write(tmp_path / "p.jpg", (np.clip(light, 0, 1) * 255).astype(np.uint8))
    assert (tmp_path / "p.png").read_bytes()[:4] == b"\x89PNG"


def test_a_notebook_shows_things(light, tmp_path):
    environment = dl.Environment(light)
    assert png_size(environment._repr_png_()) == (64, 32)
    assert png_size(dl.prefilter(environment, size=16, levels=3)._repr_png_())[0] == 1600
    sampler = dl.Sampler(environment)
    assert png_size(sampler.sample(100)._repr_png_())[0] >= 1024
    assert png_size(sampler._repr_png_())[0] >= 1024
    assert png_size(dl.compare(light, light)._repr_png_())[0] > 64
    assert png_size(dl.bake(environment, tmp_path / "out", size=16)._repr_png_())[0] == 1600


def test_a_bake_tells_what_it_wrote(light, tmp_path):
    made = dl.bake(light, tmp_path, ["generic", "three"], size=32)
    assert [bake.engine for bake in made] == ["generic", "three"]
    assert made[0].manifest["specular"]["levels"][0]["size"] == 32
    assert {path.name for path in made[0].files} >= {"specular.ktx2", "manifest.json", "preview.png"}
    assert "filament" in dl.engines()


def test_the_package_s_examples():
    import doctest

    from domelight import _environment, _sampling

    for module in (dl, _environment, _sampling):
        assert doctest.testmod(module).failed == 0


def test_a_chain_is_read_and_audited(light, tmp_path):
    levels = dl.prefilter(light, size=32, levels=3)
    dl.write(tmp_path / "c.ktx2", levels, encoding="rgba32f")
    back = dl.read_levels(tmp_path / "c.ktx2")
    assert all(np.array_equal(a, b) for a, b in zip(back, levels, strict=True))
    assert np.allclose(back.roughness, levels.roughness) and (back.texels, back.lobe) == ("read", "ggx")
    assert dl.audit(tmp_path / "c.ktx2", light, within=0.01).within
    dl.write(tmp_path / "l.ktx2", dl.prefilter(light, size=64, levels=3, layout="latlong"))
    assert dl.read_levels(tmp_path / "l.ktx2")[0].shape == (64, 128, 3)
    with pytest.raises(dl.FileError):
        dl.read_levels(tmp_path / "none.ktx2")


def test_a_file_in_memory_is_read(light, tmp_path):
    dl.write(tmp_path / "a.exr", light, half=False)
    contents = (tmp_path / "a.exr").read_bytes()
    for kind in (bytes, bytearray, memoryview):
        assert np.array_equal(dl.read(kind(contents)).latlong(), light)
    with pytest.raises(dl.FileError, match="the bytes: "):
        dl.read(b"nothing")
