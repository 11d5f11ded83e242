"""A stretching plate that has mass, in a few shapes: the lowest modes that its actuators excite, and corrections.

The corrections are made orthogonal to these modes, in bending and so in mass. In modes q and corrections c

    q_n'' + 2 zeta_n omega_n q_n' + omega_n^2 q_n + (1/M_n) dE_m/dq_n = -sum_i m_ni h_i''

with E_m(h, q, c) the membrane's energy, as in `ReducedPlate`. What the shapes stretch is solved for each two of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from fem_plate.large_deflection.discrete import DiscretePlate
from fem_plate.large_deflection.full_solutions import Columns, bending_products, slopes, stacked
from fem_plate.large_deflection.membrane import Membrane, halves
from fem_plate.large_deflection.reduced import ReducedPlate
from fem_plate.large_deflection.reduction import Reduction, force_products, forms_of
from fem_plate.modes import ExcitedModes
from fem_plate.types import FloatArray, IntArray

BATCH = 64  # pairs of shapes that are solved together
NEGLIGIBLE = 0.1  # times `least`, of the largest product of two slopes: such pairs are left out
IN_PLANE = 1000.0  # times `least`: in-plane motions, which carry a part less than slopes do
DEPENDENT = 1e-10  # of the largest energy: corrections with less that is new are left out
ROUNDING = 1e-15  # of the largest square

Pairs = tuple[IntArray, IntArray, FloatArray]  # (m,) of two shapes each, and the product of their amplitudes


def with_modes(
    reduction: Reduction,
    modes: Columns,
    amplitudes: tuple[FloatArray, FloatArray, FloatArray],
    least: float,
) -> Reduction:
    """A reduction with modes (k) before its corrections, which then are orthogonal to them.

    amplitudes: (N,) of the drives, (k,) of the modes and (n,) of the reduction's corrections, dimensionless.
    least: of the largest, membrane forces that matter less are left out; in-plane motions may matter more.
    """
    discrete, linear, own = reduction.discrete, reduction.linear, modes.v.shape[1]
    products = bending_products(discrete, Columns.joined([modes, reduction.corrections]))
    shares = np.linalg.solve(products[:own, :own], products[:own, own:])
    energies, turned = np.linalg.eigh(products[own:, own:] - products[own:, :own] @ shares)
    kept = energies > DEPENDENT * energies[-1]
    scaled = turned[:, kept] / np.sqrt(energies[kept])
    pod, off = reduction.corrections.weighted(scaled), modes.weighted(shares @ scaled)
    corrections = Columns.joined([modes, Columns(pod.v - off.v, pod.extra - off.extra)])
    strokes, swings, largest = amplitudes
    reach = np.sqrt(energies[kept] * (turned[:, kept].T ** 2 @ largest**2))
    plate, motions = _stretched(discrete, linear, corrections, np.concatenate([strokes, swings, reach]), least)
    return replace(reduction, plate=plate, corrections=corrections, motions=motions)


def mode_columns(discrete: DiscretePlate, springs: FloatArray, excited: ExcitedModes) -> Columns:
    """Modes by the coefficients of the plate's trial functions; springs: (N,) N/m of the actuators."""
    trial, functions = discrete.trial, excited.functions
    held = np.flatnonzero(springs > 0)
    extra = np.zeros((trial.count, len(excited.omega)))
    extra[held] = functions.forces
    return Columns(functions.unknowns - trial.extra.unknowns[:, held] @ functions.forces, extra)


def _stretched(
    discrete: DiscretePlate, linear: Columns, corrections: Columns, amplitudes: FloatArray, least: float
) -> tuple[ReducedPlate, FloatArray]:
    """The reduced plate in its corrections, and its in-plane motions (unknowns, M)."""
    shapes = Columns.joined([linear, corrections])
    membrane, in_plane = discrete.membrane, discrete.plane_stress.membrane
    at = _slopes(discrete, membrane, shapes)
    steep = amplitudes * np.max([np.abs(p).max(axis=(0, 1)) for p in at], axis=0)
    pairs = partial(_pairs, amplitudes, steep)
    if membrane.law is None:
        forces = _forces(membrane, _orthogonal_answers(membrane, at, pairs(least), least))
    else:
        forces = _forces_by_law(discrete, at, pairs(least), least)
    forms = forms_of(membrane.samples, forces, at)
    at = at if in_plane is membrane else _slopes(discrete, in_plane, shapes)
    motions = _orthogonal_answers(in_plane, at, pairs(IN_PLANE * least), IN_PLANE * least)
    moved = -forms_of(in_plane.samples, _forces(in_plane, motions), at)
    return ReducedPlate(bending_products(discrete, corrections), forms, in_plane=moved), motions


