"""Projection: a plate in the leading directions (POD) of its full solutions.

The corrections to the linear shapes, the membrane forces and the in-plane motions each get their own. The membrane's
energy in these is 1/2 sum_r f_r^2 with f_r = 1/2 int N_r : grad w grad w, for forces N_r that are in balance and of
unit energy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fem_plate.large_deflection.membranes import Membrane, Samples, halves, thirds
from fem_plate.large_deflection.reduction.full_solutions import FullSolutions
from fem_plate.large_deflection.reduction.reduced import ReducedPlate
from fem_plate.large_deflection.reduction.snapshots import Columns, bending_products, stacked, unstacked
from fem_plate.large_deflection.solution import DiscretePlate
from fem_plate.types import FloatArray

ROUNDING = 1e-15  # of the largest square: directions below it are rounding
CHUNK = 400_000  # numbers in the products of two slopes that are held at a time


@dataclass(frozen=True, eq=False)
class Projection:
    """The plate in a few shapes."""

    plate: ReducedPlate
    corrections: Columns


def project(known: FullSolutions, least: float) -> Projection:
    """The plate in the leading directions of full solutions, without in-plane motion.

    least: of the largest direction; those that matter less are left out.
    """
    discrete, membrane = known.discrete, known.membrane(0)
    everything = Columns.joined(known.corrections)
    corrections = everything.weighted(_leading(bending_products(discrete, everything), least))
    forces = np.stack(known.forces, axis=1)
    forces = forces @ _leading(force_products(discrete, membrane, forces), least)
    shapes = known.slopes(0, Columns.joined([known.linear, corrections]))
    plate = ReducedPlate(bending_products(discrete, corrections), forms_of(membrane.samples, forces, shapes))
    return Projection(plate, corrections)


def with_in_plane(known: FullSolutions, model: Projection, least: float) -> tuple[ReducedPlate, FloatArray]:
    """The plate of a model with the leading in-plane motions (unknowns, M), each of unit energy, and these."""
    membrane, motions = known.membrane(1), np.stack(known.motions, axis=1)
    motions = motions @ _leading(motions.T @ (membrane.stiffness @ motions), least)
    everything = membrane.expand(motions)
    forces = stacked([membrane.linear_force(samples, everything) for samples in membrane.samples])
    shapes = known.slopes(1, Columns.joined([known.linear, model.corrections]))
    stiffness, forms = model.plate.stiffness, model.plate.membrane
    return ReducedPlate(stiffness, forms, in_plane=-forms_of(membrane.samples, forces, shapes)), motions


def _leading(products: FloatArray, least: float) -> FloatArray:
    """What combines k functions into orthonormal leading ones (k, m), from their products (k, k)."""
    squares, directions = np.linalg.eigh(products)
    kept = squares > max(least**2, ROUNDING) * squares[-1]
    return np.asarray((directions[:, kept] / np.sqrt(squares[kept]))[:, ::-1])


def force_products(discrete: DiscretePlate, membrane: Membrane, forces: FloatArray) -> FloatArray:
    """The membrane energies, twice, of forces with each other (c, c)."""
    compliance = np.linalg.inv(discrete.plane_stress.law)
    total = np.zeros((forces.shape[1],) * 2)
    for samples, part in zip(membrane.samples, unstacked(membrane.samples, forces), strict=True):
        thirds_ = thirds(part)
        for row, one in zip(compliance, thirds_, strict=True):
            strain = sum(a * other for a, other in zip(row, thirds_, strict=True))
            total += np.einsum("kn,kni,knj->ij", samples.weights, one, strain, optimize=True)
    return (total + total.T) / 2


def forms_of(sets: Sequence[Samples], forces: FloatArray, shapes: Sequence[FloatArray]) -> FloatArray:
    """int N_r : grad phi_i grad phi_j, (r, b, b)."""
    count = shapes[0].shape[2]
    rows, columns = np.triu_indices(count)
    upper = np.zeros((forces.shape[1], len(rows)))
    for samples, tensors, slope in zip(sets, unstacked(sets, forces), shapes, strict=True):
        step = max(1, CHUNK // (samples.weights.shape[1] * len(rows)))
        for start in range(0, len(slope), step):
            part = slice(start, start + step)
            weights = samples.weights[part, :, None]
            x, y = halves(slope[part])
            (x_i, x_j), (y_i, y_j) = ((side[..., rows], side[..., columns]) for side in (x, y))
            products = (x_i * x_j, x_i * y_j + y_i * x_j, y_i * y_j)
            for tensor, product in zip(thirds(tensors[part]), products, strict=True):
                upper += (tensor * weights).reshape(-1, len(upper)).T @ product.reshape(-1, len(rows))
    forms = np.zeros((len(upper), count, count))
    forms[:, rows, columns] = forms[:, columns, rows] = upper
    return forms
