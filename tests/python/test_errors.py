"""Bad input: one clear sentence, which names the keyword, and no crash."""

import pickle
import warnings

import numpy as np
import pytest

import domelight as dl


def error_of(call, kind=dl.Error):
    with pytest.raises(kind) as caught:
        call()
    error = caught.value
    assert isinstance(error, ValueError) and "\n" not in error.message and len(error.message) < 200
    return error


CASES = [
    (lambda light: dl.prefilter(light, size=0), "size", "0 is not from 1 to 16384"),
    (lambda light: dl.prefilter(light, size=2**40), "size", "1099511627776 is too large"),
    (lambda light: dl.prefilter(light, levels=50), "levels", "50 levels, but a map of size 512 has from 1 to 10"),
    (lambda light: dl.prefilter(light, roughness=[0.5, 2]), "roughness", "2 is not from 0 to 1"),
    (lambda light: dl.prefilter(light, roughness=[float("nan")]), "roughness", "nan is not from 0 to 1"),
    (lambda light: dl.prefilter(light, lobe="blinn"), "lobe", '"blinn" is not a lobe'),
    (lambda light: dl.prefilter(light, exponents=[3]), "exponents", "belongs to lobe phong"),
    (lambda light: dl.prefilter(light, threads=-1), "threads", "-1 is not from 0 to 1024"),
    (lambda light: dl.prefilter(light, directions=[[0, 0, 0]], roughness=[1]), "directions", "direction 0 is (0, 0, 0)"),
    (lambda light: dl.prefilter(light, directions=[[0, 1]], roughness=[1]), "directions", "expected directions"),
    (lambda light: dl.prefilter(light, directions=[[0, 1, 0]]), "roughness", "is missing"),
    (lambda light: dl.irradiance(light, size=5000), "size", "5000 is not from 1 to 4096"),
    (lambda light: dl.irradiance(light, layout="sphere"), "layout", '"sphere" is not a layout'),
    (lambda light: dl.spherical_harmonics(light, 65), "sh_bands", "65 is not from 1 to 64"),
    (lambda light: dl.brdf_table(0), "size", "0 is not from 1 to 4096"),
    (lambda light: dl.brdf_table(8, g="walter"), "g", '"walter" is not a masking function'),
    (lambda light: dl.sky(turbidity=11), "turbidity", "11 is not from 1 to 10"),
    (lambda light: dl.Sampler(light, uniform_share=2), "uniform_share", "2 is not from 0 to 1"),
    (lambda light: dl.Sampler(light, method="magic"), "method", '"magic" is not a method of sampling'),
    (lambda light: dl.Sampler(light).sample(4, sequence="magic"), "sequence", '"magic" is not a sequence'),
    (lambda light: dl.Sampler(light).sample(np.zeros((4, 3))), "points", "expected an array of shape (count, 2)"),
    (lambda light: dl.Sampler(light).sample(4, out=np.empty((9, 5), np.float32)), "out", "expected a writable"),
    (lambda light: dl.Sampler(light).pdf([[0, 0, 0]]), "directions", "direction 0 is (0, 0, 0), which points nowhere"),
    (lambda light: dl.Sampler(light).pdf([1, 2]), "directions", "shape is (2,), expected (..., 3)"),
    (lambda light: dl.lights(light, max_lights=-1), "max_lights", "-1 is not from 0 to 1024"),
    (lambda light: dl.convert(light, "mercator"), "to", 'unknown projection "mercator"'),
    (lambda light: dl.Environment(light[:, :32], "mirror-ball/fov=200"), "projection", "a mirror ball's fov must lie"),
    (lambda light: dl.convert(light, size=0), "size", "0 is not from 1 to 32768"),
    (lambda light: dl.convert(light, turn=np.ones((3, 3))), "turn", "expected an orthogonal 3 x 3 matrix"),
    (lambda light: dl.compare(light, light[:, :8]), "test", "is 64 x 32, but the reference is 8 x 32"),
    (lambda light: dl.audit([light], light), "levels", "lat-long levels cannot be audited"),
    (lambda light: dl.bake(light, "out", "nonesuch"), "engines", '"nonesuch" is not an engine'),
    (lambda light: dl.bake(light, "out", irradiance="lux"), "irradiance", '"lux" is not a quantity'),
    (lambda light: dl.bake(light, "out", samples=0), "samples", "0 is not from 1 to 2^24"),
    (lambda light: dl.write("x.tga", light), "file", '".tga" is not an ending of an image'),
]


