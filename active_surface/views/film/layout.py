"""Layout: where on the picture a place of the run is seen, and where words stand."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.views.film.camera import Camera
from active_surface.views.film.stage import Stage

MIN_SIZE, MAX_SIDE = (320, 240), 8192  # pixels: width and height, either
LEFT, RIGHT, BOTTOM, TOP = 0.03, 0.86, 0.17, 0.88  # of the picture: the part of it that the surface fills
MOMENTS = 1000  # at which the reach of a platform is sought
BESIDE_AXIS = 0.09  # likewise at the left where there is an axis of heights
HIGHEST = 0.5  # of the frame's longer side: a part that flies higher may leave the picture


@dataclass(frozen=True, eq=False)
class Layout:
    """A picture of width x height pixels; places in it are of the scene: lengths over the frame's longer side."""

    width: int
    height: int
    camera: Camera
    exaggeration: float
    middle: FloatArray  # (2,) m of the run, which is the scene's origin
    size: float  # m of the run, which the scene has as 1
    focus: FloatArray  # (2,) of the scene, right and up, seen in the middle of the picture
    scale: float  # pixels of a length 1 of the scene
    depth: float = 0.0  # of the scene: so far before or behind its origin is what is seen

    def scene(self, xy: FloatArray, z: FloatArray, shift: FloatArray | float = 0.0) -> FloatArray:
        """Places (k, 3) in the scene of points (k, 2) [m] at heights (k,) [m], on a platform that is shifted [m]."""
        up = np.asarray(z) * (self.exaggeration / self.size)
        return np.column_stack([(xy + shift - self.middle) / self.size, up])

    def pixels(self, scene: FloatArray) -> FloatArray:
        """Places (..., 3) of the scene as pixels (..., 2) from the lower left corner."""
        return (self.camera.flat(scene) - self.focus) * self.scale + np.array([self.width, self.height]) / 2


def layout_of(stage: Stage, camera: Camera, size: tuple[int, int], exaggeration: float) -> Layout:
    """The layout in which the surface fills its part of the picture at all times."""
    width, height = size
    unscaled = Layout(width, height, camera, exaggeration, stage.frame.mean(axis=0), stage.size, np.zeros(2), 1.0)
    part = stage.run.position
    top = max(float(stage.reach[1].max()), HIGHEST * stage.size / exaggeration)
    shifts = np.unique(stage.shifts(np.linspace(0.0, stage.run.time[-1], MOMENTS)), axis=0)
    corners = np.stack([shifts.min(axis=0), shifts.max(axis=0)])
    places = [unscaled.scene(stage.surface, z, shift) for z in stage.reach for shift in corners]
    places.append(unscaled.scene(part[:, :2], np.clip(part[:, 2], None, top)))
    flat = camera.flat(np.concatenate(places))
    low, high = flat.min(axis=0), flat.max(axis=0)
    left = BESIDE_AXIS if camera.level else LEFT
    room = np.array([(RIGHT - left) * width, (TOP - BOTTOM) * height])
    scale = float((room / np.maximum(high - low, 1e-3)).min())
    offset = np.array([(left + RIGHT - 1) * width, (BOTTOM + TOP - 1) * height]) / 2
    focus = (low + high) / 2 - offset / scale
    places.append(unscaled.scene(part[:, :2], part[:, 2]))
    depth = float(np.abs(np.concatenate(places) @ camera.towards).max())
    return Layout(width, height, camera, exaggeration, unscaled.middle, unscaled.size, focus, scale, depth)


def size_of(size: str | tuple[int, int]) -> tuple[int, int]:
    """The width and height [pixels] of "1280x720".

    Raises ValueError for anything else, and unless a picture of this size can be drawn and read.
    """
    if isinstance(size, str):
        match = re.fullmatch(r"\s*(\d+)\s*[x×,]\s*(\d+)\s*", size)
        if not match:
            raise ValueError(f"Input size must be WIDTHxHEIGHT in pixels, as in 1280x720; got {size!r}")
        size = int(match[1]), int(match[2])
    if not all(least <= side <= MAX_SIDE for least, side in zip(MIN_SIZE, size, strict=True)):
        raise ValueError(
            f"Input size must be from {MIN_SIZE[0]}x{MIN_SIZE[1]} to {MAX_SIDE}x{MAX_SIDE} pixels; "
            f"got {size[0]}x{size[1]}"
        )
    return size
