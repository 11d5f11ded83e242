"""How the plate is held at each of its boundaries."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fem_plate.types import FloatArray

CLAMPED, SIMPLY_SUPPORTED, FREE = "clamped", "simply-supported", "free"
KINDS = (CLAMPED, SIMPLY_SUPPORTED, FREE)


def by_boundary(supports: str | Mapping[str, str], boundaries: Mapping[str, object]) -> dict[str, str]:
    """The support of every boundary; those that a mapping leaves out are free.

    Raises ValueError, naming every unknown support and boundary.
    """
    if isinstance(supports, str):
        supports = dict.fromkeys(boundaries, supports)
    if not isinstance(supports, Mapping):
        raise ValueError(f"Input supports of Plate must be one name or a mapping from boundaries; got {supports!r}")
    names, kinds = ", ".join(map(repr, boundaries)), ", ".join(map(repr, KINDS))
    mistakes = [f"boundary {name!r} is not one of the mesh's, {names}" for name in supports if name not in boundaries]
    mistakes += [
        f"the support of {name!r} must be one of {kinds}; got {kind!r}"
        for name, kind in supports.items()
        if kind not in KINDS
    ]
    if mistakes:
        raise ValueError("Input supports of Plate: " + "; ".join(dict.fromkeys(mistakes)))
    return {name: supports.get(name, FREE) for name in boundaries}


def prescribed(support: str, normal: FloatArray) -> tuple[FloatArray, FloatArray]:
    """What a support prescribes at rim points with normals (..., 2): T (..., 2, 2) of the gradient, c (...) of w."""
    if support == FREE:
        return np.zeros((*normal.shape, 2)), np.zeros(normal.shape[:-1])
    if support == CLAMPED:
        return np.broadcast_to(np.eye(2), (*normal.shape, 2)), np.ones(normal.shape[:-1])
    tangent = np.stack([-normal[..., 1], normal[..., 0]], axis=-1)
    return tangent[..., :, None] * tangent[..., None, :], np.ones(normal.shape[:-1])
