"""Image-based lighting, computed exactly.

>>> import domelight as dl
>>> environment = dl.sky(64)
>>> levels = dl.prefilter(environment, size=32, levels=3)
>>> [level.shape for level in levels]
[(6, 32, 32, 3), (6, 16, 16, 3), (6, 8, 8, 3)]

Arrays are float32, radiance in linear Rec. 709; the world is right-handed with +Y up, as in glTF. docs/python.md tells of
everything.
"""

from . import _core, conventions
from ._baking import Bake, Bakes, bake, engines
from ._comparing import Audit, Comparison, LevelAudit, audit, compare, flip
from ._converting import convert, read_levels, write
from ._environment import DomelightWarning, Environment, axes, read, sky
from ._errors import Cancelled, Error, FileError, WrongType
from ._filtering import Levels, brdf_table, irradiance, prefilter, spherical_harmonics
from ._lights import Light, Lights, lights
from ._probing import ProbeSet, probes
from ._rendering import Render, render
from ._sampling import Sampler, Samples, unit_points

__version__ = _core.version()

__all__ = [
    "Audit",
    "Bake",
    "Bakes",
    "Cancelled",
    "Comparison",
    "DomelightWarning",
    "Environment",
    "Error",
    "FileError",
    "LevelAudit",
    "Levels",
    "Light",
    "Lights",
    "ProbeSet",
    "Render",
    "Sampler",
    "Samples",
    "WrongType",
    "audit",
    "axes",
    "bake",
    "brdf_table",
    "compare",
    "conventions",
    "convert",
    "engines",
    "flip",
    "irradiance",
    "lights",
    "prefilter",
    "probes",
    "read",
    "read_levels",
    "render",
    "sky",
    "spherical_harmonics",
    "unit_points",
    "write",
]


def __getattr__(name: str) -> object:
    # PyTorch takes seconds to load, so it is loaded where it is asked for.
    if name == "torch":
        import importlib

        return importlib.import_module(".torch", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
