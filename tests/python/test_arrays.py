"""What arrays are taken, and that they are not copied."""

import ctypes
import mmap

import numpy as np
import pytest

import domelight as dl
from conftest import small_environment


def levels_of(environment):
    return dl.prefilter(environment, size=16, levels=2)


def same(a, b):
    return all(x.tobytes() == y.tobytes() for x, y in zip(levels_of(a), levels_of(b), strict=True))


def test_strides_and_types_do_not_matter(light):
    assert same(light, light.astype(np.float64))
    assert same(light, np.asfortranarray(light))
    assert same(light, light[:, ::-1].copy()[:, ::-1])
    assert same(light, light[::-1].copy()[::-1])
    assert same(light, np.concatenate([light, light], -1)[..., :3])
    assert same(light, np.moveaxis(np.moveaxis(light, -1, 0).copy(), 0, -1))
    assert same(light.astype(np.float16), light.astype(np.float16).astype(np.float32))
    padded = np.zeros((32, 70, 3), np.float32)
    padded[:, :64] = light
    assert same(light, padded[:, :64])


def test_read_only_and_foreign_buffers(light):
    frozen = light.copy()
    frozen.setflags(write=False)
    assert same(light, frozen)
    assert same(light, memoryview(light))
    block = (ctypes.c_float * light.size).from_buffer_copy(light.tobytes())
    assert same(light, np.ctypeslib.as_array(block).reshape(light.shape))
    with mmap.mmap(-1, light.nbytes) as memory:
        memory.write(light.tobytes())
        assert same(light, np.frombuffer(memory, np.float32).reshape(light.shape).copy())


def test_an_environment_borrows_its_array(light):
    environment = dl.Environment(light)
    before = dl.spherical_harmonics(environment)[0]
    light *= 2
    assert np.allclose(dl.spherical_harmonics(environment)[0], 2 * before)


def test_an_environment_keeps_its_array_alive():
    environment = dl.Environment(small_environment())
    filler = [np.full((32, 64, 3), -1, np.float32) for _ in range(8)]
    assert same(environment, small_environment())
    del filler


def test_an_environment_is_an_array(light):
    environment = dl.Environment(light)
    assert environment.shape == (32, 64, 3)
    assert np.array_equal(np.asarray(environment), light)
    assert np.asarray(environment).base is not None and not np.asarray(environment).flags.writeable
    assert np.asarray(environment, np.float64).dtype == np.float64
    assert np.array_equal(np.from_dlpack(environment), light)


def test_results_share_memory_with_dlpack(light):
    level = levels_of(light)[0]
    assert level.flags.c_contiguous and level.flags.writeable
    assert np.shares_memory(np.from_dlpack(level), level)


def test_latlong_of_another_size_keeps_the_light(light):
    half = dl.Environment(light).latlong(16)
    assert half.shape == (16, 32, 3)
    assert np.allclose(dl.spherical_harmonics(half)[0], dl.spherical_harmonics(light)[0], rtol=0.02)


@pytest.mark.parametrize("library", ["torch", "jax.numpy"])
def test_arrays_of_other_libraries(light, library):
    module = pytest.importorskip(library, reason=f"{library.partition('.')[0]} is not installed")
    other = module.from_numpy(light) if library == "torch" else module.asarray(light)
    assert same(light, other)