@pytest.mark.parametrize("call, field, words", CASES, ids=[f"{field}-{i}" for i, (_, field, _) in enumerate(CASES)])
def test_the_error_names_the_keyword(light, tmp_path, monkeypatch, call, field, words):
    monkeypatch.chdir(tmp_path)
    error = error_of(lambda: call(light))
    assert error.field == field and error.message.startswith(words) and str(error).startswith(f"{field}: ")
    assert not list(tmp_path.iterdir())


TYPES = [
    (lambda light: dl.prefilter(light, size="large"), "size", "'large' is a str, expected a whole number"),
    (lambda light: dl.prefilter(light, size=16.5), "size", "16.5 is a float, expected a whole number"),
    (lambda light: dl.prefilter(light, roughness=0.5), "roughness", "0.5 is a float, expected a sequence of numbers"),
    (lambda light: dl.prefilter(light, lobe=3), "lobe", "3 is an int, expected a str"),
    (lambda light: dl.prefilter(light, progress=3), "progress", "3 is an int, expected a function"),
    (lambda light: dl.Sampler(light).sample(2.5), "points", "2.5 is a float, expected a whole number or an array"),
    (lambda light: dl.Sampler(light).sample(True), "points", "True is a bool, expected a whole number or an array"),
    (lambda light: dl.Sampler(light).sample(None), "points", "None is a NoneType, expected a whole number or an array"),
]


@pytest.mark.parametrize("call, field, words", TYPES, ids=[str(i) for i in range(len(TYPES))])
def test_a_wrong_type_is_a_type_error_too(light, call, field, words):
    error = error_of(lambda: call(light), dl.WrongType)
    assert isinstance(error, TypeError) and error.field == field and error.message.startswith(words)


def freed(light):
    torch = pytest.importorskip("torch", reason="PyTorch is not installed")
    tensor = torch.tensor(light)
    tensor.untyped_storage().resize_(0)
    return tensor


def released(light):
    view = memoryview(light.copy())
    view.release()
    return view


def with_value(light, value):
    light = light.copy()
    light[3, 5, 1] = value
    return light


ARRAYS = [
    (lambda light: light.astype(np.uint8), "dtype is uint8, expected float32"),
    (lambda light: light.astype(np.int64), "dtype is int64, expected float32"),
    (lambda light: light.astype(np.complex64), "dtype is complex64, expected float32"),
    (lambda light: light.astype(object), "no array of numbers can be read from this ndarray"),
    (lambda light: light.astype(">f4"), "no array of numbers can be read from this ndarray"),
    (lambda light: light[..., 0], "shape is (32, 64), expected (height, width, 3)"),
    (lambda light: np.dstack([light, light[..., :1]]), "shape is (32, 64, 4), expected (height, width, 3)"),
    (lambda light: np.moveaxis(light, -1, 0), "shape is (3, 32, 64), expected (height, width, 3)"),
    (lambda light: light[:0], "shape is (0, 64, 3), expected sides from 1 to 65536"),
    (lambda light: light[:, :40], "the array is 40 x 32, but a lat-long map is twice as wide as high"),
    (lambda light: np.stack([light] * 6), "the array is 64 x 32 x 6, but a lat-long map"),
    (lambda light: np.float32(3), "shape is (), expected (height, width, 3)"),
    (lambda light: 3, "no array of numbers can be read from this int"),
    (lambda light: None, "no array of numbers can be read from this NoneType"),
    (released, "no array of numbers can be read from this memoryview"),
    (freed, "the array's memory has been freed"),
    (lambda light: with_value(light, np.nan), "nan at row 3, column 5, channel 1 is no radiance"),
    (lambda light: with_value(light, np.inf), "inf at row 3, column 5, channel 1 is no radiance"),
    (lambda light: with_value(light, -1), "-1 at row 3, column 5, channel 1 is no radiance"),
    (lambda light: with_value(light.astype(np.float64), 1e300), "inf at row 3, column 5, channel 1 is no radiance"),
]


