"""Path tracing, and what real-time engines draw."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from typing import Any

from . import _core
from ._environment import DomelightWarning, EnvironmentLike, FloatArray, PathLike, light_of
from ._progress import Progress, reporting


class Render:
    """A picture with its layers: ``render["normal"]`` is a layer, ``render.radiance`` the picture.

    Layers are float32 of shape (height, width, 3) or (height, width): "radiance", "opacity", "direct", "indirect",
    "diffuse", "specular", "albedo", "normal", "depth", "object", "variance" (of the mean of each pixel), "samples".

    Attributes
    ----------
    noise : float
        Standard error of L / (1 + L), RMS over the pixels.
    seconds : float
    """

    def __init__(self, told: dict[str, Any]) -> None:
        self.layers: dict[str, FloatArray] = told["layers"]
        self.noise: float = told["noise"]
        self.seconds: float = told["seconds"]

    @property
    def radiance(self) -> FloatArray:
        """Linear radiance, float32 of shape (height, width, 3)."""
        return self.layers["radiance"]

    def __getitem__(self, layer: str) -> FloatArray:
        return self.layers[layer]

    def _repr_png_(self) -> bytes:
        return _core.png(_core.for_screen(self.radiance, {}))

    def __repr__(self) -> str:
        height, width = self.radiance.shape[:2]
        return f"<domelight.Render {width} x {height}: {', '.join(self.layers)}>"


def render(
    scene: PathLike,
    environment: EnvironmentLike,
    *,
    width: int = 512,
    height: int | None = None,
    spp: int = 64,
    bounces: int = 4,
    shading: str = "reference",
    strategy: str = "mis",
    camera_position: Sequence[float] | None = None,
    camera_target: Sequence[float] | None = None,
    fov_deg: float = 35,
    background: str = "environment",
    background_colour: Sequence[float] | None = None,
    background_roughness: float = 0.35,
    occlusion: bool = True,
    multiple_scattering: bool = False,
    lookup: str | None = None,
    lookup_size: int | None = None,
    diffuse_weight: str | None = None,
    noise: float = 0,
    time: float = 0,
    seed: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> Render:
    """Renders a scene under an environment: the reference by path tracing, or what a real-time engine would draw.

    Parameters
    ----------
    scene
        A model (.glb, .gltf, .obj, .ply), or "spheres", "ball" or "furnace".
    width, height
        Pixels; the height by default from the scene's camera, else as the width.
    spp
        Samples of each pixel, 1 to 2**20. `noise` > 0: more where a pixel's standard error of L / (1 + L) is above it;
        `time` > 0: as many as fit into so many seconds.
    bounces
        Of indirect light.
    shading
        "reference"; or "split-sum", "stretched", "phong", "mirror", "refract", as engines draw.
    strategy
        "mis", "env" or "brdf".
    camera_position, camera_target, fov_deg
        Where the scene's camera is not wanted; the vertical field of view.
    background, background_colour, background_roughness
        What is seen where there is no surface: "environment", "blurred" (by the roughness, 0 to 1), "colour" (linear RGB) or
        "transparent".
    occlusion
        False: no shadows, no indirect light and no occlusion maps, to compare with a shader that has none.
    multiple_scattering
        Gives back the energy that single scattering loses on rough surfaces.
    lookup, lookup_size
        "mirror", "refract": the texture through which the environment is looked up, "environment" (none), "cube", "latlong",
        "sphere-map" or "dual-paraboloid", and its size in texels.
    diffuse_weight
        "split-sum", "stretched": "energy" (1 - (F0 scale + F90 bias)) or "fresnel" (1 - F(NdotV)).
    noise, time
        See `spp`.
    seed
        Another randomisation; the same seed gives the same bits on any number of threads.
    threads
        0: all cores.
    progress
        A function of (stage, done), a tqdm bar, or True.

    Returns
    -------
    `Render`, with the picture in linear light.
    """
    from . import _render  # loads Embree

    options = {
        "width": width,
        "height": height,
        "spp": spp,
        "bounces": bounces,
        "shading": shading,
        "strategy": strategy,
        "camera_position": camera_position,
        "camera_target": camera_target,
        "fov_deg": fov_deg,
        "background": background,
        "background_colour": background_colour,
        "background_roughness": background_roughness,
        "occlusion": occlusion,
        "multiple_scattering": multiple_scattering,
        "lookup": lookup,
        "lookup_size": lookup_size,
        "diffuse_weight": diffuse_weight,
        "noise": noise,
        "time": time,
        "seed": seed,
        "threads": threads,
    }
    with light_of(environment) as light, reporting(progress) as tell:
        told = _render.render(os.fspath(scene), light, options, tell)
    for line in told["warnings"]:
        warnings.warn(line, DomelightWarning, stacklevel=2)
    return Render(told)
