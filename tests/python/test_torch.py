"""The differentiable filters."""

import math

import numpy as np
import pytest

import domelight as dl
from conftest import small_environment
from test_conventions import DIRECTIONS, light_from

torch = pytest.importorskip("torch", reason="PyTorch is not installed")
import domelight.torch as dt  # noqa: E402


@pytest.fixture
def tensor():
    return torch.from_numpy(small_environment(16))


def test_values_are_those_of_the_filter(tensor):
    levels = dt.prefilter(tensor, [0.3, 1], [16, 8])
    for level, roughness, size in zip(levels, (0.3, 1), (16, 8)):
        wanted = dl.prefilter(tensor, roughness=[roughness], size=size, texels="centre")[0]
        assert np.array_equal(level.numpy(), wanted)
    assert np.array_equal(dt.irradiance(tensor, 8, over_pi=True).numpy(), dl.irradiance(tensor, size=8, over_pi=True))
    assert np.allclose(dt.spherical_harmonics(tensor, 4).numpy(), dl.spherical_harmonics(tensor, 4), rtol=1e-6, atol=1e-6)
    ours = dt.spherical_harmonics(tensor, 5, irradiance=True)
    assert np.allclose(ours.numpy(), dl.spherical_harmonics(tensor, 5, irradiance=True), rtol=1e-5, atol=1e-5)


def error_of_the_transpose(function, x):
    """|⟨A x, y⟩ - ⟨x, Aᵀ y⟩| / (|A x| |y|), where Aᵀ y is the gradient of ⟨A x, y⟩."""
    x = x.clone().requires_grad_()
    maps = function(x)
    maps = maps if isinstance(maps, list) else [maps]
    generator = torch.Generator().manual_seed(3)
    noise = [torch.randn(m.shape, generator=generator, dtype=m.dtype) for m in maps]
    product = sum((m.double() * n.double()).sum() for m, n in zip(maps, noise))
    product.backward()
    size = math.sqrt(sum(m.double().square().sum() for m in maps) * sum(n.double().square().sum() for n in noise))
    return abs(product.item() - (x.detach().double() * x.grad.double()).sum().item()) / size


@pytest.mark.parametrize("convention", ["default", "nvdiffrec", "stanford-orb", "mitsuba"])
def test_gradients_are_the_transpose(tensor, convention):
    words = {"convention": convention}
    assert error_of_the_transpose(lambda x: dt.prefilter(x, [0.25, 0.5, 1], 8, **words), tensor) < 1e-6
    assert error_of_the_transpose(lambda x: dt.prefilter(x, [0.4], 8, lobe="charlie", layout="latlong", **words), tensor) < 1e-6
    assert error_of_the_transpose(lambda x: dt.irradiance(x, 8, **words), tensor) < 1e-6
    assert error_of_the_transpose(lambda x: dt.spherical_harmonics(x, 4, **words), tensor) < 1e-6
    directions = [[0, 1, 0], [1, 1, 1], [0.1, -3, 0]]
    assert error_of_the_transpose(lambda x: dt.prefilter(x, [0.5], directions=directions, **words), tensor) < 1e-6


def gradcheck(function, inputs):
    # The functions are linear, so a large step has no error of its own; values are of float32.
    return torch.autograd.gradcheck(function, inputs, eps=0.5, atol=2e-4, rtol=1e-3)


@pytest.mark.filterwarnings("ignore:Input #0 requires gradient")
def test_gradcheck():
    x = (torch.rand(3, 4, 3, dtype=torch.float64) + 1).requires_grad_()
    directions = [[1, 2, 3], [0, -1, 0.5]]
    assert gradcheck(lambda e: tuple(dt.prefilter(e, [0.5, 1], directions=directions)), (x,))
    assert gradcheck(lambda e: dt.irradiance(e, 1, convention="stanford-orb"), (x,))
    assert gradcheck(lambda e: dt.spherical_harmonics(e, 2, irradiance=True), (x,))


