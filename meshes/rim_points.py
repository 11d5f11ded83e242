"""The rim as points: to fit to, and to draw."""

from __future__ import annotations

import numpy as np

from meshes.nearest import FloatArray
from meshes.outline import Outline

FINE = 1 / 200  # of the longer side of the outline


def rim_curves(outline: Outline, spacing: float | None = None) -> list[FloatArray]:
    """Points (n, 2) [m] along each ellipse and each edge of the rim, at most about `spacing` [m] apart.

    spacing: None is fine enough to draw the whole rim.
    """
    if spacing is None:
        spacing = FINE * float(np.ptp(outline.box, axis=0).max())
    curves = []
    for x, y, a, b in outline.conics.tolist():
        angle = np.linspace(0, 2 * np.pi, int(np.ceil(2 * np.pi * max(a, b) / spacing)) + 4)
        curves.append(np.stack([x + a * np.cos(angle), y + b * np.sin(angle)], axis=1))
    for start, middle, end in outline.edges:
        length = np.linalg.norm(middle - start) + np.linalg.norm(end - middle)
        s = np.linspace(0, 1, int(np.ceil(length / spacing)) + 1)[:, None]
        curves.append((1 - s) * (1 - 2 * s) * start + 4 * s * (1 - s) * middle + s * (2 * s - 1) * end)
    return curves