def _orthogonal_answers(membrane: Membrane, at: list[FloatArray], pairs: Iterator[Pairs], least: float) -> FloatArray:
    """The unknowns (m, c) of orthogonal answers to pairs of shapes, each of unit energy."""
    found = np.zeros((membrane.stiffness.shape[0], 0))
    for i, j, weights in pairs:
        more = np.concatenate([found, _answers(membrane, at, i, j) * weights], axis=1)
        found = more @ _strongest(more.T @ (membrane.stiffness @ more), least)
    return found / np.sqrt(np.diag(found.T @ (membrane.stiffness @ found)))


def _forces(membrane: Membrane, unknowns: FloatArray) -> FloatArray:
    """The membrane forces (samples, c) of unknowns alone."""
    everything = membrane.expand(unknowns)
    return stacked([membrane.linear_force(samples, everything) for samples in membrane.samples])


def _forces_by_law(discrete: DiscretePlate, at: list[FloatArray], pairs: Iterator[Pairs], least: float) -> FloatArray:
    """The membrane forces (samples, c) of orthogonal answers, each of unit energy, where slopes add to them."""
    membrane = discrete.membrane
    found = np.zeros((sum(3 * s.weights.size for s in membrane.samples), 0))
    for i, j, weights in pairs:
        strains = stacked([membrane.by_law(_products(p[:, :, i], p[:, :, j])) for p in at])
        forces = _forces(membrane, _answers(membrane, at, i, j)) + strains
        more = np.concatenate([found, forces * weights], axis=1)
        found = more @ _strongest(force_products(discrete, membrane, more), least)
    return found / np.sqrt(np.diag(force_products(discrete, membrane, found)))


def _slopes(discrete: DiscretePlate, membrane: Membrane, columns: Columns) -> list[FloatArray]:
    equilibrium = discrete.equilibrium
    if membrane is discrete.membrane:
        return slopes(discrete, membrane.samples, equilibrium.known, columns)
    known = [equilibrium.trial.slopes(samples) for samples in membrane.samples]
    return slopes(discrete, membrane.samples, known, columns)


def _pairs(amplitudes: FloatArray, steep: FloatArray, least: float) -> Iterator[Pairs]:
    """Batches of two shapes each and the product of their amplitudes; steep: slopes (b,) that shapes reach."""
    i, j = np.triu_indices(len(amplitudes))
    together = steep[i] * steep[j]
    order = np.argsort(-together, kind="stable")
    order = order[together[order] > NEGLIGIBLE * least * together.max()]
    for start in range(0, len(order), BATCH):
        batch = order[start : start + BATCH]
        yield i[batch], j[batch], amplitudes[i[batch]] * amplitudes[j[batch]]


def _answers(membrane: Membrane, at: list[FloatArray], i: IntArray, j: IntArray) -> FloatArray:
    """The membrane's unknowns (m, c) as pairs of shapes stretch it; at: slopes (k, 2 n, shapes) at its samples."""
    t = np.zeros((int(membrane.dofs.max()) + 1, len(i)))
    for samples, p in zip(membrane.samples, at, strict=True):
        square = samples.weighted(_products(p[:, :, i], p[:, :, j]))
        np.add.at(t, membrane.dofs[samples.triangle], samples.operator.transpose(0, 2, 1) @ square)
    return -membrane.sign * membrane.solve(np.ascontiguousarray(membrane.reduce(t)))


def _products(p: FloatArray, q: FloatArray) -> FloatArray:
    """Slopes (k, 2 n, c) of one shape each with those of another, as strains (k, 3 n, c)."""
    (x, y), (u, v) = halves(p), halves(q)
    return np.concatenate([x * u, x * v + y * u, y * v], axis=1)


def _strongest(products: FloatArray, least: float) -> FloatArray:
    """What combines k functions into orthogonal ones (k, m), without those that are short beside the longest."""
    squares, directions = np.linalg.eigh(products)
    return np.asarray(directions[:, squares > max(least**2, ROUNDING) * squares[-1]])
