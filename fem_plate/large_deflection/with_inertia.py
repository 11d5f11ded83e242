"""A stretching plate that has mass, in a few shapes: the lowest modes that its actuators excite, and corrections.

The corrections are made orthogonal to these modes, in bending and so in mass. In modes q and corrections c

    q_n'' + 2 zeta_n omega_n q_n' + omega_n^2 q_n + (1/M_n) dE_m/dq_n = -sum_i m_ni h_i''

with E_m(h, q, c) the membrane's energy, as in `ReducedPlate`. What the shapes stretch is solved for each two of them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

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
    forces = np.zeros((sum(3 * s.weights.size for s in membrane.samples), 0))
    steep = amplitudes * np.max([np.abs(p).max(axis=(0, 1)) for p in at], axis=0)
    for i, j, weights in _pairs(amplitudes, steep, least):
        unknowns = _answers(membrane, at, i, j)
        more = np.concatenate([forces, _forces(membrane, at, i, j, unknowns) * weights], axis=1)
        forces = more @ _strongest(force_products(discrete, membrane, more), least)
    forces = forces / np.sqrt(np.diag(force_products(discrete, membrane, forces)))
    forms = forms_of(membrane.samples, forces, at)
    at = at if in_plane is membrane else _slopes(discrete, in_plane, shapes)
    motions = np.zeros((in_plane.stiffness.shape[0], 0))
    for i, j, weights in _pairs(amplitudes, steep, IN_PLANE * least):
        more = np.concatenate([motions, _answers(in_plane, at, i, j) * weights], axis=1)
        motions = more @ _strongest(more.T @ (in_plane.stiffness @ more), IN_PLANE * least)
    motions = motions / np.sqrt(np.diag(motions.T @ (in_plane.stiffness @ motions)))
    everything = in_plane.expand(motions)
    own = stacked([in_plane.linear_force(samples, everything) for samples in in_plane.samples])
    moved = -forms_of(in_plane.samples, own, at)
    return ReducedPlate(bending_products(discrete, corrections), forms, in_plane=moved), motions


def _slopes(discrete: DiscretePlate, membrane: Membrane, columns: Columns) -> list[FloatArray]:
    equilibrium = discrete.equilibrium
    if membrane is discrete.membrane:
        return slopes(discrete, membrane.samples, equilibrium.known, columns)
    known = [equilibrium.trial.slopes(samples) for samples in membrane.samples]
    return slopes(discrete, membrane.samples, known, columns)


def _pairs(amplitudes: FloatArray, steep: FloatArray, least: float) -> Iterator[tuple[IntArray, IntArray, FloatArray]]:
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


def _forces(membrane: Membrane, at: list[FloatArray], i: IntArray, j: IntArray, unknowns: FloatArray) -> FloatArray:
    """The membrane forces (samples, c) that belong to them."""
    everything, parts = membrane.expand(unknowns), []
    for samples, p in zip(membrane.samples, at, strict=True):
        force = membrane.linear_force(samples, everything)
        if membrane.law is not None:
            square = _products(p[:, :, i], p[:, :, j])
            thirds = square.reshape(len(square), 3, -1, square.shape[2])
            force = force + np.einsum("ab,kbnc->kanc", membrane.law, thirds).reshape(square.shape)
        parts.append(force)
    return stacked(parts)


def _products(p: FloatArray, q: FloatArray) -> FloatArray:
    """Slopes (k, 2 n, c) of one shape each with those of another, as strains (k, 3 n, c)."""
    (x, y), (u, v) = halves(p), halves(q)
    return np.concatenate([x * u, x * v + y * u, y * v], axis=1)


def _strongest(products: FloatArray, least: float) -> FloatArray:
    """What combines k functions into orthogonal ones (k, m), without those that are short beside the longest."""
    squares, directions = np.linalg.eigh(products)
    return np.asarray(directions[:, squares > max(least**2, ROUNDING) * squares[-1]])
