"""The same bytes as the program, which is the C++ library."""

import hashlib

import numpy as np
import pytest

import domelight as dl
from conftest import ktx2_floats


def digests(folder):
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in folder.iterdir()}


def test_prefilter_has_the_texels_of_a_bake(program, photograph, tmp_path):
    program("bake", photograph, "-o", tmp_path, "--size", 128, "--levels", 5, "--encoding", "rgba32f", "--no-preview")
    levels = dl.prefilter(dl.read(photograph), size=128, levels=5)
    baked = ktx2_floats(tmp_path / "specular.ktx2")
    assert len(levels) == len(baked) == 5
    for ours, theirs in zip(levels, baked):
        assert ours.dtype == np.float32 and ours.tobytes() == theirs.tobytes()


@pytest.mark.parametrize("words", [{}, {"texels": "centre"}, {"lobe": "charlie"}, {"lobe": "phong", "levels": 3}])
def test_prefilter_has_the_texels_of_the_words(program, tmp_path, words):
    program("sky", "-o", tmp_path / "sky.exr", "--height", 64, "--exr", "float")
    options = [text for name, value in words.items() for text in (f"--{name}", value)]
    program("bake", tmp_path / "sky.exr", "-o", tmp_path / "out", "--size", 32, "--encoding", "rgba32f", *options)
    levels = dl.prefilter(tmp_path / "sky.exr", size=32, **words)
    for ours, theirs in zip(levels, ktx2_floats(tmp_path / "out" / "specular.ktx2"), strict=True):
        assert ours.tobytes() == theirs.tobytes()


def test_a_bake_has_the_bytes_of_the_program(program, photograph, tmp_path):
    program("bake", photograph, "-o", tmp_path / "a", "--size", 64, "--for", "three", "--for", "filament")
    dl.bake(dl.read(photograph), tmp_path / "b", ["three", "filament"], size=64)
    for engine in ("three", "filament"):
        assert digests(tmp_path / "a" / engine) == digests(tmp_path / "b" / engine)


def test_an_array_has_the_levels_of_its_file(photograph):
    environment = dl.read(photograph)
    array = np.array(environment)
    for ours, theirs in zip(dl.prefilter(array, size=64, levels=3), dl.prefilter(environment, size=64, levels=3)):
        assert ours.tobytes() == theirs.tobytes()


def test_samples_are_those_of_the_program(program, photograph, tmp_path):
    program("sample", photograph, "-n", 64, "--sequence", "sobol", "--seed", 7, "-o", tmp_path / "s.csv")
    rows = np.genfromtxt(tmp_path / "s.csv", delimiter=",", names=True)
    samples = dl.Sampler(photograph).sample(64, sequence="sobol", seed=7)
    assert np.allclose(samples.u, rows["u"], atol=1e-6)
    assert np.allclose(samples.pdf_solid_angle, rows["pdf_solid_angle"], rtol=1e-4)


def test_conversions_are_those_of_the_program(program, photograph, tmp_path):
    program("convert", photograph, "-o", tmp_path / "usd.exr", "--to", "latlong/usd", "--encoding", "float")
    theirs = dl.read(tmp_path / "usd.exr").latlong()  # in USD's convention, which an .exr does not state
    assert np.array_equal(dl.convert(photograph, "latlong/usd"), theirs)


def test_threads_do_not_change_a_bit(light):
    one, two = (dl.prefilter(light, size=32, levels=4, threads=n) for n in (1, 2))
    assert all(a.tobytes() == b.tobytes() for a, b in zip(one, two))
