"""Scene: what a part moves over."""

from __future__ import annotations

from coupling.scene.plate import PlateScene
from coupling.scene.platform import PlatformScene

Scene = PlateScene | PlatformScene
