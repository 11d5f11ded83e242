"""The backbone curve of a plate's modes: how stretching raises their frequencies with the amplitude."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from fem_plate.graded import GradedPlate
from fem_plate.inputs import places_on
from fem_plate.large_deflection.discrete import DiscretePlate
from fem_plate.large_deflection.large_deflection import airy_applies, check_stretches, movable_by_boundary
from fem_plate.large_deflection.membrane import AIRY, PLANE_STRESS
from fem_plate.modes import HeldPlate, modes
from fem_plate.types import FloatArray


def backbone(
    plate: GradedPlate,
    count: int,
    held: ArrayLike | None = None,
    in_plane_supports: str | Mapping[str, str] = "immovable",
) -> FloatArray:
    """How the lowest natural frequencies rise with small amplitudes A, the largest deflection.

    omega^2 = omega_n^2 (1 + kappa_n (A/t)^2): a mode of amplitude q has the energy K q^2 / 2 + S q^4, with S its
    energy of stretching, and kappa = 3 S / K (t = 1).

    Parameters
    ----------
    plate : Plate
        The plate, without tension.
    count : int
        Number of modes; of repeated ones, kappa is that of either alone.
    held : (N, 2) array_like, optional
        Points that rigid actuators hold still [m].
    in_plane_supports : str or mapping of str to str
        As for `Plate.large_deflection`.

    Returns
    -------
    (count,) array
        kappa.

    Raises
    ------
    ValueError
        The plate has a tension, a foundation or forms, or a section that is not a `PlateSection`; or a point is not
        inside the rim.
    """
    check_stretches(plate, "backbone")
    points = places_on(plate.mesh, [] if held is None else held, "backbone", "held")
    movable = movable_by_boundary(in_plane_supports, plate.supports)
    membrane = AIRY if airy_applies(plate, movable) else PLANE_STRESS
    discrete = DiscretePlate(plate, points, np.full(len(points), np.inf), movable, membrane, 0, 0)
    held_plate = HeldPlate(discrete.model, points, discrete.rigidity, np.full(len(points), np.inf))
    found, trial = modes(held_plate, count, 1.0), discrete.trial
    squares = (2 * np.pi * found.frequencies) ** 2 / held_plate.unit(1.0)
    v = found.functions.unknowns - trial.extra.unknowns[:, : len(points)] @ found.functions.forces
    space = discrete.model.space
    xy, weights = space.quadrature
    mass = weights @ found.functions.values(xy) ** 2
    rest = np.zeros(trial.count - len(points))
    stretching = [
        discrete.equilibrium.at(v[:, n], np.concatenate([found.functions.forces[:, n], rest]), 0.0).stretching
        for n in range(count)
    ]
    return np.asarray(3 * np.array(stretching) / (squares * mass))
