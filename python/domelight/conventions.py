"""Lat-long conventions of research projects, by name: `Environment`, `read` and `convert` take them as a projection.

Each says where a project's own code looks up the light from a world direction (x, y, z), in the world of the project's
cameras. (A scene of NeRF's synthetic data has +Z up in that world; nvdiffrec turns it to +Y up when it loads it,
GaussianShader does not.) docs/conventions.md has the conventions of tools and engines.

>>> import domelight as dl
>>> environment = dl.Environment(dl.axes(64).latlong(), "nvdiffrec")
>>> dl.convert(environment, "stanford-orb").shape
(64, 128, 3)
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["CONVENTIONS", "Convention", "nvdiffrec_roughness"]


@dataclass(frozen=True)
class Convention:
    """A project's lat-long map.

    Attributes
    ----------
    projection, rotate_y_deg
        The same as a convention of the library, whose light is turned about +Y.
    lookup
        u and v (0 to 1 over the picture) of a direction, as the project's code has them.
    samples
        Where they lie: "centres" ((i + 1/2) / N), "rows on poles" (rows at j / (H - 1)), or "edges" (also columns at
        i / (W - 1)).
    source
        The file and the functions that say so.
    """

    projection: str
    lookup: str
    samples: str
    source: str
    rotate_y_deg: float = 0


_CENTRE_MINUS_Z = "u = 1/2 + atan2(x, -z) / 2π, v = acos(y) / π"

CONVENTIONS: dict[str, Convention] = {
    "nvdiffrec": Convention(
        "latlong/materialx",
        _CENTRE_MINUS_Z,
        "centres",
        "NVlabs/nvdiffrec, render/util.py: latlong_to_cubemap, cubemap_to_latlong",
    ),
    "gaussianshader": Convention(
        "latlong/materialx",
        _CENTRE_MINUS_Z,
        "centres",
        "Asparagus15/GaussianShader, scene/NVDIFFREC/util.py: latlong_to_cubemap, cubemap_to_latlong",
    ),
    "stanford-orb": Convention(
        "latlong/openexr",
        _CENTRE_MINUS_Z,
        "edges",
        "StanfordORB/Stanford-ORB, orb/utils/env_map.py: env_map_to_cam_to_world_by_convention",
        rotate_y_deg=180,
    ),
    "mitsuba": Convention(
        "latlong/mitsuba",
        "u = atan2(x, -z) / 2π from 0 to 1, v = acos(y) / π",
        "rows on poles",
        "mitsuba-renderer/mitsuba3, src/emitters/envmap.cpp: direction_to_uv, eval_spectrum",
    ),
}


def resolve(name: str) -> tuple[str, float]:
    """Projection and turn about +Y in degrees of a convention's name; any other text as it is."""
    convention = CONVENTIONS.get(name)
    return (convention.projection, convention.rotate_y_deg) if convention else (name, 0)


def nvdiffrec_roughness(levels: int) -> list[float]:
    """The roughness of each level of nvdiffrec's and GaussianShader's specular chain (render/light.py, build_mips): from
    0.08 to 0.5, and 1 in the last."""
    if levels < 3:
        return [0.08, 1.0][-levels:]
    return [0.08 + (0.5 - 0.08) * level / (levels - 2) for level in range(levels - 1)] + [1.0]
