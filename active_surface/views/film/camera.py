"""Camera: from where a film looks at the surface, without perspective, so that lengths can be measured in it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from active_surface.arrays import FloatArray


@dataclass(frozen=True)
class Camera:
    """Looks down from an elevation [degrees] above the plane, and from an azimuth counted from x towards y."""

    azimuth: float
    elevation: float

    @property
    def level(self) -> bool:
        """Whether it looks along the plane, so that heights are upright."""
        return self.elevation == 0

    @property
    def right(self) -> FloatArray:
        """The unit vector (3,) that points right in the picture."""
        a = math.radians(self.azimuth)
        return np.array([-math.sin(a), math.cos(a), 0.0])

    @property
    def towards(self) -> FloatArray:
        """The unit vector (3,) towards the camera."""
        a, e = math.radians(self.azimuth), math.radians(self.elevation)
        return np.array([math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e)])

    @property
    def up(self) -> FloatArray:
        """The unit vector (3,) that points up in the picture."""
        return np.cross(self.towards, self.right)

    def flat(self, places: FloatArray) -> FloatArray:
        """Places (..., 3) as the picture has them: (..., 2), right and up."""
        return places @ np.stack([self.right, self.up], axis=1)


CAMERAS = {
    "iso": Camera(-60.0, 38.0),
    "top": Camera(-90.0, 90.0),
    "front": Camera(-90.0, 0.0),
    "side": Camera(0.0, 0.0),
}


def camera_of(text: str | Camera) -> Camera:
    """The camera of a name, or of "azimuth,elevation" in degrees.

    Raises ValueError for anything else.
    """
    if isinstance(text, Camera):
        return text
    name = text.strip().lower()
    if name in CAMERAS:
        return CAMERAS[name]
    try:
        azimuth, elevation = (float(part) for part in name.split(","))
    except ValueError:
        azimuth = elevation = math.nan
    if not (math.isfinite(azimuth) and -90 <= elevation <= 90):
        raise ValueError(
            f"Input camera must be {', '.join(CAMERAS)}, or azimuth,elevation in degrees, as in -60,30, the elevation "
            f"from -90 to 90; got {text!r}"
        )
    return Camera(azimuth, elevation)
