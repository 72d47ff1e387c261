"""Python and the C interface give the same bytes. The C interface is called here by ctypes."""

import ctypes as c
import os
import pathlib

import numpy as np
import pytest

import domelight as dl


class Pixels(c.Structure):
    _fields_ = [("struct_size", c.c_size_t), ("data", c.c_void_p), *((name, c.c_int32) for name in
                ("width", "height", "faces", "channels", "bits", "row_stride"))]


class Level(c.Structure):
    _fields_ = [("struct_size", c.c_size_t), ("lobe", c.c_char_p), ("roughness", c.c_double), ("exponent", c.c_double), ("size", c.c_int32)]


class PrefilterOptions(c.Structure):
    _fields_ = [("struct_size", c.c_size_t), ("layout", c.c_char_p), ("texels", c.c_char_p), ("levels", c.POINTER(Level)),
                ("level_count", c.c_size_t), ("directions", c.c_void_p), ("direction_count", c.c_size_t), ("world_to_source", c.c_void_p),
                ("irradiance_size", c.c_int32), ("sh_bands", c.c_int32), ("threads", c.c_int32), ("progress", c.c_void_p),
                ("progress_data", c.c_void_p)]


@pytest.fixture(scope="module")
def library():
    file = pathlib.Path(os.environ.get("DOMELIGHT_BUILD", "")) / "libdomelight_c.so"
    if not file.is_file():
        pytest.skip("the C interface is not built")
    library = c.CDLL(str(file))
    library.domelight_filtered_sh.restype = c.POINTER(c.c_double)
    for function in (library.domelight_environment_from_pixels, library.domelight_prefilter, library.domelight_filtered_level,
                     library.domelight_filtered_irradiance_over_pi):
        function.restype = c.c_void_p  # NULL: no error
    return library


def initialised(library, struct, name):
    value = struct()
    getattr(library, f"domelight_{name}_init_sized")(c.byref(value), c.c_size_t(c.sizeof(value)))
    return value


def array_of(pixels):
    shape = (pixels.faces, pixels.height, pixels.width, pixels.channels)
    return np.ctypeslib.as_array(c.cast(pixels.data, c.POINTER(c.c_float)), shape).copy()


def test_filters_have_the_bytes_of_c(library, light):
    given = initialised(library, Pixels, "pixels")
    given.data, given.width, given.height = light.ctypes.data, light.shape[1], light.shape[0]
    environment, filtered = c.c_void_p(), c.c_void_p()
    assert not library.domelight_environment_from_pixels(c.byref(given), None, c.byref(environment))
    roughness = [0, 0.3, 0.7, 1]
    levels = (Level * len(roughness))()
    for i, value in enumerate(roughness):
        levels[i] = initialised(library, Level, "level")
        levels[i].roughness, levels[i].size = value, 32 >> i
    options = initialised(library, PrefilterOptions, "prefilter_options")
    options.levels, options.level_count, options.irradiance_size, options.sh_bands = levels, len(roughness), 8, 4
    options.texels = b"read"
    assert not library.domelight_prefilter(environment, c.byref(options), c.byref(filtered))

    pixels = initialised(library, Pixels, "pixels")
    for i, ours in enumerate(dl.prefilter(light, size=32, roughness=roughness)):
        assert not library.domelight_filtered_level(filtered, c.c_size_t(i), c.byref(pixels))
        assert array_of(pixels).tobytes() == ours.tobytes()
    assert not library.domelight_filtered_irradiance_over_pi(filtered, c.byref(pixels))
    assert array_of(pixels).tobytes() == dl.irradiance(light, size=8, over_pi=True).tobytes()
    count = c.c_size_t()
    sh = np.ctypeslib.as_array(library.domelight_filtered_sh(filtered, c.byref(count)), (16, 3))
    # One reading for all gives the harmonics a band limit of their own, which rounds them otherwise.
    assert np.allclose(sh, dl.spherical_harmonics(light, 4), rtol=1e-6, atol=1e-6)
    library.domelight_filtered_free(filtered)
    library.domelight_environment_free(environment)
