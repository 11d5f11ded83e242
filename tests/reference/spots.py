"""Points at which plates are compared."""

from __future__ import annotations

import numpy as np


def scattered(mesh, away=(), count=400, from_rim=0.0):
    """Points all over a plate, at least 0.02 away from some and a distance from the rim."""
    low, high = mesh.outline.box
    xy = np.random.default_rng(3).uniform(low, high, (5 * count, 2))
    xy = xy[mesh.outline.gap(xy) > from_rim]
    for point in np.reshape(away, (-1, 2)):
        xy = xy[np.hypot(*(xy - point).T) > 0.02]
    return xy[:count]
