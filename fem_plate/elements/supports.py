"""How the plate is held at each of its boundaries."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from fem_plate.elements.forms import Rim

FloatArray = NDArray[np.float64]

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"
KINDS = (CLAMPED, SIMPLY_SUPPORTED, FREE)


def by_boundary(supports: str | Mapping[str, str], boundaries: Mapping[str, object]) -> dict[str, str]:
    """The support of every boundary; those that a mapping leaves out are free.

    Raises ValueError, naming every support and boundary that is not known.
    """
    if isinstance(supports, str):
        supports = dict.fromkeys(boundaries, supports)
    if not isinstance(supports, Mapping):
        raise ValueError(f"Input supports of Plate must be one name or a mapping from boundaries; got {supports!r}")
    known, kinds = ", ".join(map(repr, boundaries)), ", ".join(map(repr, KINDS))
    wrong = [f"boundary {name!r} is not one of the mesh's, {known}" for name in supports if name not in boundaries]
    wrong += [
        f"the support of {name!r} must be one of {kinds}; got {kind!r}"
        for name, kind in supports.items()
        if kind not in KINDS
    ]
    if wrong:
        raise ValueError("Input supports of Plate: " + "; ".join(dict.fromkeys(wrong)))
    return {name: supports.get(name, FREE) for name in boundaries}


def prescribed(support: str, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What a support prescribes at rim points with normals (..., 2): T (..., 2, 2) of the gradient, c (...) of w."""
    if support == FREE:
        return np.zeros((*normal.shape, 2)), np.zeros(normal.shape[:-1])
    if support == CLAMPED:
        return np.broadcast_to(np.eye(2), (*normal.shape, 2)), np.ones(normal.shape[:-1])
    tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    return tangent[..., :, None] * tangent[..., None, :], np.ones(normal.shape[:-1])


def rigid_modes(rim: Rim) -> FloatArray:
    """The rigid motions that the supports allow, as columns of coefficients of (1, x, y): (3, r)."""
    x, y = rim.points.reshape(-1, 2).T
    value = rim.value.reshape(-1)[:, None] * np.stack([np.ones_like(x), x, y], axis=1)
    slopes = rim.slope.reshape(-1, 2)
    rows = np.concatenate([value, np.concatenate([np.zeros((len(slopes), 1)), slopes], axis=1)])
    _, scale, directions = np.linalg.svd(rows.T @ rows)
    return np.asarray(directions[scale <= 1e-10 * len(rows)].T)
