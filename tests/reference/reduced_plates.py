"""Reduced plates that tests share: one with a closed form, and some with random numbers."""

from __future__ import annotations

import numpy as np

from fem_plate.large_deflection import ReducedPlate

ALPHA, BETA, STIFFNESS = 1.3, 0.7, 0.9  # of the plate with one drive and one correction
OWN, MIXED, SQUARE, OFFSET = 0.4, -0.3, 0.8, 0.1  # of its in-plane motion


def one_plate() -> ReducedPlate:
    """One drive d, one correction c: K c + (alpha d^2 / 2 + beta d c) beta d = 0."""
    return ReducedPlate(
        [[STIFFNESS]],
        [[[ALPHA, BETA], [BETA, 0.0]]],
        in_plane=[[[OWN, MIXED], [MIXED, SQUARE]]],
        in_plane_offset=[OFFSET],
    )


def one_correction(d: np.ndarray) -> np.ndarray:
    """Its c, in closed form."""
    return -0.5 * ALPHA * BETA * d**3 / (STIFFNESS + BETA**2 * d**2)


def one_in_plane(d: np.ndarray) -> np.ndarray:
    """Its in-plane motion, in closed form."""
    c = one_correction(d)
    return OFFSET + 0.5 * OWN * d**2 + MIXED * d * c + 0.5 * SQUARE * c**2


def random_plate(drives: int, corrections: int, membrane: int, in_plane: int = 0, size: float = 1.0) -> ReducedPlate:
    """A plate whose stiffness grows and whose membrane falls with the number of the shape, as those of real ones do.

    size: of the membrane's forms, the square root of what stretching counts.
    """
    rng = np.random.default_rng([drives, corrections, membrane])
    total = drives + corrections
    root = rng.normal(size=(corrections, corrections))
    stiffness = root @ root.T / corrections + np.diag((1.0 + np.arange(corrections)) ** 2)
    share = np.concatenate([np.ones(drives), 1 / (1.0 + np.arange(corrections))])
    forms = rng.normal(size=(membrane, total, total)) / (1.0 + np.arange(membrane))[:, None, None]
    forms = size / np.sqrt(membrane) * share[:, None] * share * forms
    motions = rng.normal(size=(in_plane, total, total))
    return ReducedPlate(
        0.5 * (stiffness + stiffness.T),
        0.5 * (forms + forms.swapaxes(1, 2)),
        prestress=0.1 * np.abs(rng.normal(size=membrane)),
        load=0.2 * rng.normal(size=corrections),
        in_plane=0.5 * (motions + motions.swapaxes(1, 2)),
        in_plane_offset=rng.normal(size=in_plane),
    )
