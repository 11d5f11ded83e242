"""Layout: from where a film looks at the surface, and where in the picture that is.

There is no perspective, so that lengths can be measured.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace

import numpy as np

from active_surface.arrays import FloatArray
from active_surface.views.film.scene import Scene

CAMERAS = {"iso": (-60.0, 38.0), "top": (-90.0, 90.0), "front": (-90.0, 0.0), "side": (0.0, 0.0)}
MIN_SIZE, MAX_SIDE = (320, 240), 8192  # pixels: width and height, either
LEFT, RIGHT, BOTTOM, TOP = 0.03, 0.86, 0.17, 0.88  # of the picture: the part of it that the surface fills
BESIDE_AXIS = 0.09  # likewise at the left where there is an axis of heights
MARGIN = 0.035  # around that, of the picture's lower side: for lines, and for the ball
MOMENTS = 1000  # at which the reach of a platform is sought
HIGHEST = 0.5  # of the frame's longer side: a part that flies higher may leave the picture


@dataclass(frozen=True, eq=False)
class Layout:
    """A picture of width x height pixels. The scene has the frame's longer side as 1, and its middle as origin."""

    scene: Scene
    width: int
    height: int
    axes: FloatArray  # (3, 3) of the picture: right, up, and towards the camera
    exaggeration: float
    scale: float = 1.0  # pixels of a length 1
    focus: FloatArray | float = 0.0  # (2,) right and up, in the middle of the box
    depth: float = 0.0  # so far before or behind the origin is what is seen

    @property
    def level(self) -> bool:
        """Whether the camera looks along the plane, so that heights are upright."""
        return float(self.axes[2, 2]) == 0.0

    @property
    def pixel(self) -> float:
        """What is a pixel in a picture of 720 lines, in pixels of this one."""
        return min(self.width / 1280, self.height / 720)

    @property
    def box(self) -> FloatArray:
        """The corners (2, 2) [pixels], lower left and upper right, of what the surface is drawn in."""
        margin = MARGIN * min(self.width, self.height)
        ends = np.array([[BESIDE_AXIS if self.level else LEFT, BOTTOM], [RIGHT, TOP]]) * [self.width, self.height]
        return np.rint(ends + margin * np.array([[-1], [1]])).clip(0).astype(int)

    def places(self, xy: FloatArray, z: FloatArray) -> FloatArray:
        """Places (k, 3) in the scene of points (k, 2) [m] at heights (k,) [m]."""
        return np.column_stack([self.scene.scaled(xy), np.asarray(z) * (self.exaggeration / self.scene.size)])

    def pixels(self, places: FloatArray) -> FloatArray:
        """Places (k, 3) of the scene as pixels (k, 2) from the lower left corner."""
        return (places @ self.axes[:2].T - self.focus) * self.scale + self.box.mean(axis=0)


def layout_of(scene: Scene, camera: tuple[float, float], size: tuple[int, int], exaggeration: float) -> Layout:
    """The layout in which the surface fills its part of the picture at all times."""
    a, e = np.radians(camera)
    right = np.array([-math.sin(a), math.cos(a), 0.0])
    towards = np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])
    layout = Layout(scene, *size, np.stack([right, np.cross(towards, right), towards]), exaggeration)
    part = np.concatenate([one.run.position for one in (scene, *scene.others)])
    top = max(scene.range[1], HIGHEST * scene.size / exaggeration)
    shifts = scene.shifts(np.linspace(0.0, scene.run.time[-1], MOMENTS))
    corners = np.stack([shifts.min(axis=0), shifts.max(axis=0)])
    points = scene.surface.points[:, :2] * scene.size + scene.frame.mean(axis=0)
    surface = [layout.places(points + shift, z) for z in scene.reach for shift in corners]
    seen = np.concatenate([*surface, layout.places(part[:, :2], np.clip(part[:, 2], None, top))]) @ layout.axes[:2].T
    low, high = seen.min(axis=0), seen.max(axis=0)
    room = np.ptp(layout.box, axis=0) - 2 * MARGIN * min(size)
    scale = float((room / np.maximum(high - low, 1e-3)).min())
    depth = np.concatenate([*surface, layout.places(part[:, :2], part[:, 2])]) @ towards
    return replace(layout, scale=scale, focus=(low + high) / 2, depth=float(np.abs(depth).max()))


def camera_of(text: str | tuple[float, float]) -> tuple[float, float]:
    """Azimuth and elevation [degrees] of a name, or of "azimuth,elevation".

    Raises ValueError for anything else.
    """
    try:
        name = text.strip().lower() if isinstance(text, str) else text
        azimuth, elevation = (
            CAMERAS[name] if name in CAMERAS else map(float, name.split(",") if isinstance(name, str) else name)
        )
    except (TypeError, ValueError):
        azimuth = elevation = math.nan
    if not (math.isfinite(azimuth) and -90 <= elevation <= 90):
        raise ValueError(
            f"Input camera must be {', '.join(CAMERAS)}, or azimuth,elevation in degrees, as in -60,30, the elevation "
            f"from -90 to 90; got {text!r}"
        )
    return azimuth, elevation


def size_of(text: str | tuple[int, int]) -> tuple[int, int]:
    """The width and height [pixels] of "1280x720".

    Raises ValueError for anything else, and unless a picture of this size can be drawn and read.
    """
    try:
        width, height = map(int, re.split("[x×,]", text) if isinstance(text, str) else text)
    except (TypeError, ValueError):
        raise ValueError(f"Input size must be WIDTHxHEIGHT in pixels, as in 1280x720; got {text!r}") from None
    if not all(least <= side <= MAX_SIDE for least, side in zip(MIN_SIZE, (width, height), strict=True)):
        raise ValueError(
            f"Input size must be from {MIN_SIZE[0]}x{MIN_SIZE[1]} to {MAX_SIDE}x{MAX_SIDE} pixels; got {width}x{height}"
        )
    return width, height