@pytest.mark.parametrize("make, words", ARRAYS, ids=[words[:40] for _, words in ARRAYS])
def test_a_wrong_array_is_told_of(light, make, words):
    array = make(light)
    error = error_of(lambda: dl.prefilter(array, size=8))
    assert error.field == "environment" and error.message.startswith(words)


def test_a_tensor_that_requires_a_gradient(light):
    torch = pytest.importorskip("torch", reason="PyTorch is not installed")
    error = error_of(lambda: dl.prefilter(torch.from_numpy(light).requires_grad_(), size=8))
    assert "requires a gradient" in error.message and "detach" in error.hint


def test_a_misspelt_projection_is_told_of_the_projects_conventions(light):
    error = error_of(lambda: dl.Environment(light, "nvdifrec"))
    assert error.field == "projection" and "latlong" in error.hint and "nvdiffrec" in error.hint


def test_files(tmp_path):
    missing = error_of(lambda: dl.read(tmp_path / "none.hdr"), dl.FileError)
    assert isinstance(missing, OSError) and missing.filename == str(tmp_path / "none.hdr")
    assert isinstance(missing, dl.FileError) and missing.errno == 2
    (tmp_path / "broken.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\nnothing")
    with pytest.raises(dl.FileError):
        dl.prefilter(dl.read(tmp_path / "broken.hdr"), size=8)
    with pytest.raises(OSError):
        dl.write(tmp_path / "none" / "x.hdr", np.ones((4, 8, 3), np.float32))
    assert error_of(lambda: dl.read(tmp_path / "x.hdr", projection="flat")).field == "projection"
    assert error_of(lambda: dl.read(tmp_path / "x.hdr", exposure=99)).field == "exposure"


def test_the_words_are_the_library_s(program, light):
    import os
    import subprocess

    told = subprocess.run([os.environ["DOMELIGHT_PROGRAM"], "bake", "-o", "x", "--levels", "50"], capture_output=True, text=True)
    ours = error_of(lambda: dl.prefilter(light, levels=50))
    assert told.stderr.strip() == f"error: --{ours.field}: {ours.message}"


def test_bad_texels_of_a_file_are_told_of(tmp_path):
    image = np.ones((8, 16, 3), np.float32)
    image[2, 3] = np.nan
    dl.write(tmp_path / "bad.exr", image)
    environment = dl.read(tmp_path / "bad.exr")
    with pytest.warns(dl.DomelightWarning, match="1 not a number") as told:
        dl.irradiance(environment, size=2)
    assert told[0].filename == __file__  # the warning points at the caller's line
    with warnings.catch_warnings():
        warnings.simplefilter("error")  # once is enough
        dl.irradiance(environment, size=2)
    assert np.isfinite(environment.latlong()).all()
    assert environment.report["not_a_number"] == 1


def test_a_memory_that_does_not_suffice(light):
    with pytest.raises((MemoryError, dl.Error)):
        dl.Sampler(light).sample(2**31)


def test_errors_can_be_pickled(light):
    error = error_of(lambda: dl.prefilter(light, size=0))
    again = pickle.loads(pickle.dumps(error))
    assert (type(again), str(again), again.field) == (type(error), str(error), error.field)