@pytest.mark.filterwarnings("ignore:Input #")
def test_second_derivatives():
    x = (torch.rand(3, 4, 3, dtype=torch.float64) + 1).requires_grad_()
    y = torch.rand(6, 1, 1, 3, dtype=torch.float64, requires_grad=True)

    def gradient(x, y):
        (level,) = dt.prefilter(x, [0.7], 1)
        return torch.autograd.grad(level, x, y, create_graph=True)[0]

    assert torch.autograd.gradcheck(lambda y: gradient(x, y), (y,), eps=0.5, atol=2e-4, rtol=1e-3)


def test_conventions_turn_the_light(tensor):
    light = torch.from_numpy(dl.convert(dl.Environment(tensor.numpy()), "nvdiffrec", size=16))
    ours, theirs = dt.irradiance(tensor, 8), dt.irradiance(light, 8, convention="nvdiffrec")
    assert torch.allclose(ours, theirs, rtol=1e-3)


@pytest.mark.parametrize("name", DIRECTIONS)
def test_light_is_read_from_where_the_project_has_it(name):
    light = torch.from_numpy(light_from(DIRECTIONS[name](64, 128)))
    # Y_1 = √(3/4π) (y, z, x): red is 2 + x, green 2 + y, blue 2 + z.
    linear = dt.spherical_harmonics(light, convention=name)[1:4] * math.sqrt(3 / (4 * math.pi))
    assert torch.allclose(linear, torch.tensor([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]]), atol=3e-3)


@pytest.mark.parametrize("name", ["default", "usd", "mitsuba", "openexr", "materialx", "mod"])
def test_every_convention_of_the_library_has_its_name_here(name):
    environment = dl.Environment(light_from(DIRECTIONS["nvdiffrec"](64, 128)), "nvdiffrec")
    projection = f"latlong/{name}"
    light = dl.convert(environment, projection, size=32)
    wanted = dl.irradiance(dl.Environment(light, projection), size=4)
    assert np.allclose(dt.irradiance(torch.from_numpy(light), 4, convention=name).numpy(), wanted, rtol=1e-5)
    assert np.allclose(wanted, dl.irradiance(environment, size=4), rtol=2e-3)


def test_an_environment_is_found_again():
    """Gradient descent from a grey environment to one that has the same filtered maps."""
    truth = torch.from_numpy(small_environment(8)).clamp(max=3)
    wanted = [level.detach() for level in dt.prefilter(truth, [0.3, 0.6], 8)]
    guess = torch.full_like(truth, 1.0).requires_grad_()
    optimizer = torch.optim.Adam([guess], lr=0.1)
    losses = []
    for _ in range(60):
        optimizer.zero_grad()
        loss = sum((a - b).square().mean() for a, b in zip(dt.prefilter(guess, [0.3, 0.6], 8), wanted))
        loss.backward()
        optimizer.step()
        losses.append(loss.item())
    assert losses[-1] < 1e-3 * losses[0]


def test_errors_name_the_keyword(tensor):
    for call, field in [
        (lambda: dt.prefilter(tensor, [0.0]), "roughness"),
        (lambda: dt.prefilter(tensor), "roughness"),
        (lambda: dt.prefilter(tensor, [0.5, 1], [8]), "size"),
        (lambda: dt.prefilter(tensor, [0.5], convention="blender"), "convention"),
        (lambda: dt.prefilter(tensor[..., 0], [0.5]), "environment"),
        (lambda: dt.prefilter(tensor.int(), [0.5]), "environment"),
        (lambda: dt.prefilter(tensor.numpy(), [0.5]), "environment"),
        (lambda: dt.prefilter(tensor * torch.nan, [0.5]), "environment"),
        (lambda: dt.irradiance(tensor, 5000), "irradiance_size"),
    ]:
        with pytest.raises(dl.Error) as caught:
            call()
        assert caught.value.field == field
